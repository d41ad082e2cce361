#include "tests/cli/program.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

using namespace halflit::test;

namespace {

const std::vector<std::string> kNames = {"wrap-form",     "backlight",  "curves",        "green-sloan",  "sh-error",
                                         "band-energy",   "normalized", "area-light",    "half-lambert", "gamma",
                                         "shading-rates", "highlights", "light-sources", "terminator",   "terminator-edge"};
const double kPi = std::acos(-1.0);

/// Series by "plot / series"; each maps x to y.
using Numbers = std::map<std::string, std::map<double, double>>;

Numbers read_csv(const std::string& path) {
    std::istringstream lines(contents(path));
    std::string line;
    REQUIRE(std::getline(lines, line));
    REQUIRE(line == "plot,series,x,y");
    Numbers numbers;
    while (std::getline(lines, line)) {
        std::vector<std::string> fields{""};
        bool quoted = false;
        for (const char c : line) {
            if (c == '"')
                quoted = !quoted;
            else if (c == ',' && !quoted)
                fields.emplace_back();
            else
                fields.back() += c;
        }
        REQUIRE(fields.size() == 4);
        numbers[fields[0] + " / " + fields[1]][std::stod(fields[2])] = std::stod(fields[3]);
    }
    return numbers;
}

Numbers numbers_of(const std::string& name) {
    const TemporaryFolder folder;
    const Outcome outcome = run({"figures", name, "-o", folder.path()});
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(outcome.out.empty());
    CHECK(folder.names() == std::vector<std::string>{name + ".csv", name + ".svg"});
    return read_csv(folder.file(name + ".csv"));
}

const std::map<double, double>& series_of(const Numbers& numbers, const std::string& key) {
    INFO(key);
    REQUIRE(numbers.count(key) == 1);
    return numbers.at(key);
}

std::string base64_decoded(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = bits << 6 | static_cast<unsigned>(digits.find(c));
        count += 6;
        if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
    }
    return bytes;
}

double srgb_code(double linear) {
    return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(std::min(linear, 1.0), 1 / 2.4) - 0.055);
}

double sloan(double x, double a) { return x > -a ? std::pow((x + a) / (1 + a), 1 + a) : 0.0; }

/// Light that the highlights' material reflects towards the angles of L and V, written out from the vectors.
double highlight_radiance(bool phong, bool times_cosine, double light, double view, double turn) {
    const double l[3] = {std::sin(light), 0, std::cos(light)};
    const double v[3] = {std::sin(view) * std::cos(turn), std::sin(view) * std::sin(turn), std::cos(view)};
    const double h[3] = {l[0] + v[0], l[1] + v[1], l[2] + v[2]};
    const double n_h = h[2] / std::sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]), r_v = l[2] * v[2] - l[0] * v[0] - l[1] * v[1];
    const double peak = 0.6 * (phong ? 48.0 / 8 : (1600.0 + 400 + 32) / (8 * 44));
    const double highlight = peak * (phong ? std::pow(std::max(0.0, r_v), 10) : std::pow(n_h, 40));
    return 0.3 * l[2] + highlight * (times_cosine ? l[2] : 1);
}

}  // namespace

TEST_CASE("figures: --list names every figure with its source", "[cli][figures]") {
    const Outcome outcome = run({"figures", "--list"});
    REQUIRE(outcome.code == 0);
    CHECK(outcome.err.empty());
    std::istringstream lines(outcome.out);
    std::vector<std::string> names;
    for (std::string line; std::getline(lines, line);) {
        names.push_back(line.substr(0, line.find(' ')));
        INFO(line);
        CHECK(line.find("; [") != std::string::npos);
    }
    CHECK(names == kNames);
}

TEST_CASE("figures: the order-3 error is the closed form's at a = 0 and 1/2, falls, and is 0 at a = 1", "[cli][figures]") {
    const Numbers numbers = numbers_of("sh-error");
    const std::string plot = "Order-3 error of Sloan's lobe / ";
    const auto& absolute = series_of(numbers, plot + "absolute, |f - f_3|");
    REQUIRE(absolute.size() == 101);
    CHECK(absolute.at(0) == Approx(std::sqrt(kPi / 192)).epsilon(1e-9));
    CHECK(absolute.at(1) == 0.0);
    double before = 1;
    for (const auto& [a, error] : absolute) {
        INFO("a = " << a);
        CHECK(error < before);
        before = error;
    }
    const auto& relative = series_of(numbers, plot + "relative, |f - f_3| / |f|");
    CHECK(relative.at(0) == Approx(1 / (8 * std::sqrt(2.0))).epsilon(1e-9));
    CHECK(relative.at(0.5) == Approx(1.0 / 35).epsilon(1e-8));
    CHECK(relative.at(1) == 0.0);
}

TEST_CASE("figures: the bands' energy is the closed forms', all of it in three bands at a = 1", "[cli][figures]") {
    const Numbers numbers = numbers_of("band-energy");
    const double lambert[] = {37.5, 50, 11.71875, 0, 0.5859375, 0}, valve[] = {500.0 / 9, 125.0 / 3, 25.0 / 9, 0, 0, 0};
    std::map<double, double> sum;
    for (std::size_t l = 0; l < 6; ++l) {
        const auto& share = series_of(numbers, "Shares of the energy / band " + std::to_string(l));
        REQUIRE(share.size() == 101);
        INFO("band " << l);
        CHECK(share.at(0) == Approx(lambert[l]).epsilon(1e-9).margin(1e-12));
        CHECK(share.at(1) == Approx(valve[l]).epsilon(1e-9));
        for (const auto& [a, percent] : share) sum[a] += percent;
    }
    CHECK(sum.at(1) == Approx(100).epsilon(1e-9));
    for (const auto& [a, percent] : sum) CHECK(percent <= 100 + 1e-7);
}

TEST_CASE("figures: the curves are the formulas", "[cli][figures]") {
    const Numbers numbers = numbers_of("curves");
    const auto check = [&](const std::string& key, auto&& f) {
        const auto& curve = series_of(numbers, key);
        REQUIRE(curve.size() == 721);
        for (const auto& [degrees, value] : curve) {
            INFO(key << " at " << degrees);
            CHECK(value == Approx(f(std::cos(degrees * kPi / 180))).margin(1e-9));
        }
    };
    check("Three models / Lambert", [](double x) { return std::max(0.0, x); });
    check("Three models / Valve", [](double x) { return 0.25 * (x + 1) * (x + 1); });
    check("Three models / Green, w = 1", [](double x) { return (x + 1) / 2; });
    check("Sloan's lobe / a = 0.25", [](double x) { return sloan(x, 0.25); });
}

TEST_CASE("figures: a sphere of light is Lambert's cosine while it is whole, and half-Lambert at 90 degrees", "[cli][figures]") {
    const Numbers numbers = numbers_of("area-light");
    const std::string light = "Light of the sphere, and the nearest lobe (dashed) / s = ";
    for (const int s : {0, 15, 30, 45, 60, 90}) {
        const auto& curve = series_of(numbers, light + std::to_string(s) + "°");
        REQUIRE(curve.size() == 181);
        for (const auto& [degrees, value] : curve) {
            INFO("s = " << s << ", at " << degrees << " degrees");
            const double x = std::cos(degrees * kPi / 180);
            if (degrees + s <= 90) CHECK(value == Approx(x).margin(1e-9));
            if (degrees - s >= 90) CHECK(value == Approx(0).margin(1e-9));
            if (s == 90) CHECK(value == Approx((1 + x) / 2).margin(1e-9));
        }
    }
    const std::string fits = "Wrap and power of the nearest lobes / ";
    const auto &w = series_of(numbers, fits + "w"), &n = series_of(numbers, fits + "n");
    REQUIRE(w.size() == 90);
    CHECK(w.at(90) == 1);
    CHECK(n.at(90) == Approx(1).margin(1e-6));
    for (const auto& [s, error] : series_of(numbers, "Largest difference from the sphere's light / w and n")) {
        INFO("s = " << s);
        CHECK(error < 0.028);
    }
}

TEST_CASE("figures: half-Lambert in codes is darker than in linear light, and close to its square", "[cli][figures]") {
    const TemporaryFolder folder;
    REQUIRE(run({"figures", "gamma", "--format", "png", "-o", folder.path()}).code == 0);
    const Numbers numbers = read_csv(folder.file("gamma.csv"));
    const auto curve = [&](const std::string& name) {
        for (const auto& [key, series] : numbers)
            if (key.ends_with(" / " + name)) return series;
        return std::map<double, double>{};
    };
    const auto codes = curve("half-Lambert, in codes"), linear = curve("half-Lambert, linear"), square = curve("its square, linear");
    REQUIRE(codes.size() == 201);
    for (const auto& [x, code] : codes) {
        const double half = (1 + x) / 2;
        INFO("x = " << x);
        CHECK(code == Approx(srgb_code(0.5) * half).margin(1e-6));
        CHECK(linear.at(x) == Approx(srgb_code(0.5 * half)).margin(1e-6));
        CHECK(square.at(x) == Approx(srgb_code(0.5 * half * half)).margin(1e-6));
        CHECK(linear.at(x) >= code - 1e-6);
        CHECK(std::abs(square.at(x) - code) < 10);
    }
    // The sphere of the first row, 300 pixels wide in a view 2.16 high: its normal at (x, y) is (x, y, sqrt(1 - x^2 - y^2)).
    const Picture sheet = read_picture(contents(folder.file("gamma.png")));
    const double length = std::sqrt(0.9 * 0.9 + 0.45 * 0.45 + 0.35 * 0.35);
    for (int i = 30; i < 270; i += 30) {
        const double x = ((i + 0.5) / 150 - 1) * 1.08, z = std::sqrt(1 - x * x), y = -0.5 / 150 * 1.08;
        const double half = (1 + (-0.9 * x + 0.45 * y + 0.35 * z) / length) / 2;
        INFO("column " << i);
        CHECK(std::abs(sheet.pixel(i, 150)[0] - srgb_code(0.5) * half) < 2.0);
    }
}

TEST_CASE("figures: highlights with N.L reflect at most kd + ks, those without exceed 1 at grazing light", "[cli][figures]") {
    const Numbers numbers = numbers_of("highlights");
    const std::string plot = "Energy, k_d = 0.3, k_s = 0.6 / ", mirror = "Energy, k_d = 0, k_s = 1 / ";
    // Light from straight above: Phong's factor is exact, Blinn's is (s^2 + 10 s + 32) / (8 (s + 4)) of (s + 2)(s + 4) / (8 (2^(-s/2) +
    // s)).
    const double blinn_part = 2032.0 / (8 * 44) / (42.0 * 44 / (8 * (std::pow(2.0, -20) + 40)));
    for (const char* form : {"Phong", "Phong × N.L"}) {
        CHECK(series_of(numbers, plot + form).at(0) == Approx(0.9).epsilon(1e-6));
        CHECK(series_of(numbers, mirror + form).at(0) == Approx(1).epsilon(1e-6));
    }
    for (const char* form : {"Blinn", "Blinn × N.L"}) {
        CHECK(series_of(numbers, plot + form).at(0) == Approx(0.3 + 0.6 * blinn_part).epsilon(1e-6));
        CHECK(series_of(numbers, mirror + form).at(0) == Approx(blinn_part).epsilon(1e-6));
    }
    for (const bool phong : {true, false}) {
        const std::string name = phong ? "Phong" : "Blinn";
        const auto &with = series_of(numbers, plot + name + " × N.L"), &without = series_of(numbers, plot + name);
        REQUIRE(with.size() == 90);
        for (const auto& [degrees, share] : with) {
            INFO(name << " at " << degrees);
            CHECK(share <= 0.9 + 1e-6);
            CHECK(without.at(degrees) == Approx(0.3 + (share - 0.3) / std::cos(degrees * kPi / 180)).epsilon(1e-8));
        }
        CHECK(without.at(89) > 1);  // the highlight's energy stays, that received is 1/57
        // Midpoints of equal angles.
        for (const int degrees : {30, 60, 85}) {
            constexpr int kViews = 400, kTurns = 400;
            const double light = degrees * kPi / 180;
            double sum = 0;
            for (int i = 0; i < kViews; ++i)
                for (int k = 0; k < kTurns; ++k) {
                    const double view = (i + 0.5) / kViews * kPi / 2, turn = (k + 0.5) / kTurns * 2 * kPi;
                    sum += highlight_radiance(phong, true, light, view, turn) * std::cos(view) * std::sin(view);
                }
            const double energy = sum * (kPi / 2 / kViews) * (2 * kPi / kTurns);
            INFO(name << " at " << degrees);
            CHECK(with.at(degrees) == Approx(energy / (kPi * std::cos(light))).epsilon(1e-4));
        }
        for (const int degrees : {0, 45, 75})
            for (const bool times_cosine : {false, true}) {
                const auto& curve = series_of(
                    numbers, "Reflected, light at " + std::to_string(degrees) + "° (grey) / " + name + (times_cosine ? " × N.L" : ""));
                REQUIRE(curve.size() > 300);
                for (const auto& [x, y] : curve) {
                    if (y < 1e-6) continue;  // along the surface: the angle is lost in the rounding
                    INFO(name << " at " << degrees << ", point " << x << ' ' << y);
                    // The light comes from the left, so the eye on the right is opposite to it.
                    CHECK(std::hypot(x, y) == Approx(highlight_radiance(phong, times_cosine, degrees * kPi / 180, std::atan2(x, y), kPi)));
                }
            }
    }
}

TEST_CASE("figures: the contrast of the terminator's edge is the closed form, and the renderer's pictures have it", "[cli][figures]") {
    const TemporaryFolder folder;
    REQUIRE(run({"figures", "terminator-edge", "--format", "png", "-o", folder.path()}).code == 0);
    const Numbers numbers = read_csv(folder.file("terminator-edge.csv"));
    // A Lambert edge h = 0.05 radii wide; the other lights' heights above the terminator's middle have the mean 1/2.
    const auto light = [](double n, double e) { return 0.5 * (1 - e) * (n - 1) / n + e; };
    const auto contrast = [&](double n, double e) { return 100 * 0.025 * (1 - e) / n / (light(n, e) + 0.01); };
    const std::string plot = "Contrast of the edge / ";
    const auto& lambert = series_of(numbers, plot + "Lambert");
    REQUIRE(lambert.size() == 16);
    for (const auto& [n, percent] : lambert) {
        INFO(n << " lights");
        CHECK(percent == Approx(contrast(n, 0)).epsilon(1e-6));
        CHECK(series_of(numbers, plot + "Lambert, e = 20 %").at(n) == Approx(contrast(n, 0.2)).epsilon(1e-6));
        CHECK((percent < 1) == (n >= 6));  // 5 / (n - 1 + n / 50) < 1 for n > 5.9
    }
    for (const std::string name : {"Lambert", "Sloan, a = 0.5"}) {
        const auto& drawn = series_of(numbers, plot + name + ", drawn");
        REQUIRE(drawn.size() == 5);
        for (const auto& [n, percent] : drawn) {
            INFO(name << ", " << n << " lights");
            CHECK(percent == Approx(series_of(numbers, plot + name).at(n)).epsilon(0.03));
        }
    }
    // One light and Sloan's lobe, a = 1/2, whose bands begin with 6/5.
    double largest = 0;
    for (int i = -1000; i <= 1000; ++i) {
        const double p = -0.5 + 0.05 * i / 1000, bend = 0.5 * (sloan(p - 0.05, 0.5) + sloan(p + 0.05, 0.5)) - sloan(p, 0.5);
        largest = std::max(largest, 0.8 * std::abs(bend) / (0.8 * sloan(p, 0.5) + 0.2 * 1.2 + 0.01));
    }
    CHECK(series_of(numbers, plot + "Sloan, a = 0.5, e = 20 %").at(1) == Approx(100 * largest).epsilon(1e-3));
    // Beside black the second difference is the code of the light one step inside.
    CHECK(series_of(numbers, "Largest second difference of codes / Lambert").at(1) == Approx(srgb_code(0.05)).epsilon(1e-6));
    for (const int n : {2, 4, 8, 16}) {
        const std::string lights = std::to_string(n) + " lights";
        const auto& jump = series_of(numbers, "Jump of the slope at Lambert's edge / " + lights);
        REQUIRE(jump.size() == 51);
        for (const auto& [share, codes] : jump) {
            const double e = share / 100, at_edge = light(n, e), small = 1e-5;
            const double slope = (srgb_code(at_edge + small) - srgb_code(at_edge - small)) / (2 * small);
            INFO(lights << ", e = " << share);
            CHECK(codes == Approx(slope * (1 - e) / n / 5).epsilon(1e-5));
            CHECK(series_of(numbers, "Contrast of Lambert's edge / " + lights).at(share) == Approx(contrast(n, e)).epsilon(1e-6));
        }
    }
    // The first picture of the fourth row's last column: one light of 1/2 and an environment of 1/2, 300 pixels for 2.16 radii.
    const Picture sheet = read_picture(contents(folder.file("terminator-edge.png")));
    for (int i = 30; i < 270; i += 20) {
        const double p = ((i + 0.5) / 150 - 1) * 1.08;
        INFO("column " << i);
        CHECK(std::abs(sheet.pixel(4 * 308 + i, 3 * 308 + 150)[0] - srgb_code(0.5 * std::max(p, 0.0) + 0.5)) < 2.0);
    }
}

TEST_CASE("figures: pictures show the lobes' values, alike in a sheet and on a page", "[cli][figures]") {
    const TemporaryFolder folder;
    REQUIRE(run({"figures", "backlight", "--format", "png", "-o", folder.file("new/folder")}).code == 0);
    REQUIRE(run({"figures", "backlight", "-o", folder.path()}).code == 0);
    const Picture sheet = read_picture(contents(folder.file("new/folder/backlight.png")));
    REQUIRE(sheet.width == 1208);
    REQUIRE(sheet.height == 600);
    // A sphere of radius 1 in a view 2.16 high, lit from behind with strength 2: cos t = -sqrt(1 - r^2).
    for (int x = 300; x < 560; x += 20) {
        const double r = (x + 0.5 - 300) / 300 * 1.08, half = 0.5 * (1 - std::sqrt(std::max(0.0, 1 - r * r)));
        INFO("x = " << x);
        CHECK(std::abs(sheet.pixel(x, 300)[0] - srgb_code(2 * half)) < 2.0);
        CHECK(std::abs(sheet.pixel(608 + x, 300)[0] - srgb_code(2 * half * half)) < 2.0);
    }
    const std::string svg = contents(folder.file("backlight.svg")), mark = "data:image/png;base64,";
    REQUIRE(svg.starts_with("<svg "));
    REQUIRE(svg.ends_with("</svg>\n"));
    const std::size_t start = svg.find(mark) + mark.size();
    const Picture first = read_picture(base64_decoded(svg.substr(start, svg.find('"', start) - start)));
    REQUIRE(first.width == 600);
    bool same = true;
    for (int y = 0; y < 600; ++y)
        for (int x = 0; x < 600; ++x) same = same && first.pixel(x, y) == sheet.pixel(x, y);
    CHECK(same);
}

TEST_CASE("figures: a page has its title once and says what its citations name", "[cli][figures]") {
    const TemporaryFolder folder;
    REQUIRE(run({"figures", "sh-error", "curves", "-o", folder.path()}).code == 0);
    const std::string svg = contents(folder.file("sh-error.svg")), literature = contents(HALFLIT_SOURCE_DIR "/sh/README.md");
    const std::string title = "Error of Sloan's lobe in order-3 spherical harmonics";
    const auto count = [](const std::string& text, const std::string& part) {
        std::size_t n = 0;
        for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
        return n;
    };
    CHECK(count(svg, title) == 2);                            // one is shown, one is for screen readers
    CHECK(count(svg, "Order-3 error of Sloan's lobe") == 0);  // the only plot needs no title of its own
    const std::size_t row = literature.find("| [SNY11] | ") + 12;
    const std::string source = literature.substr(row, literature.find(" |", row) - row);
    REQUIRE(source.find("Wrap Shading") != std::string::npos);
    CHECK(count(svg, "[SNY11] " + source) == 1);
    CHECK(count(contents(folder.file("curves.svg")), "[SNY11] " + source) == 1);
}

TEST_CASE("figures: an unknown name ends before anything is made, and lists the known ones", "[cli][figures]") {
    const TemporaryFolder folder;
    const Outcome outcome = run({"figures", "curves", "figure-7", "-o", folder.file("out")});
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find("'figure-7'") != std::string::npos);
    for (const std::string& name : kNames) CHECK(outcome.err.find(name) != std::string::npos);
    CHECK(folder.names().empty());
    CHECK(run({"figures", "--format", "gif", "-o", folder.file("out")}).code == 2);
    CHECK(run({"figures", "curves", "-o", "-"}).code == 2);
    write_contents(folder.file("file"), "");
    for (const std::string& path : {folder.file("file"), folder.file("file/below")}) {
        const Outcome blocked = run({"figures", "curves", "-o", path});
        INFO(blocked.err);
        CHECK(blocked.code == 4);
        CHECK(blocked.err.find(path) != std::string::npos);
    }
}

TEST_CASE("figures: all of them come with an index, and the terminator's profiles keep what shadow modes promise", "[cli][figures][slow]") {
    const TemporaryFolder folder;
    const Outcome outcome = run({"figures", "-o", folder.path()});
    REQUIRE(outcome.code == 0);
    const std::string index = contents(folder.file("index.html")), literature = contents(HALFLIT_SOURCE_DIR "/sh/README.md");
    CHECK(index.ends_with("</html>\n"));
    for (const char* key : {"SNY11", "McA13", "Lis", "CMSC", "Green04", "Valve06"}) {
        const std::size_t row = literature.find("| [" + std::string(key) + "] | ");
        REQUIRE(row != std::string::npos);
        const std::size_t start = literature.find(" | ", row) + 3;
        INFO(key);
        CHECK(index.find("<li>[" + std::string(key) + "] " + literature.substr(start, literature.find(" |", start) - start) + "</li>") !=
              std::string::npos);
    }
    for (const std::string& name : kNames) {
        INFO(name);
        CHECK(index.find("<img src=\"" + name + ".svg\"") != std::string::npos);
        const std::string svg = contents(folder.file(name + ".svg"));
        CHECK(svg.starts_with("<svg "));
        CHECK(svg.ends_with("</svg>\n"));
        CHECK(svg.find(">nan<") == std::string::npos);
    }

    const Numbers numbers = read_csv(folder.file("terminator.csv"));
    for (const double a : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        std::ostringstream wrap;
        wrap << " / a = " << a;
        INFO("a = " << a);
        // A step of the finest row is 1/300 of the radius; where the lobe is steepest that is 1/300 of the light.
        for (const auto& [x, light] : series_of(numbers, "sphere, off" + wrap.str())) CHECK(light == Approx(sloan(x, a)).margin(2e-3));
        double before = 0;
        for (const auto& [x, light] : series_of(numbers, "sphere, soft-split" + wrap.str())) {
            INFO("x = " << x);
            if (x > 0) CHECK(light == Approx(sloan(x, a)).margin(2e-3));
            CHECK(std::abs(light - before) < 0.01);
            before = light;
        }
        for (const auto& [x, light] : series_of(numbers, "sphere, hard" + wrap.str())) {
            INFO("x = " << x);
            if (x > 0) CHECK(light == Approx(sloan(x, a)).margin(2e-3));
            if (x < -0.12) CHECK(light == 0.0);
        }
        // The ball hides z in 0.63 .. 0.97: |x| in 0.21 .. 0.77.
        for (const std::string mode : {"hard", "soft-split"})
            for (const auto& [x, light] : series_of(numbers, "ball's shadow, " + mode + wrap.str()))
                if (std::abs(x) > 0.26 && std::abs(x) < 0.74) CHECK(light == 0.0);
    }
}
