// Limits on the time and the working memory of a call.
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "raster/passes/view_geometry.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <chrono>
#include <cmath>

using namespace halflit;
using halflit::test::Random;

namespace {

using Bytes = std::vector<std::uint8_t>;

/// Long thin triangles through the middle of the picture, in one mesh: each touches most tiles of a row, a column or a diagonal.
Scene spokes(int count) {
    Random random(7);
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].double_sided = true;
    scene.materials[0].unlit = true;
    Mesh mesh;
    mesh.material = 0;
    for (int i = 0; i < count; ++i) {
        const float angle = random.real32(0, 6.2831853), z = random.real32(-0.5, 0.5);
        const auto at = [&](float a) { return Vec3f{std::cos(a), std::sin(a), z}; };
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const Vec3f color{random.real32(0, 1), random.real32(0, 1), random.real32(0, 1)};
        for (const float a : {angle, angle + 0.01f, angle + 3.1415927f}) {
            mesh.positions.push_back(at(a));
            mesh.colors.push_back({color.x, color.y, color.z, 1});
        }
        for (std::uint32_t k = 0; k < 3; ++k) mesh.indices.push_back(first + k);
    }
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({0, {}});
    return scene;
}

Camera front() {
    Camera camera = halflit::test::camera_at({0, 0, 2}, {0, 0, 0});
    camera.orthographic = true;
    camera.half_height = 1;
    return camera;
}

Result<RenderReport> draw(Renderer& renderer, const Scene& scene, Bytes& pixels, int side, const Execution& execution) {
    pixels.assign(std::size_t{4} * static_cast<std::size_t>(side * side), 0);
    return renderer.render(scene, front(), {}, {.width = side, .height = side, .pixels = pixels.data()}, execution);
}

double seconds_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

TEST_CASE("limits: a frame beyond its time says so, and the next one is drawn", "[raster][execution]") {
    // 20,000 layers on all tiles: some seconds of work.
    Scene scene = spokes(40);
    Mesh& mesh = scene.meshes[0];
    mesh.positions = {{-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}};
    mesh.colors.clear();
    mesh.indices.clear();
    for (int i = 0; i < 20000; ++i) mesh.indices.insert(mesh.indices.end(), {0, 1, 2});
    scene.materials[0].alpha_mode = AlphaMode::blend;
    scene.materials[0].base_color.w = 0.5f;
    Renderer renderer;
    Bytes pixels;
    for (const int threads : {1, 3}) {
        Result<RenderReport> stopped;
        const double took = seconds_of([&] { stopped = draw(renderer, scene, pixels, 512, {.threads = threads, .time_limit_s = 0.05}); });
        REQUIRE(!stopped);
        CHECK(stopped.error().code == ErrorCode::limit);
        CHECK(stopped.error().message.find("time") != std::string::npos);
        CHECK(took < 60.0);  // the work would take minutes under a sanitizer; a part of it takes milliseconds
        const Scene small = spokes(10);
        REQUIRE(draw(renderer, small, pixels, 64, {.threads = threads, .time_limit_s = 1e6}));
        Bytes fresh;
        Renderer other;
        REQUIRE(draw(other, small, fresh, 64, {}));
        CHECK(pixels == fresh);
    }
}

TEST_CASE("limits: a scene's preparation stops too", "[raster][execution]") {
    const Scene scene = spokes(50000);
    const auto prepared = PreparedScene::make(scene, {.time_limit_s = 1e-9});
    REQUIRE(!prepared);
    CHECK(prepared.error().code == ErrorCode::limit);
}

TEST_CASE("limits: a frame beyond its memory says so, and the same renderer draws it within more", "[raster][execution]") {
    const Scene scene = spokes(20000);
    Renderer renderer;
    Bytes pixels, expected;
    Renderer other;
    REQUIRE(draw(other, scene, expected, 200, {}));
    for (const std::size_t limit : {std::size_t{1}, std::size_t{100'000}, std::size_t{1'000'000}}) {
        const auto stopped = draw(renderer, scene, pixels, 200, {.memory_limit = limit});
        REQUIRE(!stopped);
        CHECK(stopped.error().code == ErrorCode::limit);
        CHECK(stopped.error().message.find(std::to_string(limit)) != std::string::npos);
    }
    // Memory kept from a larger frame does not count against a small one.
    const Scene small = spokes(10);
    REQUIRE(draw(renderer, spokes(100000), pixels, 200, {}));
    REQUIRE(draw(renderer, small, pixels, 200, {.memory_limit = 70'000'000}));
    for (int frame = 0; frame < 3; ++frame) {
        REQUIRE(draw(renderer, scene, pixels, 200, {.memory_limit = 100'000'000}));
        CHECK(pixels == expected);
    }
}

TEST_CASE("limits: triangles that touch hundreds of tiles each are drawn without lists of them, to the same pixels", "[raster]") {
    const Scene scene = spokes(6000);
    Bytes expected;
    for (const int tile : {64, 32, 16}) {  // 36, 144 and 576 tiles: the first keep their lists
        Renderer renderer;
        Bytes pixels;
        REQUIRE(draw(renderer, scene, pixels, 384, {.tile_size = tile}));
        if (expected.empty()) expected = pixels;
        CHECK(pixels == expected);
    }
    // 12 bytes for each entry: a spoke touches some 500 of the 128 x 128 tiles.
    const Scene many = spokes(15000);
    Renderer renderer;
    Bytes pixels;
    REQUIRE(draw(renderer, many, pixels, 2048, {.tile_size = 16, .memory_limit = 64'000'000}));
}

TEST_CASE("limits: copies of an opaque triangle are drawn once, and those that blend or have another material are not left out",
          "[raster]") {
    constexpr int kWidth = 64, kHeight = 48, kCopies = 20'000;
    const auto scene_of = [](int copies, AlphaMode mode, bool own_corners, float second_red) {
        Scene scene;
        Material material;
        material.alpha_mode = mode;
        material.base_color = {0.5f, 0.25f, 0.125f, mode == AlphaMode::blend ? 0.25f : 1.0f};
        scene.materials = {material, material};
        scene.materials[1].base_color.x = second_red;
        Mesh mesh;
        mesh.material = 0;
        for (int i = 0; i < copies; ++i) {
            const auto first = static_cast<std::uint32_t>(own_corners ? 3 * i : 0);
            if (own_corners || i == 0) mesh.positions.insert(mesh.positions.end(), {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}});
            mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2});
        }
        mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
        scene.meshes = {mesh, mesh};
        scene.meshes[1].material = 1;
        scene.instances = {{0, {}}, {1, {}}};
        Light light;
        light.direction_ws = {0, 0, -1};
        scene.lights = {light};
        return scene;
    };
    Camera camera;
    camera.world_from_camera.c[3] = {0, 0, 3, 1};
    const auto draw = [&](const Scene& scene, std::vector<std::uint32_t>& codes) {
        codes.resize(kWidth * kHeight);
        const auto report =
            render(scene, camera, {}, {.width = kWidth, .height = kHeight, .pixels = reinterpret_cast<std::uint8_t*>(codes.data())});
        REQUIRE(report);
        return report->triangles_drawn;
    };
    std::vector<std::uint32_t> one, many;
    for (const bool own_corners : {false, true}) {
        (void)draw(scene_of(1, AlphaMode::opaque, own_corners, 0.9f), one);
        CHECK(draw(scene_of(kCopies, AlphaMode::opaque, own_corners, 0.9f), many) < 100);  // one of each chunk
        CHECK(one == many);
    }
    // Two layers of a quarter each are not one.
    (void)draw(scene_of(1, AlphaMode::blend, false, 0.5f), one);
    CHECK(draw(scene_of(2, AlphaMode::blend, false, 0.5f), many) == 4);
    CHECK(one != many);
    // The second material hides the first.
    (void)draw(scene_of(1, AlphaMode::opaque, false, 0.9f), one);
    (void)draw(scene_of(1, AlphaMode::opaque, false, 0.1f), many);
    CHECK(one != many);
}

TEST_CASE("limits: a picture of more transparent surfaces than its pixels may have is refused, whatever threads and tiles",
          "[raster][blend]") {
    // Panes over the whole picture, and one over its left half.
    constexpr int kPanes = 9, kSide = 512;
    Scene scene;
    Material pane;
    pane.alpha_mode = AlphaMode::blend;
    pane.base_color = {1, 0.5f, 0.25f, 0.1f};
    scene.materials = {pane};
    Mesh mesh;
    mesh.material = 0;
    const auto add = [&](float right, float z) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Vec3f p : {Vec3f{-1, -1, z}, {right, -1, z}, {right, 1, z}, {-1, 1, z}}) mesh.positions.push_back(p);
        for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + k);
    };
    for (int i = 0; i < kPanes; ++i) add(1, 0.05f * static_cast<float>(i));
    add(0, 0.9f);
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({0, {}});
    Bytes expected[2];
    for (const int threads : {1, 3})
        for (const int tile : {64, 32})
            for (const int limit : {kPanes, kPanes + 1, 0}) {
                Settings settings;
                settings.max_layers = limit;
                settings.samples = tile == 64 ? 4 : 1;  // a pixel between two triangles of a pane has it once
                Bytes pixels(std::size_t{4} * kSide * kSide);
                Renderer renderer;
                const auto report = renderer.render(scene, front(), settings, {.width = kSide, .height = kSide, .pixels = pixels.data()},
                                                    {.threads = threads, .tile_size = tile});
                INFO(threads << " threads, tiles of " << tile << ", at most " << limit);
                REQUIRE(report.has_value() == (limit != kPanes));
                if (!report) {
                    CHECK(report.error().code == ErrorCode::limit);
                    CHECK(report.error().message.find("transparent surfaces") != std::string::npos);
                    continue;
                }
                if (expected[settings.samples == 4].empty()) expected[settings.samples == 4] = pixels;
                CHECK(pixels == expected[settings.samples == 4]);
            }
}
