// halflit sheet: cells, names, references and failures.
#include "tests/cli/program.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <filesystem>

using namespace halflit::test;

namespace {

constexpr int kGap = 8, kLabel = 22, kSecondLine = 18;  // of the page

/// Number of pixels of a cell's picture that are not those of `expected`.
int wrong_pixels(const Picture& sheet, int x0, int y0, const Picture& expected) {
    int wrong = 0;
    for (int y = 0; y < expected.height; ++y)
        for (int x = 0; x < expected.width; ++x) wrong += sheet.pixel(x0 + x, y0 + y) != expected.pixel(x, y) ? 1 : 0;
    return wrong;
}

/// Pixels of a box that do not have the colour of the page's corner.
int marks(const Picture& sheet, int x0, int y0, int width, int height) {
    int count = 0;
    for (int y = y0; y < y0 + height; ++y)
        for (int x = x0; x < x0 + width; ++x) count += sheet.pixel(x, y) != sheet.pixel(0, 0) ? 1 : 0;
    return count;
}

}  // namespace

TEST_CASE("sheet: each cell has the pixels that render gives, and a name", "[cli]") {
    const TemporaryFolder folder;
    const std::vector<std::string> scenes{"demo", "sphere:500", "lights:4"};
    std::vector<std::string> flags{"sheet"};
    flags.insert(flags.end(), scenes.begin(), scenes.end());
    for (const char* flag : {"--size", "60x40", "--columns", "2", "--lobe", "sloan", "-o"}) flags.emplace_back(flag);
    flags.push_back(folder.file("sheet.png"));
    REQUIRE(run(flags).code == 0);
    const Picture sheet = read_picture(contents(folder.file("sheet.png")));
    REQUIRE(sheet.width == kGap + 2 * (60 + kGap));
    constexpr int kNames = kLabel + kSecondLine;  // "sphere:500" is wider than a cell, so all have two lines
    REQUIRE(sheet.height == kGap + 2 * (40 + kNames + kGap));
    for (int i = 0; i < 3; ++i) {
        CAPTURE(i);
        const Picture alone =
            read_picture(run({"render", scenes[static_cast<std::size_t>(i)], "--size", "60x40", "--lobe", "sloan", "-o", "-"}).out);
        const int x = kGap + i % 2 * (60 + kGap), y = kGap + i / 2 * (40 + kNames + kGap);
        CHECK(wrong_pixels(sheet, x, y, alone) == 0);
        CHECK(marks(sheet, x, y + 40, 60, kNames) > 20);
    }
    CHECK(marks(sheet, kGap + 60 + kGap, kGap + 40 + kNames + kGap, 60, 40 + kNames) == 0);  // there is no fourth
}

TEST_CASE("sheet: a scene that fails has its line in its cell, the others are drawn, and the exit code is the first failure's", "[cli]") {
    const TemporaryFolder folder;
    write_contents(folder.file("broken.glb"), "no model");
    const Outcome outcome = run({"sheet", folder.file("broken.glb"), "no/such.glb", "sphere:500", "--size", "80x60", "--columns", "3", "-o",
                                 folder.file("sheet.png")});
    CHECK(outcome.code == 3);
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 3);  // two errors and "wrote"
    const Picture sheet = read_picture(contents(folder.file("sheet.png")));
    const Picture ball = read_picture(run({"render", "sphere:500", "--size", "80x60", "-o", "-"}).out);
    CHECK(wrong_pixels(sheet, kGap + 2 * (80 + kGap), kGap, ball) == 0);
    for (const int cell : {0, 1}) CHECK(marks(sheet, kGap + cell * (80 + kGap), kGap, 80, 60) == 80 * 60);
    CHECK(run({"sheet", "no/such.glb", folder.file("broken.glb"), "--size", "20", "-o", folder.file("sheet.png")}).code == 4);
}

TEST_CASE("sheet: references stand beside their pictures, scaled by the mean of their light", "[cli]") {
    const TemporaryFolder folder;
    // 100 x 100 pixels, black and white in turn: half the light of white is the code 188. The left upper quarter is red.
    std::vector<unsigned char> pixels;
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x) {
            const bool red = x < 50 && y < 50;
            const unsigned char code = (x + y) % 2 == 0 ? 255 : 0;
            for (int c = 0; c < 3; ++c) pixels.push_back(red ? (c == 0 ? 255 : 0) : code);
            pixels.push_back(255);
        }
    write_contents(folder.file("ball.png"), png_of(100, 100, pixels));
    std::filesystem::create_directories(folder.file("models/screenshot"));
    write_contents(folder.file("models/screenshot/screenshot.png"), png_of(100, 100, pixels));
    write_contents(folder.file("models/ball.gltf"), R"({"asset":{"version":"2.0"}})");
    for (const std::string& references : {folder.path(), std::string("beside")}) {
        REQUIRE(run({"sheet", folder.file("models/ball.gltf"), "--size", "40x20", "--references", references, "-o", folder.file("s.png")})
                    .code == 0);
        const Picture sheet = read_picture(contents(folder.file("s.png")));
        REQUIRE(sheet.width == kGap + 40 + kGap + 40 + kGap);
        const int x = kGap + 40 + kGap + 10, y = kGap;  // 20 x 20 pixels, in the middle of 40 x 20
        CHECK(sheet.pixel(x - 1, y + 3) == sheet.pixel(0, 0));
        CHECK(sheet.pixel(x + 3, y + 3) == std::vector<int>{255, 0, 0, 255});
        const int light = sheet.pixel(x + 15, y + 15)[0];
        // Five by five pixels: 12 or 13 of 25 are white.
        CHECK((light == 184 || light == 191));
    }
    CHECK(run({"sheet", "demo", "--size", "20", "--references", folder.file("none"), "-o", folder.file("t.png")}).code == 4);
}

TEST_CASE("sheet: files that are read are not overwritten, and floats are refused", "[cli]") {
    const TemporaryFolder folder;
    write_contents(folder.file("a.png"), R"({"asset":{"version":"2.0"}})");
    CHECK(run({"sheet", folder.file("a.png"), "-o", folder.file("a.png")}).code == 4);
    CHECK(contents(folder.file("a.png")).starts_with("{"));
    CHECK(run({"sheet", "demo", "-o", folder.file("a.pfm")}).code == 2);
    CHECK(run({"sheet", "demo", "--region", "0,0,2,2", "-o", folder.file("b.png")}).code == 2);
    CHECK(run({"sheet", "demo", "demo", "--size", "16000", "-o", folder.file("b.png")}).code == 5);
    CHECK(folder.names() == std::vector<std::string>{"a.png"});
}
