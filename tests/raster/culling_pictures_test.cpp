// Culling must change no pixel and no count of drawn triangles. Each scene is drawn as it is, so that clusters may be left out, and again
// in a form in which none can be.
#include "halflit/renderer.hpp"
#include "raster/scene/prepared_mesh.hpp"
#include "tests/raster/random_geometry.hpp"
#include "tests/raster/test_scenes.hpp"
#include "tests/support/isas.hpp"
#include "tests/support/setup.hpp"

#include "tests/support/catch.hpp"

#include <limits>
#include <span>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// The same triangles in the same order, with a triangle whose corners are NaN before every 127 of them. It draws nothing but must be
/// counted, so that no cluster (128 triangles) can be left out.
Mesh without_culling(const Mesh& mesh) {
    Mesh out = mesh;
    out.indices.clear();
    const auto nowhere = static_cast<std::uint32_t>(mesh.positions.size());
    out.positions.push_back({kNan, kNan, kNan});
    const auto lengthen = [&](auto& attribute) {
        if (!attribute.empty()) attribute.push_back({});
    };
    lengthen(out.normals), lengthen(out.tangents), lengthen(out.uv0), lengthen(out.uv1), lengthen(out.colors);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        if (i / 3 % (kClusterTriangles - 1) == 0) out.indices.insert(out.indices.end(), 3, nowhere);
        out.indices.insert(out.indices.end(), {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
    }
    return out;
}

struct Picture {
    std::vector<std::uint8_t> rgba8;
    std::vector<float> linear;
    RenderReport report;
};

Picture draw(const Scene& scene, const Camera& camera, const halflit::test::Setup& settings, int width, int height) {
    const auto size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4;
    Picture p{std::vector<std::uint8_t>(size), std::vector<float>(size), {}};
    const auto report = render(scene, camera, settings, {width, height, p.rgba8.data(), p.linear.data()}, settings.execution);
    INFO((report ? "" : report.error().message));
    REQUIRE(report);
    p.report = *report;
    return p;
}

struct Tally {
    std::uint64_t drawn = 0, visible = 0;
    int pictures = 0;
};

void check_culling(const Scene& scene, const Camera& camera, const halflit::test::Setup& settings, int width, int height, Tally& tally) {
    Scene all = scene;
    for (Mesh& mesh : all.meshes) mesh = without_culling(mesh);
    std::uint64_t added = 0;
    for (const Instance& instance : scene.instances) {
        const auto mesh = static_cast<std::size_t>(instance.mesh);
        added += (all.meshes[mesh].indices.size() - scene.meshes[mesh].indices.size()) / 3;
    }
    const Picture culled = draw(scene, camera, settings, width, height), whole = draw(all, camera, settings, width, height);
    CHECK(whole.report.triangles_submitted == culled.report.triangles_submitted + added);
    CHECK(whole.report.triangles_not_finite == culled.report.triangles_not_finite + added);  // no cluster was left out
    CHECK(culled.report.triangles_drawn == whole.report.triangles_drawn);
    CHECK(culled.report.pixels_visible == whole.report.pixels_visible);
    CHECK(culled.report.fragments_shaded == whole.report.fragments_shaded);
    const auto bytes = [](const std::vector<float>& v) {
        return std::span(reinterpret_cast<const std::uint8_t*>(v.data()), v.size() * sizeof(float));
    };
    CHECK(pixel_hash(culled.rgba8) == pixel_hash(whole.rgba8));
    CHECK(pixel_hash(bytes(culled.linear)) == pixel_hash(bytes(whole.linear)));
    tally.drawn += culled.report.triangles_drawn;
    tally.visible += culled.report.pixels_visible;
    ++tally.pictures;
}

/// Scene of three materials without light, so that vertex colours are visible: plain, two-sided and transparent.
Scene coloured(Random& random, std::vector<Mesh> meshes) {
    Scene scene;
    scene.materials.resize(3);
    for (Material& material : scene.materials) material.unlit = true;
    scene.materials[1].double_sided = true;
    scene.materials[2].alpha_mode = AlphaMode::blend;
    scene.materials[2].base_color.w = 0.5f;
    scene.meshes = std::move(meshes);
    for (Mesh& mesh : scene.meshes) {
        mesh.material = random.chance(0.7) ? 0 : random.index(3);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            mesh.colors.push_back({random.real32(0, 1), random.real32(0, 1), random.real32(0, 1), 1});
    }
    return scene;
}

halflit::test::Setup any_settings(Random& random, int width, int height) {
    halflit::test::Setup settings;
    settings.execution.threads = static_cast<int>(random.integer(1, 2));
    settings.samples = random.chance(0.5) ? 1 : random.chance(0.5) ? 4 : random.chance(0.5) ? 8 : 16;
    settings.execution.tile_size = 16 << random.index(3);
    if (random.chance(0.3)) settings.region = random_region(random, width, height);
    return settings;
}

struct Window {
    int width, height;
};
constexpr Window kWindows[] = {{1, 1}, {2, 3}, {40, 30}, {160, 90}, {300, 200}, {4096, 2}, {3, 1000}, {700, 20}};

/// Multiplies all lengths by `size`.
Camera scaled(Camera camera, float size) {
    Vec4f& eye = camera.world_from_camera.c[3];
    eye = {eye.x * size, eye.y * size, eye.z * size, 1};
    camera.near_z *= size;
    camera.far_z *= size;
    camera.half_height *= size;
    return camera;
}

}  // namespace

TEST_CASE("culling: random scenes of all sizes and from all sides have the same pictures without it", "[raster][culling]") {
    Random random(1);
    Tally tally;
    for (int round = 0; round < 700; ++round) {
        Scene scene = coloured(random, {random_mesh(random, 12'000), random_mesh(random, 3000)});
        // Units of the world and of the mesh: a length that is huge in one may be tiny in the other.
        const float world = random.chance(0.5) ? 1.0f : random_decades(random, 1e-12, 1e12);
        const float object = random.chance(0.5) ? 1.0f : random_decades(random, 1e-12, 1e12);
        for (Mesh& mesh : scene.meshes)
            for (Vec3f& p : mesh.positions) p = p * object;
        for (int i = 0; i < 4; ++i) {
            Mat4 place = random_place(random, random_decades(random, 0.1, 4), random_decades(random, 0.1, 3));
            for (int k = 0; k < 3; ++k) place.c[k] = place.c[k] * (world / object);
            place.c[3] = {place.c[3].x * world, place.c[3].y * world, place.c[3].z * world, 1};
            scene.instances.push_back({random.index(2), place});
        }
        const Window window = kWindows[random.index(8)];
        const Camera camera = scaled(random_camera(random), world);
        INFO("round " << round << ", world " << world << ", object " << object);
        check_culling(scene, camera, any_settings(random, window.width, window.height), window.width, window.height, tally);
    }
    INFO("drawn " << tally.drawn << ", visible " << tally.visible);
    CHECK(tally.drawn > 80'000);
    CHECK(tally.visible > 200'000);
}

TEST_CASE("culling: grids whose triangles are about as large as a step of the window have the same pictures without it",
          "[raster][culling]") {
    Random random(2);
    Tally tally;
    for (int round = 0; round < 200; ++round) {
        Mesh grid = make_plane(1, 60), ball = make_sphere_of(1, 9000);
        for (Vec3f& p : grid.positions) p.y = 0.05f * p.x * p.x;
        for (Mesh* mesh : {&grid, &ball}) mesh->normals.clear(), mesh->uv0.clear();
        Scene scene = coloured(random, {grid, ball});
        const Vec3f far_away = random_point(random, random.chance(0.5) ? 0.0 : random_decades(random, 10, 1e5));
        for (int i = 0; i < 8; ++i) {
            // Flattened in one direction, and from 0.01 to 100 pixels large.
            const Vec3f scale{1, random_decades(random, 1e-4, 1), random.chance(0.5) ? 1.0f : -random_decades(random, 1e-4, 1)};
            const Mat4 turn = random_rotation(random);
            scene.instances.push_back(
                {i % 2, translation(far_away + random_point(random, 1)) * turn * scaling(scale * random_decades(random, 1e-4, 1))});
        }
        Camera camera = halflit::test::camera_at({0, 0, 3}, {0, 0, 0}, 0.9f, 0.1f);
        camera.orthographic = random.chance(0.3);
        Vec4f& eye = camera.world_from_camera.c[3];
        eye = {eye.x + far_away.x, eye.y + far_away.y, eye.z + far_away.z, 1};
        INFO("round " << round);
        check_culling(scene, camera, any_settings(random, 120, 80), 120, 80, tally);
    }
    INFO("drawn " << tally.drawn << ", visible " << tally.visible);
    CHECK(tally.drawn > 150'000);
    CHECK(tally.visible > 50'000);
}

TEST_CASE("culling: a wall that lies on the near plane, the far plane or a side has the same pictures without it", "[raster][culling]") {
    Random random(3);
    Tally tally;
    for (int round = 0; round < 600; ++round) {
        Mesh wall = make_plane(1, 16);
        wall.normals.clear(), wall.uv0.clear();
        Scene scene = coloured(random, {wall});
        const float size = random.chance(0.4) ? 1.0f : random_decades(random, 1e-38, 1e12),
                    off = random.chance(0.3) ? 0.0f : random_decades(random, 1e-8, 1e-3);
        const float step = 1.0f + (random.chance(0.5) ? off : -off);
        Camera camera;
        camera.near_z = 0.25f * size;
        camera.far_z = 3.0f * size;
        camera.orthographic = size > 1e-30f && random.chance(0.5);
        camera.half_height = size;
        camera.fov_y_rad = 1.57079637f;
        // The wall lies across the view at the near or far plane, or along the view where it touches a side.
        const Mat4 facing{{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}, {0, 0, 0, 1}}};
        const Mat4 place = round % 3 == 0   ? translation({0, 0, -camera.near_z * step}) * facing
                           : round % 3 == 1 ? translation({0, 0, -camera.far_z * step}) * facing
                                            : translation({(camera.orthographic ? 1.0f : 2.0f) * size * step, 0, -2.0f * size});
        scene.instances.push_back({0, place * scaling({size, size, size})});
        scene.materials[0].double_sided = random.chance(0.5);
        INFO("round " << round << ", size " << size << ", off " << off);
        check_culling(scene, camera, any_settings(random, 64, 64), 64, 64, tally);
    }
    CHECK(tally.drawn > 1000);
}

TEST_CASE("culling: the test scenes, with shadows, have the same pictures without it", "[raster][culling]") {
    Tally tally;
    for (const NamedScene& s : all_scenes()) {
        halflit::test::Setup settings;
        settings.shadow_size = 128;
        settings.execution.threads = 2;
        INFO(s.name);
        check_culling(s.scene, s.camera, settings, 160, 120, tally);
    }
    CHECK(tally.pictures == static_cast<int>(all_scenes().size()));
    CHECK(tally.visible > 30'000);
}

TEST_CASE("culling: triangles that are not finite are counted wherever the view looks", "[raster][culling]") {
    for (const float x : {0.0f, 10.0f}) {
        Scene scene;
        scene.meshes = {make_box({1, 1, 1})};
        Mat4 place = scaling({1, 3e38f, 1});
        place.c[3].x = x;
        scene.instances = {{0, place}};
        Camera camera;
        camera.orthographic = true;
        camera.half_height = 0.5f;
        camera.near_z = -5;
        camera.far_z = 5;
        CHECK(draw(scene, camera, {}, 32, 32).report.triangles_not_finite == 12);
    }
}

TEST_CASE("culling: coordinates among the denormals have the same pictures by every instruction set", "[raster][culling]") {
    Random random(4);
    int pictures = 0;
    for (int round = 0; round < 150; ++round) {
        Scene scene = coloured(random, {random_mesh(random, 400), random_mesh(random, 400)});
        const float world = random_decades(random, 1e-40, 1e-35);
        for (int i = 0; i < 4; ++i) {
            Mat4 place = random_place(random, 1, random_decades(random, 0.1, 3));
            for (Vec4f& c : place.c) c = {c.x * world, c.y * world, c.z * world, c.w};
            scene.instances.push_back({random.index(2), place});
        }
        const Camera camera = scaled(random_camera(random), world);
        halflit::test::Setup settings = any_settings(random, 60, 40);
        const auto pixels = [&](Isa isa) {
            std::vector<std::uint8_t> rgba8(std::size_t{4} * 60 * 40);
            settings.execution.isa = isa;
            const bool drawn = render(scene, camera, settings, {60, 40, rgba8.data(), nullptr}, settings.execution).has_value();
            return drawn ? rgba8 : std::vector<std::uint8_t>{};  // a matrix that is not finite is refused
        };
        const std::vector<std::uint8_t> first = pixels(Isa::scalar);
        pictures += !first.empty();
        for (const Isa isa : halflit::test::available_isas()) {
            INFO("round " << round << ", unit " << world << ", " << isa_name(isa));
            CHECK(pixels(isa) == first);
        }
    }
    CHECK(pictures > 50);
}
