// Named views, several pictures in one call, margins in pixels, lines of edges.
#include "tests/cli/program.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

using namespace halflit::test;

namespace {

using Strings = std::vector<std::string>;

/// A box of 4 x 2 x 1, as an OBJ file.
std::string box_file(const TemporaryFolder& folder) {
    std::string path = folder.file("box.obj");
    write_contents(path,
                   "v 2 1 .5\nv -2 1 .5\nv -2 -1 .5\nv 2 -1 .5\nv 2 1 -.5\nv -2 1 -.5\nv -2 -1 -.5\nv 2 -1 -.5\n"
                   "f 1 2 3 4\nf 8 7 6 5\nf 5 6 2 1\nf 4 3 7 8\nf 5 1 4 8\nf 2 6 7 3\n");
    return path;
}

Outcome draw(const TemporaryFolder& folder, const std::string& scene, const Strings& flags) {
    Strings arguments{"render", scene, "--size", "96x80", "--samples", "1"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return run(arguments, {.folder = folder.path()});
}

std::string message(const Strings& flags) {
    const TemporaryFolder folder;
    const Outcome outcome = draw(folder, "sphere:500", flags);
    CHECK(outcome.code == 2);
    CHECK(folder.names().empty());
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    return outcome.err;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Free pixels at the left, right, top and bottom.
std::array<int, 4> margins(const Picture& picture) {
    std::array<int, 4> free{picture.width, picture.width, picture.height, picture.height};
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            if (picture.pixel(x, y)[3] == 0) continue;
            free[0] = std::min(free[0], x), free[1] = std::min(free[1], picture.width - 1 - x);
            free[2] = std::min(free[2], y), free[3] = std::min(free[3], picture.height - 1 - y);
        }
    return free;
}

}  // namespace

TEST_CASE("views: several give a picture each, with one distance", "[cli]") {
    const TemporaryFolder folder;
    const std::string box = box_file(folder);
    REQUIRE(draw(folder, box, {"--view", "front,iso", "--view", "30,-20", "-o", "{view}.png"}).code == 0);
    CHECK(folder.names() == Strings{"30,-20.png", "box.obj", "front.png", "iso.png"});
    for (const std::string view : {"front", "iso", "30,-20"}) {
        REQUIRE(draw(folder, box, {"--view", view, "-o", "one.png"}).code == 0);
        CAPTURE(view);
        CHECK(read_picture(contents(folder.file("one.png"))).rgba8 == read_picture(contents(folder.file(view + ".png"))).rgba8);
    }
    const TemporaryFolder usual;
    REQUIRE(draw(usual, "sphere:500", {"--view", "top,left"}).code == 0);
    CHECK(usual.names() == Strings{"sphere_left.png", "sphere_top.png"});
}

TEST_CASE("views: --fit leaves its pixels free on the tighter side, and as much or more on the other", "[cli]") {
    const TemporaryFolder folder;
    const std::string box = box_file(folder);
    struct Case {
        std::string view;
        double width, height;  // of the box as that view shows it
    };
    for (const Case& c : {Case{"front", 4, 2}, Case{"right", 1, 2}, Case{"top", 4, 1}, Case{"bottom", 4, 1}, Case{"back", 4, 2}})
        for (const int fit : {0, 7, 20}) {
            CAPTURE(c.view, fit);
            REQUIRE(draw(folder, box,
                         {"--view", c.view, "--fit", std::to_string(fit), "--ortho", "--background", "transparent", "-o", "one.png"})
                        .code == 0);
            const auto free = margins(read_picture(contents(folder.file("one.png"))));
            const double scale = std::min((96 - 2 * fit) / c.width, (80 - 2 * fit) / c.height);  // pixels a unit
            const double beside = 48 - 0.5 * scale * c.width, above = 40 - 0.5 * scale * c.height;
            CHECK(std::min(beside, above) == Approx(fit));
            for (const int k : {0, 1}) CHECK(std::abs(free[static_cast<std::size_t>(k)] - beside) <= 1);
            for (const int k : {2, 3}) CHECK(std::abs(free[static_cast<std::size_t>(k)] - above) <= 1);
        }
}

TEST_CASE("views: by parallel rays all sides have one scale", "[cli]") {
    const TemporaryFolder folder;
    const std::string box = box_file(folder);
    const Strings flags{"--view", "front,right,top", "--fit", "8", "--ortho", "--background", "transparent", "-o", "{view}.png"};
    REQUIRE(draw(folder, box, flags).code == 0);
    const auto size = [&](const std::string& view) {
        const auto free = margins(read_picture(contents(folder.file(view + ".png"))));
        return std::pair{96 - free[0] - free[1], 80 - free[2] - free[3]};
    };
    const auto front = size("front"), right = size("right"), top = size("top");
    CHECK(std::abs(front.first - 80) <= 1);  // 4 units are 96 - 2 * 8 pixels
    CHECK(std::abs(front.second - 40) <= 1);
    CHECK(std::abs(right.first - 20) <= 1);
    CHECK(std::abs(right.second - 40) <= 1);
    CHECK(std::abs(top.first - 80) <= 1);
    CHECK(std::abs(top.second - 20) <= 1);
}

TEST_CASE("views: wrong names, missing numbers, repeated sides and patterns without a place are errors of usage", "[cli]") {
    CHECK(has(message({"--view", "frnt"}), "did you mean front"));
    CHECK(has(message({"--view", "30"}), "expected an elevation from -90 to 90 after the azimuth 30, found nothing"));
    CHECK(has(message({"--view", "30,top"}), "expected an elevation from -90 to 90 after the azimuth 30, found 'top'"));
    CHECK(has(message({"--view", "30,91"}), "expected an elevation"));
    CHECK(has(message({"--view", ""}), "--view"));
    CHECK(has(message({"--view", "top,front,top"}), "--view: expected each side once, found top twice"));
    CHECK(has(message({"--view", "10,20", "--view", "10,20"}), "--view: expected each side once, found 10,20 twice"));
    CHECK(has(message({"--view", "front,top", "-o", "x.png"}), "expected a place for the view's name, as {view}.png"));
    CHECK(has(message({"--view", "front,top", "-o", "{side}.png"}), "{view}"));
    CHECK(has(message({"--view", "front,top", "-o", "-"}), "need a file name"));
    CHECK(has(message({"--view", "front", "--frames", "0-3", "-o", "{}.png"}),
              "--view and --camera all: cannot be combined with --frames or --turntable"));
    CHECK(has(message({"--view", "front,top", "--turntable", "4", "-o", "{}.png"}), "--view and --camera all: cannot be combined"));
    CHECK(has(message({"--view", "front", "--azimuth", "30"}), "--azimuth, --elevation: cannot be combined with --view, which takes both"));
    CHECK(has(message({"--view", "front", "--camera", "0"}), "--camera: cannot be combined with --view"));
    CHECK(has(message({"--view", "front", "--camera-position", "1,2,3"}), "--camera-position: cannot be combined"));
    CHECK(has(message({"--fit", "37"}), "--fit: expected at most 36 pixels, 45 % of the picture's shorter side, found 37"));
    CHECK(has(message({"--fit", "-1"}), "--fit"));
    CHECK(has(message({"--edges", "most"}), "--edges"));
    CHECK(has(message({"--edge-width", "0"}), "--edge-width"));
}

TEST_CASE("views: --edges draws lines in their colour, and none without it", "[cli]") {
    const TemporaryFolder folder;
    const std::string box = box_file(folder);
    const auto green = [&](const Strings& flags) {
        Strings all{"--view", "iso", "--ortho", "--edge-color", "#00ff00", "-o", "one.png"};
        all.insert(all.end(), flags.begin(), flags.end());
        REQUIRE(draw(folder, box, all).code == 0);
        const Picture picture = read_picture(contents(folder.file("one.png")));
        int count = 0;
        for (std::size_t at = 0; at < picture.rgba8.size(); at += 4)
            count += picture.rgba8[at] < 90 && picture.rgba8[at + 1] > 200 && picture.rgba8[at + 2] < 90 ? 1 : 0;
        return count;
    };
    CHECK(green({}) == 0);
    const int silhouette = green({"--edges", "silhouette"}), feature = green({"--edges", "feature"}), all = green({"--edges", "all"});
    CHECK(silhouette > 50);
    CHECK(feature > silhouette + 20);  // the three edges at the nearest corner
    CHECK(all > feature + 20);         // and the diagonals of three faces
}
