// Shapes on a canvas, text, and marks: against areas in closed form, and by moving them.
#include "apps/engine/pictures/marks.hpp"
#include "apps/engine/pictures/sheet_page.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <random>

using namespace halflit;
using namespace halflit::engine;

namespace {

constexpr Color kBlack{0, 0, 0}, kWhite{255, 255, 255};

Canvas black(int width, int height) { return {width, height, kBlack}; }

/// Red code of a pixel: on a black canvas, the coverage of white in 1/255.
int code(const Canvas& canvas, int x, int y) { return canvas.image().rgba8[4 * static_cast<std::size_t>(y * canvas.image().width + x)]; }

/// Area that white covers, pixels.
double covered(const Canvas& canvas) {
    double sum = 0;
    for (std::size_t i = 0; i < canvas.image().rgba8.size(); i += 4) sum += canvas.image().rgba8[i] / 255.0;
    return sum;
}

int round_code(double coverage) { return static_cast<int>(coverage * 255 + 0.5); }

/// Whether b has the pixels of a, moved by (dx, dy).
bool is_moved(const Canvas& a, const Canvas& b, int dx, int dy) {
    for (int y = 0; y < a.image().height - dy; ++y)
        for (int x = 0; x < a.image().width - dx; ++x)
            if (code(a, x, y) != code(b, x + dx, y + dy)) return false;
    return true;
}

}  // namespace

TEST_CASE("canvas: a line covers its length times its width", "[canvas]") {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(20, 180), width(0.5, 12);
    for (int i = 0; i < 200; ++i) {
        const Point a{place(random), place(random)}, b{place(random), place(random)};
        const double w = width(random), length = std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
        Canvas canvas = black(200, 200);
        canvas.line(a, b, w, kWhite);
        CAPTURE(a.x, a.y, b.x, b.y, w);
        // Each pixel on the outline is rounded by at most half a code; the errors add up like a random walk.
        CHECK(std::abs(covered(canvas) - length * w) < 0.01 * length * w + 0.05);
    }
}

TEST_CASE("canvas: the ends and sides of level lines have the coverage of their areas", "[canvas]") {
    Canvas canvas = black(12, 12);
    canvas.line({2.25, 5}, {7.75, 5}, 1.5, kWhite);  // y from 4.25 to 5.75
    const double across[12] = {0, 0, 0.75, 1, 1, 1, 1, 0.75}, down[12] = {0, 0, 0, 0, 0.75, 0.75};
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 12; ++x) CHECK(code(canvas, x, y) == round_code(across[x] * down[y]));
    Canvas upright = black(12, 12);
    upright.line({5, 7.75}, {5, 2.25}, 1.5, kWhite);
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 12; ++x) CHECK(code(upright, x, y) == code(canvas, y, x));
}

TEST_CASE("canvas: a triangle's edge covers each pixel by the area below it", "[canvas]") {
    // Below y = x / 4, from x = 0 to 12: pixel x of row x / 4 has its share in closed form.
    Canvas canvas = black(12, 3);
    canvas.fill(std::vector<Contour>{{{0, 0}, {12, 3}, {0, 3}}}, kWhite);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 12; ++x) {
            const double share = x / 4 > y ? 0.0 : x / 4 < y ? 1.0 : 1.0 - (x % 4 + 0.5) / 4;
            CHECK(code(canvas, x, y) == round_code(share));
        }
}

TEST_CASE("canvas: a hole is left out, and a disc has its area", "[canvas]") {
    Canvas canvas = black(10, 10);
    canvas.fill(std::vector<Contour>{{{1, 1}, {9, 1}, {9, 9}, {1, 9}}, {{3, 3}, {3, 7}, {7, 7}, {7, 3}}}, kWhite);
    CHECK(covered(canvas) == 64 - 16);
    CHECK(code(canvas, 5, 5) == 0);
    for (const double radius : {1.5, 4.0, 30.0}) {
        Canvas disc = black(100, 100);
        disc.dot({50.3, 49.8}, radius, kWhite);
        CHECK(covered(disc) == Approx(3.14159265 * radius * radius).epsilon(0.01));
    }
}

TEST_CASE("canvas: what lies outside changes nothing inside", "[canvas]") {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> place(-30, 90);
    for (int i = 0; i < 200; ++i) {
        Canvas whole = black(120, 120), part = black(40, 40);
        Contour triangle, moved;
        for (int k = 0; k < 3; ++k) {
            triangle.push_back({on_canvas_grid(place(random)), on_canvas_grid(place(random))});
            moved.push_back(triangle.back() + Point{30, 30});
        }
        part.fill(std::vector<Contour>{triangle}, kWhite);
        whole.fill(std::vector<Contour>{moved}, kWhite);
        int most = 0;
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x) most = std::max(most, std::abs(code(part, x, y) - code(whole, x + 30, y + 30)));
        // Parts outside are added in another order, which may turn the rounding of a code.
        CHECK(most <= 1);
    }
    Canvas canvas = black(8, 8);
    for (const double far : {1e7, -1e7, 1e300, std::nan("")}) {
        canvas.line({far, 2}, {4, 4}, 2, kWhite);
        canvas.dot({3, far}, 2, kWhite);
        canvas.fill_box({far, far}, far, far, kWhite);
        canvas.arrow({far, 0}, {0, far}, 2, kWhite);
        draw_text(canvas, {far, 4}, "text", {});
    }
    CHECK(covered(canvas) == 0);
}

TEST_CASE("canvas: a half transparent colour on a transparent picture keeps its colour", "[canvas]") {
    Canvas canvas(4, 1, {0, 0, 0, 0});
    canvas.fill_box({0, 0}, 2, 1, {200, 100, 50, 128});
    const std::vector<std::uint8_t>& p = canvas.image().rgba8;
    CHECK(std::vector<int>(p.begin(), p.begin() + 4) == std::vector<int>{200, 100, 50, 128});
    canvas.fill_box({0, 0}, 1, 1, {200, 100, 50, 128});
    CHECK(p[0] == 200);
    CHECK(p[3] == 192);  // 255 (1 - (127/255)^2) is 191.7
    CHECK(p[15] == 0);
}

TEST_CASE("lettering: the width of two texts together is the sum of theirs and the kerning between them", "[lettering]") {
    const double n = width_of_text("n", 16), o = width_of_text("o", 16);
    CHECK(width_of_text("nnonn", 16) == Approx(4 * n + o));
    CHECK(width_of_text("nnonn", 32) == Approx(2 * width_of_text("nnonn", 16)));
    CHECK(width_of_text("AV", 16) < width_of_text("A", 16) + width_of_text("V", 16));
    CHECK(width_of_text("", 16) == 0.0);
    CHECK(width_of_text("\u00e9", 16) == Approx(width_of_text("e", 16)));  // of one width in this font
    CHECK(n == Approx(1298 / 2048.0 * 16));                                // from the table hmtx
}

TEST_CASE("lettering: the same text elsewhere has the same pixels, moved", "[lettering]") {
    for (const double size : {9.0, kSmallTextSize, kTextSize, 31.0}) {
        Canvas a = black(300, 100), b = black(300, 100);
        draw_text(a, {10.4, 40}, "WAVES, 12.5 \u00d7 8 \u00b5m @", {size, kWhite});
        draw_text(b, {27.4, 71}, "WAVES, 12.5 \u00d7 8 \u00b5m @", {size, kWhite});
        CHECK(covered(a) > 20);
        CHECK(is_moved(a, b, 17, 31));
    }
}

TEST_CASE("lettering: letters of straight strokes have their outlines' areas", "[lettering]") {
    // In units of the font: H has two stems of 202 x 1493 and a bar of 734 x 170; l is a stem of 184 x 1556.
    const double unit = 64.0 / 2048;
    Canvas h = black(80, 80), l = black(80, 80);
    draw_text(h, {10, 70}, "H", {64, kWhite});
    draw_text(l, {10, 70}, "l", {64, kWhite});
    CHECK(covered(h) == Approx((2 * 202 * 1493 + 734 * 170) * unit * unit).epsilon(0.005));
    CHECK(covered(l) == Approx(184 * 1556 * unit * unit).epsilon(0.005));
}

TEST_CASE("lettering: a character that the font lacks, a control character and a wrong byte are the same box", "[lettering]") {
    Canvas box = black(40, 40);
    draw_text(box, {5, 30}, "\u4e2d", {16, kWhite});
    CHECK(covered(box) > 10);
    for (const char* text : {"\xff", "\x01", "\U0001f600", "\x80"}) {
        Canvas other = black(40, 40);
        draw_text(other, {5, 30}, text, {16, kWhite});
        CHECK(is_moved(box, other, 0, 0));
    }
}

TEST_CASE("lettering: cut texts and wrapped lines keep to the width, and lines join to the text", "[lettering]") {
    std::mt19937 random(3);
    std::uniform_int_distribution<int> byte(0, 255), letter(32, 126), count(0, 60);
    std::uniform_real_distribution<double> width(1, 300);
    for (int i = 0; i < 2000; ++i) {
        // Every second text is of random bytes, in a block of its own length, so that a sanitizer sees a read past the end.
        std::string text(static_cast<std::size_t>(count(random)), ' ');
        for (char& c : text) c = static_cast<char>(i % 2 == 0 ? letter(random) : byte(random));
        const std::vector<char> block(text.begin(), text.end());
        const std::string_view view(block.data(), block.size());
        const double room = width(random);
        for (const Cut cut : {Cut::middle, Cut::end}) {
            const std::string shown = cut_to_width(view, 14, room, cut);
            CHECK(width_of_text(shown, 14) <= room + 1e-9);
            CHECK((shown == text) == (width_of_text(view, 14) <= room || text.empty()));
        }
        std::string joined;
        for (const std::string& line : wrapped_lines(view, 14, 40 + room, 1000, Cut::end)) {
            CHECK(width_of_text(line, 14) <= 40 + room + 1e-9 + width_of_text(std::string(60, ' '), 14) * (line.ends_with(' ') ? 1 : 0));
            joined += line;
        }
        std::string letters_only = text;
        std::erase(joined, ' '), std::erase(letters_only, ' ');
        CHECK(joined == letters_only);
        Canvas canvas = black(50, 20);
        draw_text(canvas, {2, 15}, view, {14, kWhite});
    }
    CHECK(cut_to_width("BeginningAndEnd", 14, 90, Cut::middle).starts_with("Beg"));
    CHECK(cut_to_width("BeginningAndEnd", 14, 90, Cut::middle).ends_with("End"));
    CHECK(cut_to_width("BeginningAndEnd", 14, 90, Cut::end).ends_with("\u2026"));
    CHECK(wrapped_lines("one two", 14, width_of_text("one two", 14) - 1, 3, Cut::end) == std::vector<std::string>{"one", "two"});
    CHECK(wrapped_lines("one two three four", 14, 60, 2, Cut::end).size() == 2);
}

TEST_CASE("marks: round lengths are the largest of 1, 2, 5 times a power of ten", "[marks]") {
    CHECK(round_length(1) == 1);
    CHECK(round_length(1.99) == 1);
    CHECK(round_length(2) == 2);
    CHECK(round_length(99.9) == 50);
    CHECK(round_length(0.049) == 0.02);
    CHECK(round_length(0.0001) == 0.0001);
    CHECK(round_length(4.9e-7) == 2e-7);
    CHECK(round_length(7e12) == 5e12);
    for (const double wrong : {0.0, -1.0, 1e30, 1e-30, std::nan("")}) CHECK(round_length(wrong) == 0.0);
}

TEST_CASE("marks: numbers have four digits or hundredths, and an exponent only where they are very small or large", "[marks]") {
    const std::pair<double, const char*> rows[] = {
        {20, "20"},           {0.5, "0.5"},     {1.0 / 3, "0.3333"},    {12.3456, "12.35"}, {123.456, "123.46"},
        {12345.6, "12345.6"}, {0.001, "0.001"}, {0.0123456, "0.01235"}, {9.99996, "10"},    {0, "0"},
        {-2.5, "-2.5"},       {1e5, "1e+05"},   {2.5e-5, "2.5e-05"},    {100, "100"}};
    for (const auto& row : rows) CHECK(number_text(row.first) == row.second);
}

TEST_CASE("marks: a scale bar is as long as its label says", "[marks]") {
    Canvas canvas = black(200, 60);
    MarkStyle style;
    style.color = kWhite, style.line_width = 2;
    CHECK(draw_scale_bar(canvas, {10, 40}, 150, 0.25, "mm", style) == 20);  // 37.5 mm have room; 20 mm are 80 pixels
    for (int x = 0; x < 200; ++x) CHECK(code(canvas, x, 40) == (x >= 10 && x < 90 ? 255 : 0));
    CHECK(draw_scale_bar(canvas, {10, 40}, 150, 0.0, "mm", style) == 0);
    CHECK(draw_scale_bar(canvas, {10, 40}, -5, 1, "mm", style) == 0);
}

TEST_CASE("marks: an axis lies in its direction, and the nearest is on top", "[marks]") {
    Canvas canvas = black(100, 100);
    draw_axes(canvas, {50, 50}, 30, {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}});
    const auto pixel = [&](int x, int y) { return &canvas.image().rgba8[4 * static_cast<std::size_t>(y * 100 + x)]; };
    CHECK(pixel(65, 50)[0] > pixel(65, 50)[2]);  // x, red, to the right
    CHECK(pixel(50, 35)[1] > pixel(50, 35)[0]);  // y, green, up
    CHECK(pixel(50, 50)[2] > pixel(50, 50)[0]);  // z, blue, a dot in front
    CHECK(code(canvas, 35, 50) == 0);
    CHECK(code(canvas, 50, 65) == 0);
}

TEST_CASE("marks: a dimension line is the same mirrored, and its text stands on a cleared place", "[marks]") {
    MarkStyle style;
    style.color = kWhite, style.background = {0, 0, 9};
    Canvas there = black(200, 60), back = black(200, 60);
    draw_dimension(there, {20, 30}, {180, 30}, "", style);
    draw_dimension(back, {180, 30}, {20, 30}, "", style);
    CHECK(is_moved(there, back, 0, 0));
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 100; ++x) CHECK(std::abs(code(there, x, y) - code(there, 199 - x, y)) <= 1);
    Canvas text = black(200, 60);
    draw_dimension(text, {20, 30}, {180, 30}, "160 mm", style);
    CHECK(code(text, 60, 30) > 100);
    const double left = 100 - width_of_text("160 mm", style.text_size) / 2;
    CHECK(code(text, static_cast<int>(left) - 2, 30) == 0);  // the line ends before the text
}

TEST_CASE("page: cells have their pictures in place, and the text of each is in its own cell", "[sheet]") {
    std::vector<SheetCell> cells(3);
    for (SheetCell& cell : cells) cell.picture = Canvas(60, 40, kWhite).take();
    cells[0].title = "front view of a long name", cells[0].note = "12 mm", cells[0].lines = {"one", "two"};
    const auto page = lay_out(cells, 2, "a footer");
    REQUIRE(page);
    constexpr int kGap = SheetLayout::kGap, kLine = SheetLayout::kLine, kLabel = SheetLayout::kLabel;
    const int cell_height = kLabel + 40 + SheetLayout::kAbove + 2 * kLine;
    CHECK(page->width == kGap + 2 * (60 + kGap));
    CHECK(page->height == kGap + 2 * (cell_height + kGap) + kLabel);
    const Canvas canvas(*page);
    const auto marks = [&](int x0, int y0, int width, int height) {
        int count = 0;
        for (int y = y0; y < y0 + height; ++y)
            for (int x = x0; x < x0 + width; ++x) count += code(canvas, x, y) != code(canvas, 0, 0) ? 1 : 0;
        return count;
    };
    CHECK(marks(kGap, kGap + kLabel, 60, 40) == 60 * 40);
    CHECK(marks(kGap, kGap, 60, kLabel) > 50);
    CHECK(marks(kGap, kGap + kLabel + 40, 60, kLabel) > 20);
    CHECK(marks(kGap + 60, kGap, kGap, cell_height) == 0);  // between two cells
    CHECK(marks(kGap + 60 + kGap, kGap, 60, kLabel) == 0);  // the second has no title
    CHECK(marks(0, page->height - kLabel, page->width, kLabel) > 50);
    CHECK(!lay_out(cells, 0, "").value().rgba8.empty());
    CHECK(lay_out({}, 0, "").has_value());
    std::vector<SheetCell> huge(2);
    huge[0].picture.width = huge[1].picture.width = 1 << 20;
    huge[0].picture.height = huge[1].picture.height = 1 << 20;
    CHECK(lay_out(huge, 0, "").error().code == ErrorCode::limit);
}
