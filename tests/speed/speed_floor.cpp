// Small frames of the common kinds of work, whose instructions speed_floor.py counts under valgrind's callgrind. Run without valgrind it
// draws them and prints nothing but errors.
// Exit code: 0 drawn, 1 failed, 4 skipped (the processor lacks the instruction set).
#include "halflit/auto_setup.hpp"
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "tests/support/random.hpp"

#include <valgrind/callgrind.h>

#include <cstdio>
#include <string>

using namespace halflit;
using halflit::test::Random;

namespace {

constexpr int kWidth = 160, kHeight = 96;
constexpr Isa kIsa = Isa::avx2;  // the widest that valgrind runs

struct Subject {
    const char* name;
    Scene scene;
    Camera camera;
    Settings settings;
};

Camera camera_at(float distance) {
    Camera camera;
    camera.world_from_camera = translation({0, 0, distance});
    return camera;
}

/// A scene with one mesh of one material.
Scene scene_of(Mesh mesh, const Material& material) {
    Scene scene;
    scene.materials.push_back(material);
    mesh.material = 0;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({0, {}});
    return scene;
}

/// Such a scene under a directional light.
Subject subject_of(const char* name, Mesh mesh, float distance) {
    Material material;
    material.metallic = 0.0f;
    material.roughness = 0.5f;
    material.lobe = Lobe::sloan(0.5f);
    Subject subject{name, scene_of(std::move(mesh), material), camera_at(distance), {}};
    Light light;
    light.direction_ws = normalize_or({-1, -1, -1}, {0, -1, 0});
    subject.scene.lights.push_back(light);
    subject.scene.ambient.sky_linear = {0.1f, 0.1f, 0.2f};
    subject.settings.shadows = ShadowMode::off;
    subject.settings.background_linear = {0, 0, 0, 1};
    return subject;
}

/// Squares that fill the picture, the farthest first.
Mesh layers(int count) {
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const float z = 0.01f * static_cast<float>(i);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int corner = 0; corner < 4; ++corner) {
            const float x = corner == 1 || corner == 2 ? 1.0f : -1.0f, y = corner < 2 ? -1.0f : 1.0f;
            mesh.positions.push_back({4 * x, 4 * y, z});
            mesh.normals.push_back({0, 0, 1});
            mesh.tangents.push_back({1, 0, 0, 1});
            mesh.uv0.push_back({4 * x, -4 * y});
        }
        for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + corner);
    }
    return mesh;
}

Texture noise(ColorSpace space) {
    constexpr int kSide = 64;
    Random random(7);
    std::vector<std::uint8_t> rgba8;
    for (int i = 0; i < kSide * kSide; ++i)
        for (int c = 0; c < 4; ++c) rgba8.push_back(static_cast<std::uint8_t>(c == 2 ? 255 : random.integer(100, 156)));
    return *Texture::from_rgba8(rgba8, kSide, kSide, space);
}

void add_textures(Scene& scene) {
    scene.textures = {noise(ColorSpace::srgb), noise(ColorSpace::linear)};
    scene.materials[0].textures[TextureSlot::base_color].texture = 0;
    scene.materials[0].textures[TextureSlot::normal].texture = 1;
}

void add_lamps(Scene& scene, int count) {
    Random random(8);
    for (int i = 0; i < count; ++i) {
        Light light;
        light.type = LightType::point;
        light.position_ws = {random.real32(-2, 2), random.real32(-1, 1), random.real32(1, 2)};
        scene.lights.push_back(light);
    }
}

std::shared_ptr<const Environment> sky() {
    EnvironmentImage image{16, 8, {}, true};
    for (int i = 0; i < 16 * 8 * 3; ++i) image.rgb.push_back(0.2f + 0.01f * static_cast<float>(i % 48));
    return *make_environment(image);
}

/// The picture of a file with this mesh, as the command line draws it without flags: view, studio, key light with a shadow, four samples.
Subject default_picture(const char* name, Mesh mesh, bool textured = false) {
    Material material;
    material.metallic = textured ? 0.5f : 0.0f;
    material.roughness = textured ? 0.4f : 0.8f;
    if (textured) generate_tangents(mesh, 0);
    Subject subject{name, scene_of(std::move(mesh), material), {}, {}};
    if (textured) add_textures(subject.scene);
    AutoSetup setup = auto_setup(subject.scene, kWidth, kHeight);
    static_cast<Lighting&>(subject.scene) = std::move(setup.light);
    subject.camera = setup.camera;
    subject.settings = setup.settings;
    return subject;
}

/// Boxes with flat faces, some of them inside each other.
Mesh heap() {
    Random random(9);
    Mesh mesh;
    for (int i = 0; i < 60; ++i) {
        const Mesh box = make_box({random.real32(0.05, 0.3), random.real32(0.05, 0.3), random.real32(0.05, 0.3)});
        const Vec3f at{random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1)};
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Vec3f& p : box.positions) mesh.positions.push_back(p + at);
        mesh.normals.insert(mesh.normals.end(), box.normals.begin(), box.normals.end());
        for (const std::uint32_t index : box.indices) mesh.indices.push_back(first + index);
    }
    return mesh;
}

std::vector<Subject> subjects() {
    std::vector<Subject> all;
    all.push_back(subject_of("small-triangles", make_sphere_of(1.0f, 20000), 3.0f));
    all.push_back(subject_of("small-triangles-4-samples", make_sphere_of(1.0f, 20000), 3.0f));
    all.back().settings.samples = 4;
    all.push_back(subject_of("large-triangles", layers(16), 4.0f));
    all.push_back(subject_of("lamps", make_sphere_of(1.0f, 500), 2.5f));
    add_lamps(all.back().scene, 16);
    all.push_back(subject_of("textures", layers(1), 4.0f));
    all.back().settings.shading.specular = SpecularModel::none;
    add_textures(all.back().scene);
    all.push_back(subject_of("environment", make_sphere_of(1.0f, 500), 2.5f));
    all.back().scene.lights.clear();
    all.back().scene.environment = sky();
    all.back().settings.shading.environment_bands = 3;
    all.push_back(subject_of("shadows", make_torus(1.0f, 0.4f, 80, 40), 4.0f));
    all.back().settings.shadows = ShadowMode::soft_split;
    all.back().settings.shadow_size = 256;
    all.push_back(subject_of("blended-layers", layers(6), 4.0f));
    all.back().scene.materials[0].alpha_mode = AlphaMode::blend;
    all.back().scene.materials[0].base_color.w = 0.5f;
    all.push_back(default_picture("default-smooth", make_torus(1.0f, 0.4f, 120, 60)));
    all.push_back(default_picture("default-textured", make_sphere_of(1.0f, 2000), true));
    all.push_back(default_picture("default-flat", heap()));
    return all;
}

/// Counts the second frame: the first takes memory.
bool count(const Subject& subject) {
    std::vector<std::uint8_t> rgba8(std::size_t{4} * kWidth * kHeight);
    const Target target{kWidth, kHeight, rgba8.data()};
    Execution execution{.threads = 1};
    execution.isa = kIsa;
    const auto prepared = PreparedScene::make(subject.scene, execution);
    if (!prepared) return std::printf("%s: %s\n", subject.name, prepared.error().message.c_str()), false;
    Renderer renderer;
    for (int frame = 0; frame < 2; ++frame) {
        renderer.forget_frames();
        if (frame == 1) CALLGRIND_ZERO_STATS;
        const auto report = renderer.render(*prepared, subject.camera, subject.settings, target, execution);
        if (!report) return std::printf("%s: %s\n", subject.name, report.error().message.c_str()), false;
    }
    CALLGRIND_DUMP_STATS_AT(subject.name);
    return true;
}

}  // namespace

int main() {
    if (!isa_available(kIsa)) return std::printf("skipped: this processor lacks %s\n", std::string(isa_name(kIsa)).c_str()), 4;
    const std::vector<Subject> all = subjects();
    CALLGRIND_START_INSTRUMENTATION;
    bool good = true;
    for (const Subject& subject : all) good = count(subject) && good;
    return good ? 0 : 1;
}
