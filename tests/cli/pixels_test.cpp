#include "tests/cli/program.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace halflit::test;

namespace {

std::string png(std::vector<std::string> arguments, const RunSettings& settings = {}) {
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"-o", "-"});
    const Outcome outcome = run(arguments, settings);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return outcome.out;
}

}  // namespace

TEST_CASE("pixels: the demo scene's file is the same for all threads, tiles and instruction sets", "[cli][slow]") {
    const std::vector<std::string> demo = {"demo", "--size", "320x180"};
    const std::string expected = png(demo);
    const auto with = [&](std::vector<std::string> flags) {
        flags.insert(flags.begin(), demo.begin(), demo.end());
        return png(flags);
    };
    for (const char* threads : {"1", "2", "5"}) CHECK(with({"--threads", threads}) == expected);
    for (const char* tile : {"16", "32"}) CHECK(with({"--tile", tile}) == expected);
    int sets = 0;
    for (const char* isa : {"scalar", "sse2", "sse4.1", "avx2", "avx512", "neon64", "wasm128"}) {
        if (run({"info", "sphere:12", "--isa", isa}).code != 0) continue;  // not on this CPU
        ++sets;
        INFO(isa);
        CHECK(with({"--isa", isa}) == expected);
    }
    CHECK(sets >= 2);
}

TEST_CASE("pixels: a region is the crop of the full picture", "[cli]") {
    const std::vector<std::string> scene = {"demo", "--size", "200x120"};
    const Picture full = read_picture(png(scene));
    for (const auto& [x, y, w, h] :
         std::vector<std::array<int, 4>>{{0, 0, 200, 120}, {37, 11, 90, 70}, {199, 119, 1, 1}, {0, 60, 200, 1}, {63, 0, 3, 120}}) {
        const std::string region = std::to_string(x) + "," + std::to_string(y) + "," + std::to_string(w) + "," + std::to_string(h);
        INFO(region);
        const Picture part = read_picture(png({"demo", "--size", "200x120", "--region", region}));
        REQUIRE(part.width == w);
        REQUIRE(part.height == h);
        bool equal = true;
        for (int row = 0; row < h; ++row)
            for (int column = 0; column < w; ++column) equal = equal && part.pixel(column, row) == full.pixel(x + column, y + row);
        CHECK(equal);
    }
}

TEST_CASE("pixels: locale, time zone, home and folder change no byte", "[cli]") {
    const TemporaryFolder folder;
    const std::vector<std::string> scene = {
        "sphere:500", "--size", "50x40", "--zoom", "1.5", "--light", "point:pos=0.5,2,1.5:intensity=2.5"};
    const std::string expected = png(scene);
    CHECK(png(scene, {.environment = {{"LC_ALL", "de_DE.UTF-8"}, {"LANG", "de_DE.UTF-8"}}}) == expected);
    CHECK(png(scene, {.environment = {{"TZ", "Asia/Kolkata"}, {"HOME", "/nonexistent"}, {"TMPDIR", "/nonexistent"}}}) == expected);
    CHECK(png(scene, {.folder = folder.path()}) == expected);
}

TEST_CASE("pixels: a background's codes come out as they were given", "[cli]") {
    const std::vector<std::string> beside = {"sphere:12", "--size", "160x64", "--region", "0,0,2,2"};
    const auto corner = [&](const std::string& color) {
        auto flags = beside;
        flags.insert(flags.end(), {"--background", color});
        return read_picture(png(flags)).pixel(0, 0);
    };
    CHECK(corner("#010203") == std::vector<int>{1, 2, 3, 255});
    CHECK(corner("#80fefd") == std::vector<int>{128, 254, 253, 255});
    CHECK(corner("#a1b2c340") == std::vector<int>{161, 178, 195, 64});
    CHECK(corner("#f0c") == std::vector<int>{255, 0, 204, 255});
    CHECK(corner("orange") == std::vector<int>{255, 165, 0, 255});
    CHECK(corner("transparent")[3] == 0);
}

TEST_CASE("pixels: a tone curve changes surfaces, and neither the background colour nor .hdr files", "[cli]") {
    const TemporaryFolder folder;
    const auto draw = [&](const std::string& name, const std::vector<std::string>& flags) {
        std::vector<std::string> all = {"render", "sphere:500", "--size", "60x40", "--exposure", "2", "-o", folder.file(name)};
        all.insert(all.end(), flags.begin(), flags.end());
        REQUIRE(run(all).code == 0);
        return contents(folder.file(name));
    };
    const Picture plain = read_picture(draw("plain.png", {"--tonemap", "none"}));
    const std::string light = draw("plain.hdr", {});
    CHECK(draw("neutral_too.png", {"--tonemap", "neutral"}) == draw("default.png", {}));
    for (const std::string curve : {"reinhard", "aces", "neutral"}) {
        const Picture toned = read_picture(draw(curve + ".png", {"--tonemap", curve}));
        CHECK(toned.pixel(0, 0) == std::vector<int>{0x2c, 0x30, 0x36, 255});
        CHECK(toned.pixel(30, 20) != plain.pixel(30, 20));
        CHECK(draw(curve + ".hdr", {"--tonemap", curve}) == light);
    }
}

TEST_CASE("pixels: ambient alone shows a surface's colour at every angle", "[cli]") {
    // The material is clay, 0.8 0.75 0.7 linear, under ambient 1: every pixel of it has this colour, as sRGB codes 231 225 218.
    const Picture picture = read_picture(
        png({"sphere:5000", "--size", "90x90", "--no-scene-lights", "--ambient", "1,1,1", "--specular", "none", "--tonemap", "none"}));
    for (const auto& [x, y] : std::vector<std::pair<int, int>>{{45, 45}, {20, 45}, {45, 75}, {70, 30}})
        CHECK(picture.pixel(x, y) == std::vector<int>{231, 225, 218, 255});
}

TEST_CASE("pixels: a step of exposure doubles the light", "[cli]") {
    const auto middle = [](const std::string& ambient, const std::string& ev) {
        return read_picture(png({"sphere:500", "--size", "31x31", "--no-scene-lights", "--specular", "none", "--ambient", ambient,
                                 "--exposure", ev}))
            .pixel(15, 15);
    };
    CHECK(middle("0.25,0.25,0.25", "1") == middle("0.5,0.5,0.5", "0"));
    CHECK(middle("0.25,0.25,0.25", "2") == middle("1,1,1", "0"));
    CHECK(middle("0.5,0.5,0.5", "-1") == middle("0.25,0.25,0.25", "0"));
    // A scene without lights of a file has the exposure 1.
    CHECK(middle("0.25,0.25,0.25", "auto") == middle("0.25,0.25,0.25", "0"));
    CHECK(middle("0.25,0.25,0.25", "auto+1.0") == middle("0.5,0.5,0.5", "0"));
    CHECK(middle("0.5,0.5,0.5", "auto-1") == middle("0.25,0.25,0.25", "auto"));
}

TEST_CASE("pixels: kd, ks and shininess are the numbers of the classic formula, in every scene with materials", "[cli]") {
    // The middle of the ball faces light and eye: N.L = N.H = R.V = 1. The material is clay, 0.8 0.75 0.7 linear.
    const auto middle = [](std::vector<std::string> flags) {
        flags.insert(flags.begin(), {"sphere:5000", "--size", "101x101", "--azimuth", "0", "--elevation", "0", "--no-scene-lights",
                                     "--light", "directional:dir=0,0,-1", "--ambient", "0,0,0", "--exposure", "0", "--tonemap", "none"});
        return read_picture(png(flags)).pixel(50, 50);
    };
    const auto code = [](double linear) { return static_cast<int>(std::lround(255 * (1.055 * std::pow(linear, 1 / 2.4) - 0.055))); };
    const auto expected = [&](double kd, double ks, double norm) {
        std::vector<int> pixel;
        for (const double c : {0.8, 0.75, 0.7}) pixel.push_back(code(kd * c * (1 - ks) + ks * norm));
        pixel.push_back(255);
        return pixel;
    };
    const auto near = [](const std::vector<int>& a, const std::vector<int>& b) {  // the middle of a pixel is beside the highlight's
        for (std::size_t i = 0; i < 4; ++i)
            if (std::abs(a[i] - b[i]) > 1) return false;
        return true;
    };
    const double blinn10 = (100.0 + 100 + 32) / (8 * 14), phong10 = 18.0 / 8;
    CHECK(near(middle({"--kd", "0.5", "--ks", "0"}), expected(0.5, 0, 0)));
    CHECK(near(middle({"--kd", "0.25", "--ks", "0.1", "--shininess", "10"}), expected(0.25, 0.1, blinn10)));
    CHECK(near(middle({"--kd", "0", "--ks", "0.2", "--shininess", "10"}), expected(0, 0.2, blinn10)));
    CHECK(near(middle({"--kd", "0.25", "--ks", "0.1", "--shininess", "10", "--specular", "phong"}), expected(0.25, 0.1, phong10)));
    CHECK(near(middle({"--kd", "0.25", "--ks", "0.1", "--shininess", "10", "--accuracy", "reference"}), expected(0.25, 0.1, blinn10)));
    // Clay is not metallic and has the reflectance 0.04 already.
    CHECK(png({"sphere:500", "--size", "40x40", "--ks", "0.04", "--kd", "1"}) == png({"sphere:500", "--size", "40x40"}));
    CHECK(png({"demo", "--size", "40x30", "--ks", "0.5"}) != png({"demo", "--size", "40x30"}));
    for (const auto& [flag, value] : std::vector<std::pair<std::string, std::string>>{
             {"--kd", "1.1"}, {"--ks", "-0.1"}, {"--ks", "2"}, {"--shininess", "90000"}, {"--shininess", "nan"}}) {
        const Outcome refused = run({"render", "sphere:12", flag, value, "-o", "-"});
        INFO(flag << ' ' << value << ": " << refused.err);
        CHECK(refused.code == 2);
        CHECK(refused.err.find(flag) != std::string::npos);
    }
}

TEST_CASE("pixels: a lobe of wrap w lights the surface up to N.L = -w, and no further", "[cli]") {
    // Light from the right: N.L is about (x - 50) / 50 across the middle row.
    const auto red = [](const std::string& lobe, const std::string& wrap, int x) {
        std::vector<std::string> scene = {"sphere:5000", "--size", "101x101", "--no-scene-lights",
                                          "--env",       "none",   "--light", "directional:dir=-1,0,0",
                                          "--specular",  "none",   "--lobe",  lobe};
        if (!wrap.empty()) scene.insert(scene.end(), {"--wrap", wrap});
        return read_picture(png(scene)).pixel(x, 50)[0];
    };
    CHECK(red("lambert", "", 90) > 0);
    CHECK(red("lambert", "", 35) == 0);
    CHECK(red("green", "0.5", 35) > 0);
    CHECK(red("green", "0.5", 10) == 0);
    CHECK(red("half-lambert", "", 10) > 0);
    CHECK(red("half-lambert", "", 10) > red("valve", "", 10));  // t against t^2, t < 1
}
