// Scenes that are tiny, huge or far from the origin: LoadOptions::recentre.
#include "halflit/auto_setup.hpp"
#include "halflit/renderer.hpp"
#include "tests/io/gltf_builder.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <cstdlib>
#include <string>

using namespace halflit;
using namespace halflit::test;

namespace {

constexpr int kSide = 64;

std::string number(double x) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", x);
    return text;
}

/// A bent sheet of 8 x 8 squares with a camera and a light in front of it. positions: unit of the mesh's positions. scale: of its node.
/// offset: of everything, along x, in units of the scene's size.
Bytes sheet(double positions, double scale, double offset) {
    constexpr int kSquares = 8;
    Bytes bin;
    for (int j = 0; j <= kSquares; ++j)
        for (int i = 0; i <= kSquares; ++i) {
            const double x = i / 4.0 - 1, y = j / 4.0 - 1;
            append<float>(
                bin, {static_cast<float>(x * positions), static_cast<float>(y * positions), static_cast<float>(0.25 * x * y * positions)});
        }
    const std::size_t vertex_bytes = bin.size();
    for (std::uint16_t j = 0; j < kSquares; ++j)
        for (std::uint16_t i = 0; i < kSquares; ++i) {
            const auto a = static_cast<std::uint16_t>(j * (kSquares + 1) + i), b = static_cast<std::uint16_t>(a + 1),
                       c = static_cast<std::uint16_t>(a + kSquares + 1), d = static_cast<std::uint16_t>(c + 1);
            append<std::uint16_t>(bin, {a, b, d, a, d, c});
        }
    const double unit = positions * scale;
    const std::string at = number(offset * unit);
    const auto place = [&](double x, double y, double z) {
        return "\"translation\":[" + number((offset + x) * unit) + "," + number(y * unit) + "," + number(z * unit) + "]";
    };
    return glb(std::string("{") + kAsset + R"(,"scene":0,"scenes":[{"nodes":[0,1,2]}],"nodes":[{"mesh":0,"translation":[)" + at +
                   ",0,0],\"scale\":[" + number(scale) + "," + number(scale) + "," + number(scale) + "]},{\"camera\":0," +
                   place(0.25, 0, 4) + R"(},{"extensions":{"KHR_lights_punctual":{"light":0}},)" + place(1, 1, 1.5) +
                   R"(}],"cameras":[{"type":"perspective","perspective":{"yfov":0.6,"znear":)" + number(0.5 * unit) + ",\"zfar\":" +
                   number(50 * unit) + R"(}}],"extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[)" +
                   R"({"type":"point","intensity":)" + number(6 * unit * unit) + ",\"range\":" + number(6 * unit) +
                   R"(}]}},"buffers":[{"byteLength":)" + std::to_string(bin.size()) + R"(}],"bufferViews":[{"buffer":0,"byteLength":)" +
                   std::to_string(vertex_bytes) + R"(},{"buffer":0,"byteOffset":)" + std::to_string(vertex_bytes) +
                   ",\"byteLength\":" + std::to_string(bin.size() - vertex_bytes) +
                   R"(}],"accessors":[{"bufferView":0,"componentType":5126,"count":81,"type":"VEC3"},)" +
                   R"({"bufferView":1,"componentType":5123,"count":384,"type":"SCALAR"}],)" +
                   R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}]})",
               bin);
}

struct Drawn {
    std::vector<std::uint8_t> pixels = std::vector<std::uint8_t>(4 * kSide * kSide);
    RenderReport report;
};

Drawn draw(const Scene& scene) {
    Drawn drawn;
    REQUIRE(scene.cameras.size() == 1);
    REQUIRE(scene.lights.size() == 1);
    const auto report = render(scene, scene.cameras[0], {}, {.width = kSide, .height = kSide, .pixels = drawn.pixels.data()});
    REQUIRE(report);
    drawn.report = *report;
    return drawn;
}

int largest_difference(const Drawn& a, const Drawn& b) {
    int largest = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) largest = std::max(largest, std::abs(a.pixels[i] - b.pixels[i]));
    return largest;
}

}  // namespace

TEST_CASE("world: a scene of any size and place has the picture that it has at the origin", "[io]") {
    const LoadedScene usual = load_ok(sheet(1, 1, 0));
    CHECK(usual.placement.scale == 1.0);
    CHECK(usual.warnings.empty());
    const Drawn expected = draw(usual.scene);
    CHECK(expected.report.pixels_visible > kSide * kSide / 4);
    struct Case {
        double positions, scale, offset;
    };
    for (const Case& c : {Case{1, 1, 1e5},
                          {1, 1, -1e7},
                          {1, 1, 1e12},
                          {1e10, 1, 0},
                          {1e-4, 1, 0},
                          {1e-6, 1, 0},
                          {1e-10, 1, 0},
                          {1, 1e-10, 1e5},
                          {0x1p-120, 0x1p120, 3e4},
                          {0x1p100, 0x1p-100, 0},
                          {1e12, 1, 1e6}}) {
        INFO("positions " << c.positions << ", node's scale " << c.scale << ", offset " << c.offset);
        const LoadedScene loaded = load_ok(sheet(c.positions, c.scale, c.offset));
        const Drawn found = draw(loaded.scene);
        CHECK(found.report.nan_pixels == 0);
        CHECK(found.report.triangles_drawn == expected.report.triangles_drawn);
        CHECK(largest_difference(found, expected) <= 1);
        // (p - origin) * scale, of the camera's place.
        const double unit = c.positions * c.scale, there = ((c.offset + 0.25) * unit - loaded.placement.origin.x) * loaded.placement.scale;
        CHECK(static_cast<double>(loaded.scene.cameras[0].world_from_camera.c[3].x) ==
              Approx(there).margin(1e-6 * unit * loaded.placement.scale));
    }
}

TEST_CASE("world: the smallest and the largest positions that float32 holds are drawn", "[io]") {
    for (const double positions : {1e-38, 1e-42, 3e37}) {
        INFO(positions);
        LoadedScene loaded = load_ok(sheet(positions, 1, 0));
        loaded.scene.lights.clear();
        loaded.scene.calibrated = true;
        const AutoSetup setup = auto_setup(loaded.scene, kSide, kSide, {.frame = true});
        std::vector<std::uint8_t> pixels(4 * kSide * kSide);
        const auto report =
            render(loaded.scene, setup.light, setup.camera, setup.settings, {.width = kSide, .height = kSide, .pixels = pixels.data()});
        REQUIRE(report);
        CHECK(report->nan_pixels == 0);
        CHECK(report->pixels_visible > kSide * kSide / 4);
    }
}

TEST_CASE("world: a stray vertex near float32's end does not shrink a scene to nothing", "[io]") {
    for (const float far : {1e30f, 2.66e33f, -6e35f, 3e38f})
        for (const std::size_t vertex : {std::size_t{0}, std::size_t{40}}) {
            INFO(far << ", vertex " << vertex);
            Bytes file = sheet(1, 1, 0);
            const std::size_t bin = 20 + u32_of(file, 12) + 8;
            put(file, bin + 12 * vertex, far);
            LoadedScene loaded = load_ok(file);
            CHECK(loaded.placement.scale == 1.0);
            REQUIRE(loaded.warnings.size() == 1);
            INFO(loaded.warnings[0]);
            CHECK(loaded.warnings[0].find("vertices lie more than 1e12") != std::string::npos);
            const AutoSetup setup = auto_setup(loaded.scene, kSide, kSide, {.frame = true});
            std::vector<std::uint8_t> pixels(4 * kSide * kSide);
            const auto report =
                render(loaded.scene, setup.light, setup.camera, setup.settings, {.width = kSide, .height = kSide, .pixels = pixels.data()});
            REQUIRE(report);
            CHECK(report->nan_pixels == 0);
            CHECK(report->triangles_drawn > 100);
            CHECK(report->pixels_visible > kSide * kSide / 4);
        }
}

TEST_CASE("world: without the option a scene stays where the file has it", "[io]") {
    LoadOptions options;
    options.recentre = false;
    const LoadedScene loaded = load_ok(sheet(1, 1, 1e7), options);
    CHECK(loaded.placement.scale == 1.0);
    CHECK(loaded.scene.instances[0].world_from_object.c[3].x == 1e7f);
}
