// Settings that a frame refuses, their error codes, and the ways to stop a frame.
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "raster/settings_table.hpp"
#include "tests/support/cameras.hpp"

#include "tests/support/catch.hpp"

#include <atomic>
#include <cmath>
#include <limits>

using namespace halflit;
using namespace halflit::raster;
using halflit::test::camera_at;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr int kMost = std::numeric_limits<int>::max();

Scene box_scene() {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes.push_back(make_box({1, 1, 1}));
    scene.meshes[0].material = 0;
    scene.instances.push_back({0, {}});
    return scene;
}

const Camera kCamera = camera_at({2, 3, 4}, {0, 0, 0});

struct Outcome {
    bool ok;
    ErrorCode code;
    std::string message;
    bool untouched;  ///< no pixel was written
};

Outcome outcome(const Scene& scene, const Settings& settings, int width = 40, int height = 30, const Execution& execution = {},
                const Camera& camera = kCamera) {
    std::vector<std::uint8_t> pixels(4 * 40 * 30, 0xCD);
    const auto report = render(scene, camera, settings, {width, height, pixels.data(), nullptr}, execution);
    Outcome o{report.has_value(), {}, {}, true};
    if (!report) o.code = report.error().code, o.message = report.error().message;
    for (const std::uint8_t p : pixels) o.untouched &= p == 0xCD;
    return o;
}

bool refused(const Outcome& o, ErrorCode code) {
    return !o.ok && o.code == code && o.untouched && !o.message.empty() && o.message.find('\n') == std::string::npos;
}

}  // namespace

TEST_CASE("settings: sizes below 1 are usage errors, sizes beyond the guard band exceed a limit", "[raster][settings]") {
    for (const int side : {0, -1, -kMost}) {
        CHECK(refused(outcome(box_scene(), {}, side, 30), ErrorCode::usage));
        CHECK(refused(outcome(box_scene(), {}, 40, side), ErrorCode::usage));
    }
    for (const int side : {32769, 65535, kMost}) {
        CHECK(refused(outcome(box_scene(), {}, side, 30), ErrorCode::limit));
        CHECK(refused(outcome(box_scene(), {}, 40, side), ErrorCode::limit));
    }
    CHECK(outcome(box_scene(), {}, 1, 1).ok);
    CHECK(outcome(box_scene(), {}, 40 * 30, 1).ok);
}

TEST_CASE("settings: samples, tile size, exposure and region are checked", "[raster][settings]") {
    for (const int samples : {0, -1, 2, 3, 5, 12, 32, kMost}) {
        Settings s;
        s.samples = samples;
        CHECK(refused(outcome(box_scene(), s), ErrorCode::usage));
    }
    for (const int tile : {0, -16, 8, 24, 63, 128}) {
        CHECK(refused(outcome(box_scene(), {}, 40, 30, {.tile_size = tile}), ErrorCode::usage));
    }
    for (const float exposure : {0.0f, -1.0f, kNan, kInf}) {
        Settings s;
        s.exposure = exposure;
        CHECK(refused(outcome(box_scene(), s), ErrorCode::usage));
    }
    for (const Region r :
         {Region{-1, 0, 5, 5}, Region{0, -1, 5, 5}, Region{0, 0, 41, 5}, Region{0, 0, 5, 31}, Region{40, 0, 1, 1}, Region{0, 0, 5, 0},
          Region{0, 0, -5, 5}, Region{0, 0, 5, -5}, Region{1, 1, kMost, kMost}, Region{kMost, 0, 1, 1}, Region{-kMost, 0, kMost, 1}}) {
        Settings s;
        s.region = r;
        INFO(r.x << "," << r.y << "," << r.width << "," << r.height);
        CHECK(refused(outcome(box_scene(), s), ErrorCode::usage));
    }
    Settings s;
    s.region = {39, 29, 1, 1};
    CHECK(outcome(box_scene(), s).ok);
}

TEST_CASE("settings: an instruction set that this CPU does not run is a usage error", "[raster][settings]") {
    for (const Isa isa : {Isa::scalar, Isa::sse2, Isa::sse41, Isa::avx2, Isa::avx512, Isa::neon64, Isa::wasm128}) {
        const Outcome o = outcome(box_scene(), {}, 40, 30, {.isa = isa});
        INFO(isa_name(isa));
        if (isa_available(isa))
            CHECK(o.ok);
        else
            CHECK(refused(o, ErrorCode::usage));
    }
    const auto unknown = isa_by_name("nonsense");
    REQUIRE_FALSE(unknown);
    CHECK(unknown.error().code == ErrorCode::usage);
    CHECK(unknown.error().message.find("nonsense") != std::string::npos);
}

TEST_CASE("settings: any number of threads is accepted", "[raster][settings]") {
    for (const int threads : {-5, 0, 1, 64, 100'000, kMost}) {
        INFO(threads);
        CHECK(outcome(box_scene(), {}, 40, 30, {.threads = threads}).ok);
    }
}

TEST_CASE("scene: an index out of range is bad input", "[raster][settings]") {
    const auto changed = [](auto change) {
        Scene scene = box_scene();
        change(scene);
        return outcome(scene, {});
    };
    CHECK(refused(changed([](Scene& s) { s.meshes[0].indices[7] = 24; }), ErrorCode::bad_input));
    CHECK(refused(changed([](Scene& s) { s.meshes[0].indices[7] = 0xffffffffu; }), ErrorCode::bad_input));
    CHECK(refused(changed([](Scene& s) { s.meshes[0].indices.pop_back(); }), ErrorCode::bad_input));
    CHECK(refused(changed([](Scene& s) { s.meshes[0].positions.clear(); }), ErrorCode::bad_input));
    CHECK(refused(changed([](Scene& s) { s.meshes[0].normals.pop_back(); }), ErrorCode::bad_input));
    CHECK(refused(changed([](Scene& s) { s.meshes[0].uv0.pop_back(); }), ErrorCode::bad_input));
    CHECK(refused(changed([](Scene& s) { s.meshes[0].uv1.resize(3); }), ErrorCode::bad_input));
    CHECK(refused(changed([](Scene& s) { s.meshes[0].colors.resize(25); }), ErrorCode::bad_input));
    CHECK(refused(changed([](Scene& s) { s.meshes[0].tangents.resize(1); }), ErrorCode::bad_input));
    CHECK(refused(changed([](Scene& s) { s.meshes[0].material = 1; }), ErrorCode::bad_input));
    CHECK(refused(changed([](Scene& s) { s.instances[0].mesh = 1; }), ErrorCode::bad_input));
    CHECK(refused(changed([](Scene& s) { s.instances[0].mesh = -1; }), ErrorCode::bad_input));
    CHECK(refused(changed([](Scene& s) { s.materials[0].textures[TextureSlot::base_color].texture = 0; }), ErrorCode::bad_input));
    CHECK(refused(changed([](Scene& s) { s.materials[0].textures[TextureSlot::normal].texture = kMost; }), ErrorCode::bad_input));
    CHECK(changed([](Scene& s) { s.meshes[0].material = -1; }).ok);
    CHECK(changed([](Scene& s) { s.meshes[0].normals.clear(); }).ok);
    CHECK(changed([](Scene& s) { s.meshes.emplace_back(); }).ok);
}

TEST_CASE("scene: a camera that is not finite is bad input", "[raster][settings]") {
    Camera camera = kCamera;
    camera.world_from_camera.c[3].x = kNan;
    CHECK(refused(outcome(box_scene(), {}, 40, 30, {}, camera), ErrorCode::bad_input));
    camera = kCamera;
    camera.world_from_camera.c[0].y = kInf;
    CHECK(refused(outcome(box_scene(), {}, 40, 30, {}, camera), ErrorCode::bad_input));
    // Lens values that are not finite are replaced by neutral ones.
    camera = kCamera;
    camera.fov_y_rad = kNan;
    camera.near_z = -kInf;
    CHECK(outcome(box_scene(), {}, 40, 30, {}, camera).ok);
}

TEST_CASE("frame: a target without pixels is accepted", "[raster][settings]") {
    const auto report = render(box_scene(), kCamera, {}, {40, 30, nullptr, nullptr});
    REQUIRE(report);
    CHECK(report->pixels_visible > 50);
}

TEST_CASE("frame: stops when asked to, and draws again afterwards", "[raster][settings]") {
    Renderer renderer;
    const Scene scene = box_scene();
    std::vector<std::uint8_t> expected(4 * 200 * 200), pixels(4 * 200 * 200);
    REQUIRE(render(scene, kCamera, {}, {200, 200, expected.data(), nullptr}));
    for (const int threads : {1, 2}) {
        for (const int after : {0, 1, 5}) {
            std::atomic<int> asked{0};
            const Execution execution{.threads = threads, .tile_size = 16, .cancelled = [&] { return asked++ >= after; }};
            const auto stopped = renderer.render(scene, kCamera, {}, {200, 200, pixels.data(), nullptr}, execution);
            REQUIRE_FALSE(stopped);
            CHECK(stopped.error().code == ErrorCode::cancelled);
            CHECK(asked >= after);
            CHECK(asked <= after + 1 + threads);  // 169 tiles: each thread notices at its next one
        }
        const Execution execution{.threads = threads, .cancelled = [] { return false; }};
        REQUIRE(renderer.render(scene, kCamera, {}, {200, 200, pixels.data(), nullptr}, execution));
        CHECK(pixels == expected);
    }
}

TEST_CASE("settings: values that no name stands for are usage errors", "[raster][settings]") {
    const auto refused_with = [](auto change) {
        Settings s;
        change(s);
        return refused(outcome(box_scene(), s), ErrorCode::usage);
    };
    CHECK(refused_with([](Settings& s) { s.shading.rate = static_cast<ShadingRate>(9); }));
    CHECK(refused_with([](Settings& s) { s.shading.specular = static_cast<SpecularModel>(9); }));
    CHECK(refused_with([](Settings& s) { s.shading.accuracy = static_cast<Accuracy>(255); }));
    CHECK(refused_with([](Settings& s) { s.shading.texture_detail = static_cast<TextureDetail>(3); }));
    CHECK(refused_with([](Settings& s) { s.shadows = static_cast<ShadowMode>(3); }));
}

TEST_CASE("settings: the ends of each range, as a float has them, are in it", "[raster][settings]") {
    int rows = 0;
    for (const Setting& setting : kSettings) {
        if (setting.values.kind != SettingValues::Kind::number) continue;
        INFO(setting.name);
        const auto low = static_cast<float>(setting.values.low), high = static_cast<float>(setting.values.high);
        CHECK(setting.values.contains(double{high}));
        CHECK(setting.values.contains(double{low}) == (!setting.values.open || setting.values.zero_too));
        CHECK_FALSE(setting.values.contains(double{std::nextafter(low, -kInf)}));
        if (high < kInf) CHECK_FALSE(setting.values.contains(double{std::nextafter(high, kInf)}));
        CHECK_FALSE(setting.values.contains(double{kNan}));
        ++rows;
    }
    CHECK(rows > 5);
}
