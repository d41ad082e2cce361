// Lines of edges: the same bytes however they are computed, every kind of target, and scenes that no one draws on purpose.
#include "halflit/shapes.hpp"
#include "sh/mat4.hpp"
#include "tests/raster/edge_reference.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/isas.hpp"
#include "tests/support/random.hpp"

#include <chrono>
#include <cstring>
#include <limits>

using namespace halflit;
using namespace halflit::raster::test;
using halflit::test::Random;

namespace {

constexpr int kWidth = 150, kHeight = 110;

/// Boxes and a torus that hide each other, lit.
Scene some_scene() {
    Scene scene;
    scene.meshes = {make_box({1, 0.4f, 0.7f}), make_torus(1, 0.3f, 24, 12), make_sphere(0.6f, 16, 8)};
    scene.instances = {{0, translation({0, -0.5f, 0})}, {1, translation({0.2f, 0.4f, 0.3f})}, {2, translation({-0.7f, 0.3f, 0.8f})}};
    scene.lights.push_back({});
    scene.ambient = {{0.3f, 0.3f, 0.3f}, {0.1f, 0.1f, 0.1f}};
    return scene;
}

Settings with_lines(double width = 1.5) {
    Settings settings;
    settings.edges = EdgeChoice::feature;
    settings.hidden_edges = HiddenEdges::dashed;
    settings.edge_width = static_cast<float>(width);
    settings.edge_color_linear = {0.8f, 0.1f, 0.05f};
    return settings;
}

struct Drawn {
    std::vector<std::uint8_t> codes = std::vector<std::uint8_t>(std::size_t{4} * kWidth * kHeight, 7);
    std::vector<float> linear = std::vector<float>(std::size_t{4} * kWidth * kHeight, -1.0f);
    friend bool operator==(const Drawn&, const Drawn&) = default;
};

Drawn drawn(const Scene& scene, const Settings& settings, const Execution& execution = {}, Target target = {}) {
    Drawn out;
    target.width = kWidth, target.height = kHeight;
    target.pixels = out.codes.data(), target.linear = out.linear.data();
    const Camera camera = frame_scene(scene, 1.0f * kWidth / kHeight, {});
    const auto report = render(scene, camera, settings, target, execution);
    INFO((report ? "" : report.error().message));
    REQUIRE(report);
    return out;
}

}  // namespace

TEST_CASE("edges: black lines are light on dark materials and black on others, and a colour that is asked for stays", "[edges]") {
    const auto line_codes = [](float albedo, Vec3f color, bool contrast) {
        Scene scene;
        scene.materials.resize(1);
        scene.materials[0].unlit = true;
        scene.materials[0].base_color = {albedo, albedo, albedo, 1};
        scene.meshes = {make_box({1, 1, 1})};
        scene.meshes[0].material = 0;
        scene.instances = {{0, {}}};
        Settings settings;
        settings.background_linear = {0.5f, 0.5f, 0.5f, 1};
        const Drawn plain = drawn(scene, settings);
        settings.edges = EdgeChoice::feature, settings.edge_width = 3;
        settings.edge_color_linear = color, settings.edge_contrast = contrast;
        const Drawn lined = drawn(scene, settings);
        // The middle of a line shows it alone; of those pixels, the ones before the box.
        std::vector<int> codes;
        const std::size_t middle = std::size_t{4} * (kHeight / 2 * kWidth + kWidth / 2);
        for (std::size_t i = 0; i < lined.codes.size(); i += 4)
            if (lined.codes[i] != plain.codes[i] && plain.codes[i] == plain.codes[middle]) codes.push_back(lined.codes[i]);
        std::sort(codes.begin(), codes.end());
        REQUIRE(codes.size() > 100);
        return std::pair{codes.front(), codes.back()};
    };
    for (const float albedo : {0.0f, 0.01f, 0.05f, 0.19f}) CHECK(line_codes(albedo, {}, true).second >= 200);
    for (const float albedo : {0.21f, 0.5f, 1.0f}) CHECK(line_codes(albedo, {}, true) == line_codes(albedo, {}, false));
    CHECK(line_codes(0.3f, {}, true).first == 0);
    CHECK(line_codes(0.01f, {}, false).first == 0);
    CHECK(line_codes(0.01f, {0, 0, 0.5f}, true) == line_codes(0.01f, {0, 0, 0.5f}, false));
}

TEST_CASE("edges: instruction sets, threads and tile sizes give the same bytes", "[edges]") {
    const Scene scene = some_scene();
    for (const int samples : {1, 4}) {
        Settings settings = with_lines();
        settings.samples = samples;
        Execution execution;
        execution.isa = Isa::scalar, execution.threads = 1;
        const Drawn expected = drawn(scene, settings, execution);
        for (const Isa isa : halflit::test::available_isas())
            for (const int threads : {1, 2, 3, 4}) {
                execution.isa = isa, execution.threads = threads;
                execution.tile_size = threads == 2 ? 16 : threads == 3 ? 32 : 64;
                CAPTURE(static_cast<int>(isa), threads);
                CHECK((drawn(scene, settings, execution) == expected));
            }
    }
}

TEST_CASE("edges: a region has the whole picture's pixels, and what is outside stays", "[edges]") {
    const Scene scene = some_scene();
    Random random(5);
    for (const double width : {0.25, 1.5, 9.0, 64.0}) {
        Settings settings = with_lines(width);
        const Drawn whole = drawn(scene, settings);
        for (int trial = 0; trial < 30; ++trial) {
            Region& r = settings.region;
            r.x = random.index(kWidth), r.y = random.index(kHeight);
            r.width = 1 + random.index(kWidth - r.x), r.height = 1 + random.index(kHeight - r.y);
            if (trial % 3 == 0) r.width = std::min(r.width, 3), r.height = std::min(r.height, 2);
            const Drawn part = drawn(scene, settings);
            int wrong = 0;
            for (int y = 0; y < kHeight; ++y)
                for (int x = 0; x < kWidth; ++x) {
                    const std::size_t at = 4 * (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x));
                    const bool inside = x >= r.x && x < r.x + r.width && y >= r.y && y < r.y + r.height;
                    for (std::size_t c = at; c < at + 4; ++c)
                        wrong += inside ? part.codes[c] != whole.codes[c] || part.linear[c] != whole.linear[c]
                                        : part.codes[c] != 7 || part.linear[c] != -1.0f;
                }
            CAPTURE(width, r.x, r.y, r.width, r.height);
            CHECK(wrong == 0);
        }
    }
}

TEST_CASE("edges: the order of bytes, alpha and linear light are those of the target", "[edges]") {
    const Scene scene = some_scene();
    const Drawn straight = drawn(scene, with_lines());
    Target target;
    target.format = PixelFormat::bgra8;
    const Drawn swapped = drawn(scene, with_lines(), {}, target);
    target.format = PixelFormat::rgba8, target.premultiplied = true;
    const Drawn times_alpha = drawn(scene, with_lines(), {}, target);
    Settings none = with_lines();
    none.edges = EdgeChoice::none;
    const Drawn bare = drawn(scene, none);
    int painted = 0, on_background = 0;
    for (std::size_t at = 0; at < straight.codes.size(); at += 4) {
        for (std::size_t c = 0; c < 3; ++c) {
            const int alpha = straight.codes[at + 3], code = straight.codes[at + c];
            REQUIRE(int{swapped.codes[at + 2 - c]} == code);
            // One rounding to codes each: two codes apart at most.
            REQUIRE(std::abs(int{times_alpha.codes[at + c]} - (code * alpha + 127) / 255) <= 2);
            REQUIRE(std::abs(times_alpha.linear[at + c] - straight.linear[at + c] * straight.linear[at + 3]) < 1e-6f);
        }
        REQUIRE(swapped.codes[at + 3] == straight.codes[at + 3]);
        REQUIRE(times_alpha.codes[at + 3] == straight.codes[at + 3]);
        // A line over a share s of a pixel of alpha a: alpha a + s (1 - a), colour (s line + (1 - s) a colour) / alpha.
        const float a = bare.linear[at + 3], after = straight.linear[at + 3], color[3] = {0.8f, 0.1f, 0.05f};
        if (std::memcmp(&bare.linear[at], &straight.linear[at], 16) == 0) continue;
        ++painted;
        if (a != 0.0f) continue;
        ++on_background;
        REQUIRE(std::abs(int{straight.codes[at + 3]} - 255.0f * after) <= 0.51f);
        for (std::size_t c = 0; c < 3; ++c) REQUIRE(std::abs(straight.linear[at + c] - color[c]) < 1e-6f);
    }
    CHECK(painted > 1000);
    CHECK(on_background > 50);
}

TEST_CASE("edges: the number of samples does not change the lines", "[edges]") {
    const Scene scene = some_scene();
    const Camera camera = frame_scene(scene, 1.0f * kWidth / kHeight, {});
    Settings settings = with_lines();
    const Cover one = cover_of(scene, camera, settings, kWidth, kHeight);
    for (const int samples : {4, 8, 16}) {
        settings.samples = samples;
        const Cover more = cover_of(scene, camera, settings, kWidth, kHeight);
        float worst = 0;
        for (std::size_t at = 0; at < one.rgba.size(); at += 4) worst = std::max(worst, std::abs(one.rgba[at] - more.rgba[at]));
        CHECK(worst == 0.0f);
    }
}

TEST_CASE("edges: tiles are told after their lines are drawn", "[edges]") {
    const Scene scene = some_scene();
    const Drawn expected = drawn(scene, with_lines());
    Drawn out;
    Target target{kWidth, kHeight, out.codes.data(), out.linear.data()};
    int wrong = 0, pixels = 0;
    Execution execution;
    execution.threads = 1, execution.tile_size = 32;
    execution.on_tile = [&](const Region& r) {
        pixels += r.width * r.height;
        for (int y = r.y; y < r.y + r.height; ++y) {
            const std::size_t at = 4 * (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(r.x));
            wrong += std::memcmp(&out.codes[at], &expected.codes[at], 4 * static_cast<std::size_t>(r.width)) != 0 ? 1 : 0;
        }
    };
    REQUIRE(render(scene, frame_scene(scene, 1.0f * kWidth / kHeight, {}), with_lines(), target, execution));
    CHECK(pixels == kWidth * kHeight);
    CHECK(wrong == 0);
}

TEST_CASE("edges: a renderer whose search was cancelled or ran out of memory draws the next frame right", "[edges]") {
    const Scene scene = some_scene();
    Scene large;
    large.meshes = {make_sphere_of(1, 300000)};
    large.instances = {{0, {}}};
    const auto first = PreparedScene::make(scene), second = PreparedScene::make(large);
    REQUIRE(first);
    REQUIRE(second);
    const Camera camera = frame_scene(scene, 1.0f * kWidth / kHeight, {});
    const Drawn expected = drawn(scene, with_lines());
    Renderer renderer;
    Drawn out;
    const Target target{kWidth, kHeight, out.codes.data(), out.linear.data()};
    REQUIRE(renderer.render(*first, camera, with_lines(), target));
    CHECK((out == expected));
    for (const bool memory : {false, true})
        for (int part = 1; part <= 20; ++part) {
            Execution execution;
            if (memory)
                execution.memory_limit = static_cast<std::size_t>(part) << 22;
            else
                execution.time_limit_s = 0.004 * part;
            const auto report = renderer.render(*second, camera, with_lines(), target, execution);
            if (!report) CHECK(report.error().code == ErrorCode::limit);
            REQUIRE(renderer.render(*first, camera, with_lines(), target));
            CHECK((out == expected));
        }
    Execution little;
    little.memory_limit = 40 << 20;  // 300,000 triangles' edges take more
    const auto report = Renderer().render(*second, camera, with_lines(), target, little);
    REQUIRE(!report);
    CHECK(report.error().code == ErrorCode::limit);
}

TEST_CASE("edges: odd scenes are drawn without a fault and in time", "[edges]") {
    constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();
    Random random(9);
    for (int trial = 0; trial < 300; ++trial) {
        Scene scene;
        scene.materials.resize(4);
        scene.materials[1].double_sided = true;
        scene.materials[2].alpha_mode = AlphaMode::blend, scene.materials[2].base_color.w = 0.5f;
        scene.materials[3].shadow_catcher = true;
        for (int m = random.index(4); m >= 0; --m) {
            Mesh mesh;
            mesh.topology = random.chance(0.7) ? Topology::triangles : random.chance(0.5) ? Topology::lines : Topology::points;
            for (int v = 3 + random.index(20); v > 0; --v) {
                const auto one = [&] {
                    if (!random.chance(0.1)) return random.real32(-1, 1);
                    const float odd[] = {kInf, kNan, 1e38f, -3e38f, 1e-40f, 0.0f, -0.0f, 1e20f};
                    return odd[random.index(8)];
                };
                mesh.positions.push_back({one(), one(), one()});
            }
            for (int i = 6 * random.index(20); i > 0; --i)
                mesh.indices.push_back(static_cast<std::uint32_t>(random.index(static_cast<int>(mesh.positions.size()))));
            mesh.material = random.index(5) - 1;
            scene.meshes.push_back(std::move(mesh));
        }
        for (int i = random.index(5); i > 0; --i) {
            Mat4 place = translation({random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1)});
            if (random.chance(0.3)) place.c[0].x = -1;
            if (random.chance(0.1)) place.c[1].y = 0;
            if (random.chance(0.1)) place.c[2].z = 1e30f;
            scene.instances.push_back({random.index(static_cast<int>(scene.meshes.size())), place});
            scene.instances.back().visible = random.chance(0.9);
        }
        Settings settings = with_lines(random.chance(0.3) ? 64 : 1);
        settings.edges = random.chance(0.5) ? EdgeChoice::all : EdgeChoice::silhouette;
        settings.edge_angle_deg = random.real32(0, 180);
        settings.samples = random.chance(0.5) ? 4 : 1;
        Camera camera =
            halflit::test::camera_at({random.real32(-1, 1), random.real32(-1, 1), random.real32(-2, 2)}, {0, 0, 0}, 1.0f, 0.01f);
        camera.orthographic = random.chance(0.3);
        camera.near_z = random.chance(0.2) ? 1e-30f : 0.01f;
        camera.far_z = random.chance(0.3) ? 2.0f : camera.orthographic ? 10.0f : 0.0f;
        Drawn out;
        const auto report = render(scene, camera, settings, {kWidth, kHeight, out.codes.data(), out.linear.data()});
        INFO((report ? "" : report.error().message));
        CHECK((report || report.error().code != ErrorCode::internal));
        int nan = 0;
        for (const float v : out.linear) nan += v != v ? 1 : 0;
        CHECK(nan == 0);
    }
}

TEST_CASE("edges: a hundred thousand triangles along one edge, or at one place, take no quadratic time", "[edges]") {
    for (const bool along_edge : {true, false}) {
        Mesh fan;
        fan.positions = {{0, -1, 0}, {0, 1, 0}};
        Random random(3);
        for (std::uint32_t i = 0; i < 100000; ++i) {
            fan.positions.push_back({random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1)});
            if (along_edge)
                for (const std::uint32_t v : {0u, 1u, i + 2}) fan.indices.push_back(v);
            else
                for (const std::uint32_t v : {0u, i + 2, i > 0 ? i + 1 : 1u}) fan.indices.push_back(v);
        }
        Scene scene;
        scene.meshes = {fan};
        scene.instances = {{0, {}}};
        const auto begin = std::chrono::steady_clock::now();
        drawn(scene, with_lines());
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
        constexpr double kMostSeconds = 90;
#else
        constexpr double kMostSeconds = 15;
#endif
        // 0.7 s on one core; 10^10 steps take minutes
        CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() < kMostSeconds);
    }
}
