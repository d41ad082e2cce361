#include "bench/peer/scenes.hpp"

#include "bench/peer/textures.hpp"
#include "halflit/image.hpp"
#include "halflit/shapes.hpp"
#include "sh/trig.hpp"
#include "tests/support/random.hpp"

#include <charconv>
#include <cstdlib>

namespace halflit::peer {
namespace {

using test::Random;

constexpr int kTextureSide = Squares{}.texture_side;
constexpr float kFovY = 1.04719755f;         // 60 degrees
constexpr float kHalfHeight = 0.577350269f;  // of the view at distance 1: tan(30 degrees)

Camera camera_at(Vec3f place) {
    Camera camera;
    camera.world_from_camera = translation(place);
    camera.fov_y_rad = kFovY;
    camera.near_z = 0.1f;
    return camera;
}

Material clay() {
    Material material;
    material.base_color = {0.5f, 0.47f, 0.44f, 1};
    material.metallic = 0.0f;
    material.roughness = 0.5f;
    material.lobe = Lobe::sloan(0.5f);
    material.has_own_lobe = true;
    return material;
}

/// Base colour and normals from textures, trilinear.
void add_textures(BenchScene& bench, int side, float repeats) {
    bench.pictures = {colour_picture(side), normal_picture(side)};
    for (std::size_t i = 0; i < 2; ++i) {
        auto texture = Texture::from_rgba8(bench.pictures[i].rgba8, side, side, i == 0 ? ColorSpace::srgb : ColorSpace::linear);
        if (!texture) std::abort();  // no memory
        bench.scene.textures.push_back(std::move(*texture));
    }
    Material& material = bench.scene.materials[0];
    material.base_color = {1, 1, 1, 1};
    material.textures[TextureSlot::base_color].texture = 0;
    material.textures[TextureSlot::normal].texture = 1;
    for (Vec2f& uv : bench.scene.meshes[0].uv0) uv = uv * repeats;
}

void add_lamps(Scene& scene, int count, Vec3f low, Vec3f high, float strength) {
    Random random(9);
    for (int i = 0; i < count; ++i) {
        Light light;
        light.type = LightType::point;
        light.position_ws = {random.real32(low.x, high.x), random.real32(low.y, high.y), random.real32(low.z, high.z)};
        const float each = strength / static_cast<float>(count);
        light.color_linear = {each * random.real32(0.4, 1), each * random.real32(0.4, 1), each * random.real32(0.4, 1)};
        scene.lights.push_back(light);
    }
}

/// Appends a copy of a mesh, moved and scaled by the same factor in all directions.
void append(Mesh& mesh, const Mesh& part, Vec3f place, float scale) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3f& p : part.positions) mesh.positions.push_back(p * scale + place);
    mesh.normals.insert(mesh.normals.end(), part.normals.begin(), part.normals.end());
    mesh.tangents.insert(mesh.tangents.end(), part.tangents.begin(), part.tangents.end());
    mesh.uv0.insert(mesh.uv0.end(), part.uv0.begin(), part.uv0.end());
    for (const std::uint32_t i : part.indices) mesh.indices.push_back(first + i);
}

/// 11 x 6 places that fill the picture, the first 64 taken.
void spheres(BenchScene& bench, int lamps) {
    Mesh sphere = make_sphere(0.5f, 64, 32);
    generate_tangents(sphere, 0);
    Mesh& mesh = bench.scene.meshes[0];
    for (int i = 0; i < 64; ++i)
        append(mesh, sphere, {1.03f * static_cast<float>(i % 11 - 5), 1.03f * (static_cast<float>(i / 11) - 2.5f), 0}, 1.0f);
    add_textures(bench, kTextureSide, 2.0f);
    add_lamps(bench.scene, lamps, {-6, -3.5f, 1}, {6, 3.5f, 4}, 10.0f);
    bench.camera = camera_at({0, 0, 6});
}

/// One of the spheres, under 2 lights.
void small(BenchScene& bench) {
    bench.scene.meshes[0] = make_sphere(0.5f, 64, 32);
    generate_tangents(bench.scene.meshes[0], 0);
    add_textures(bench, kTextureSide, 1.0f);
    add_lamps(bench.scene, 2, {-2, 1, -2}, {2, 2, 2}, 3.0f);
    bench.camera = camera_at({0, 0, 1});  // sin(30 degrees) = 1 / 2
}

void dense(BenchScene& bench, std::int64_t triangles) {
    bench.scene.meshes[0] = make_sphere_of(1.0f, triangles);
    bench.scene.meshes[0].uv0.clear();
    add_lamps(bench.scene, 2, {-3, 1, 2}, {3, 3, 4}, 3.0f);
    bench.camera = camera_at({0, 0, 2});  // sin(30 degrees) = 1 / 2
}

void fill(BenchScene& bench, const Squares& squares, float aspect) {
    Mesh& mesh = bench.scene.meshes[0];
    constexpr float kNear = 3.0f, kStep = 0.05f;
    for (int i = squares.layers - 1; i >= 0; --i) {
        const float distance = kNear + kStep * static_cast<float>(i), half_height = 1.001f * kHalfHeight * distance;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int corner = 0; corner < 4; ++corner) {
            const float x = corner == 1 || corner == 2 ? 1.0f : -1.0f, y = corner < 2 ? -1.0f : 1.0f;
            mesh.positions.push_back({x * aspect * half_height, y * half_height, -distance});
            mesh.normals.push_back({0, 0, 1});
            mesh.tangents.push_back({1, 0, 0, 1});
            mesh.uv0.push_back({0.5f * (x + 1) * aspect, 0.5f * (1 - y)});
        }
        for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + corner);
    }
    add_textures(bench, squares.texture_side, 2.0f * static_cast<float>(kTextureSide) / static_cast<float>(squares.texture_side));
    add_lamps(bench.scene, squares.lamps, {-2.5f, -1.5f, -2}, {2.5f, 1.5f, -0.8f}, 3.5f);
    bench.camera = camera_at({0, 0, 0});
}

/// Small boxes, turned and scattered in a deep block; without textures.
void boxes(BenchScene& bench, int count) {
    Random random(5);
    Mesh& mesh = bench.scene.meshes[0];
    const Mesh box = make_box({1, 1, 1});
    for (int i = 0; i < count; ++i) {
        Mesh turned = box;
        turned.uv0.clear();
        const Mat4 turn = rotation(Vec3f{random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1)}, random.real32(0, 6.28));
        const auto apply = [&](Vec3f v) {
            const Vec4f r = turn * Vec4f{v.x, v.y, v.z, 0};
            return Vec3f{r.x, r.y, r.z};
        };
        for (Vec3f& p : turned.positions) p = apply(p);
        for (Vec3f& n : turned.normals) n = apply(n);
        append(mesh, turned, {random.real32(-9, 9), random.real32(-5, 5), random.real32(-12, 0)}, random.real32(0.01, 0.03));
    }
    add_lamps(bench.scene, 2, {-6, 2, 2}, {6, 5, 6}, 30.0f);
    bench.camera = camera_at({0, 0, 7});
}

BenchScene begin(std::string_view name) {
    BenchScene bench;
    bench.name = name;
    bench.scene.meshes.emplace_back();
    bench.scene.materials.push_back(clay());
    bench.scene.instances.push_back({0, {}});
    return bench;
}

void finish(BenchScene& bench) {
    bench.scene.meshes[0].material = 0;
    auto sky = make_environment(built_in_sky());
    if (!sky) std::abort();  // no memory
    bench.scene.environment = *sky;
}

int number_after(std::string_view name, std::string_view prefix) {
    int number = 0;
    std::from_chars(name.data() + prefix.size(), name.data() + name.size(), number);
    return number;
}

}  // namespace

const std::vector<SceneEntry>& scene_entries() {
    static const std::vector<SceneEntry> entries = {{"spheres-1", "64 textured spheres, 254 k triangles, 1 light"},
                                                    {"spheres-4", "the same, 4 lights"},
                                                    {"spheres-16", "the same, 16 lights"},
                                                    {"spheres-64", "the same, 64 lights"},
                                                    {"dense-1", "a sphere of a million triangles, 2 lights"},
                                                    {"dense-4", "a sphere of four million triangles, 2 lights"},
                                                    {"fill", "one textured square that fills the picture, 8 lights"},
                                                    {"overdraw", "32 such squares, back to front"},
                                                    {"boxes", "200,000 small boxes, 2.4 M triangles, 2 lights"},
                                                    {"dataset-small", "views of one of the spheres, 2 lights, with planes"},
                                                    {"dataset-large", "views of the 64 spheres, 4 lights, with planes"}};
    return entries;
}

BenchScene make_bench_scene(std::string_view name, float aspect) {
    BenchScene bench = begin(name);
    if (name.starts_with("spheres-")) spheres(bench, number_after(name, "spheres-"));
    if (name.starts_with("dense-")) dense(bench, std::int64_t{1000000} * number_after(name, "dense-"));
    if (name == "dataset-small") small(bench);
    if (name == "dataset-large") spheres(bench, 4);
    if (name == "fill") fill(bench, {}, aspect);
    if (name == "overdraw") fill(bench, {.layers = 32}, aspect);
    if (name == "boxes") boxes(bench, 200000);
    finish(bench);
    return bench;
}

BenchScene make_sphere_scene(std::int64_t triangles) {
    BenchScene bench = begin("sphere");
    dense(bench, triangles);
    finish(bench);
    return bench;
}

BenchScene make_squares_scene(const Squares& squares, float aspect) {
    BenchScene bench = begin("squares");
    fill(bench, squares, aspect);
    finish(bench);
    return bench;
}

Settings bench_settings(int samples) {
    Settings settings;
    settings.samples = samples;
    settings.background_linear = {0, 0, 0, 1};
    settings.shadows = ShadowMode::off;
    settings.shading.environment_bands = kEnvironmentBands;
    return settings;
}

}  // namespace halflit::peer
