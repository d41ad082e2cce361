// Drawings as files of vectors: halflit look -o FILE.svg and FILE.pdf.
#include "tests/cli/program.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <cstdlib>
#include <sstream>

using namespace halflit::test;

namespace {

// A box of 4 x 2 x 3 with a smaller one behind it, which the front view hides.
const std::string kBoxes = [] {
    std::ostringstream off;
    const double boxes[][6] = {{0, 0, 0, 4, 2, 3}, {1, -3, 1, 2, -2, 2}};  // x, y, z of two corners; y points up: the second lies below
    off << "OFF\n16 12 0\n";
    for (const auto& b : boxes)
        for (int i = 0; i < 8; ++i) off << b[i & 1 ? 3 : 0] << ' ' << b[i & 2 ? 4 : 1] << ' ' << b[i & 4 ? 5 : 2] << '\n';
    const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (int b = 0; b < 2; ++b)
        for (const auto& face : faces) {
            off << 4;
            for (const int i : face) off << ' ' << i + 8 * b;
            off << '\n';
        }
    return off.str();
}();

std::string drawn(const TemporaryFolder& folder, const std::string& name, const std::vector<std::string>& more) {
    write_contents(folder.file("boxes.off"), kBoxes);
    std::vector<std::string> words{"look", folder.file("boxes.off"), "--size", "300x240", "-o", folder.file(name)};
    words.insert(words.end(), more.begin(), more.end());
    REQUIRE(run(words).code == 0);
    return contents(folder.file(name));
}

/// The text of the first group of the layer.
std::string layer_of(const std::string& svg, const std::string& layer) {
    const std::size_t begin = svg.find("inkscape:label=\"" + layer + "\"");
    return begin == std::string::npos ? "" : svg.substr(begin, svg.find("</g>", begin) - begin);
}

std::vector<std::pair<double, double>> points_of(const std::string& layer) {
    std::vector<std::pair<double, double>> points;
    const std::size_t begin = layer.find(" d=\"") + 4;
    std::string path = layer.substr(begin, layer.find('"', begin) - begin);
    for (char& c : path)
        if (c == 'M' || c == 'L' || c == 'Z') c = ' ';
    std::istringstream numbers(path);
    for (double x = 0, y = 0; numbers >> x >> y;) points.emplace_back(x, y);
    return points;
}

}  // namespace

TEST_CASE("vectors: an SVG's lines lie where the picture has them, and hidden ones are a layer of their own", "[cli][look]") {
    const TemporaryFolder folder;
    const std::string svg = drawn(folder, "x.svg", {"--view", "top", "--hidden-edges", "dashed"});
    CHECK(svg.starts_with("<svg xmlns="));
    CHECK(svg.ends_with("</svg>\n"));
    const std::string visible = layer_of(svg, "visible"), hidden = layer_of(svg, "hidden"), marks = layer_of(svg, "marks");
    CHECK(!marks.empty());
    CHECK(contains(hidden, "stroke-dasharray"));
    CHECK(!contains(visible, "stroke-dasharray"));
    // Seen from above: the outline of the upper box, 4 by 3, and below it, hidden, a square of 1.
    const auto outline = points_of(visible), square = points_of(hidden);
    const auto extent = [](const auto& points) {
        double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
        for (const auto& [x, y] : points) x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
        return std::pair(x1 - x0, y1 - y0);
    };
    REQUIRE(outline.size() >= 4);
    const auto [width, height] = extent(outline);
    CHECK(std::abs(width / height - 4.0 / 3.0) < 1e-3);
    CHECK(!square.empty());

    const std::string png = drawn(folder, "x.png", {"--view", "top", "--hidden-edges", "dashed"});
    const Picture picture = read_picture(png);
    for (const auto& [x, y] : outline) {  // corners of black lines
        const auto pixel = picture.pixel(static_cast<int>(x), static_cast<int>(y));
        CHECK(pixel[0] < 90);
    }
    CHECK(layer_of(drawn(folder, "y.svg", {"--view", "top"}), "hidden").empty());
}

TEST_CASE("vectors: a PDF's table of objects has their places, and its stream its length", "[cli][look]") {
    const TemporaryFolder folder;
    const std::string pdf = drawn(folder, "x.pdf", {});
    CHECK(pdf.starts_with("%PDF-1.4\n"));
    CHECK(pdf.ends_with("%%EOF\n"));
    const std::size_t table = std::strtoul(pdf.c_str() + pdf.rfind("startxref\n") + 10, nullptr, 10);
    REQUIRE(pdf.compare(table, 5, "xref\n") == 0);
    for (int i = 1; i <= 4; ++i) {
        const std::size_t place = std::strtoul(pdf.c_str() + pdf.find('\n', table + 5) + 1 + 20 * i, nullptr, 10);
        const std::string begins = std::to_string(i) + " 0 obj\n";
        CHECK(pdf.compare(place, begins.size(), begins) == 0);
    }
    const std::size_t length = std::strtoul(pdf.c_str() + pdf.find("/Length ") + 8, nullptr, 10), stream = pdf.find("stream\n") + 7;
    CHECK(pdf.compare(stream + length, 9, "endstream") == 0);
}
