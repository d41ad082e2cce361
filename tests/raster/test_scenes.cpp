#include "tests/raster/test_scenes.hpp"

#include "halflit/mesh.hpp"
#include "halflit/shapes.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/random.hpp"

#include <limits>

namespace halflit::raster::test {
namespace {

using halflit::test::camera_at;
using halflit::test::Random;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

int add_texture(Scene& scene, int width, int height, ColorSpace space, std::uint64_t seed, bool normal_map) {
    Random random(seed);
    std::vector<std::uint8_t> rgba(static_cast<std::size_t>(4 * width * height));
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        const bool dark = ((i / 4 % static_cast<std::size_t>(width)) / 4 + (i / 4 / static_cast<std::size_t>(width)) / 4) % 2 == 0;
        for (std::size_t c = 0; c < 4; ++c) rgba[i + c] = static_cast<std::uint8_t>((dark ? 20 : 150) + random.integer(0, 100));
        if (normal_map) {
            rgba[i] = static_cast<std::uint8_t>(random.integer(90, 165));
            rgba[i + 1] = static_cast<std::uint8_t>(random.integer(90, 165));
            rgba[i + 2] = 235;
        }
    }
    scene.textures.push_back(Texture::from_rgba8(rgba, width, height, space).value());
    return static_cast<int>(scene.textures.size()) - 1;
}

int add_material(Scene& scene, Material material) {
    scene.materials.push_back(std::move(material));
    return static_cast<int>(scene.materials.size()) - 1;
}

void add(Scene& scene, Mesh mesh, int material, const Mat4& place) {
    mesh.material = material;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, place});
}

Mat4 turned(float x, float y, float z, float w) {
    const float inv = 1.0f / __builtin_sqrtf(x * x + y * y + z * z + w * w);
    return rotation({x * inv, y * inv, z * inv, w * inv});
}

/// place(material, x, z) puts a ball that has tangents into the scene.
auto balls_of(Scene& scene) {
    Mesh ball = make_sphere(0.55f, 28, 16);
    generate_tangents(ball, 0);
    return [&scene, ball = std::move(ball)](Material material, float x, float z) {
        add(scene, ball, add_material(scene, std::move(material)), translation({x, 0, z}));
    };
}

void add_lights(Scene& scene) {
    Light sun;
    sun.direction_ws = {-0.3f, -1, -0.4f};
    sun.color_linear = {0.7f, 0.65f, 0.6f};
    Light lamp;
    lamp.type = LightType::point;
    lamp.position_ws = {1.5f, 1.2f, 1.0f};
    lamp.color_linear = {1.0f, 0.4f, 0.2f};
    lamp.range = 6;
    Light spot;
    spot.type = LightType::spot;
    spot.position_ws = {-2, 3, 2};
    spot.direction_ws = {0.5f, -0.8f, -0.4f};
    spot.color_linear = {2, 4, 6};
    spot.inner_cone_rad = 0.2f;
    spot.outer_cone_rad = 0.5f;
    scene.lights = {sun, lamp, spot};
    scene.ambient = {{0.12f, 0.14f, 0.18f}, {0.08f, 0.06f, 0.05f}};
}

}  // namespace

NamedScene materials_scene() {
    NamedScene out{"materials", {}, camera_at({2.6f, 1.9f, 3.4f}, {0, 0.2f, 0}, 0.8f, 0.05f)};
    Scene& s = out.scene;
    add_lights(s);
    const int color = add_texture(s, 64, 32, ColorSpace::srgb, 1, false), bumps = add_texture(s, 48, 48, ColorSpace::linear, 2, true);
    const int rough = add_texture(s, 16, 64, ColorSpace::linear, 3, false), odd = add_texture(s, 7, 5, ColorSpace::srgb, 4, false);

    Material tiles;
    tiles.textures[TextureSlot::base_color].texture = color;
    tiles.textures[TextureSlot::base_color].row_u = {6, 0.5f, 0.1f};
    tiles.textures[TextureSlot::base_color].row_v = {-0.5f, 6, 0.3f};
    tiles.textures[TextureSlot::base_color].sampler.wrap_u = TextureWrap::mirror;
    tiles.metallic = 0;
    tiles.roughness = 0.4f;
    tiles.lobe = Lobe::sloan(0.5f);
    add(s, make_plane(6, 3), add_material(s, tiles), translation({0, -0.6f, 0}));

    Material metal;
    metal.base_color = {0.9f, 0.7f, 0.4f, 1};
    metal.roughness = 0.9f;
    metal.textures[TextureSlot::metallic_roughness].texture = metal.textures[TextureSlot::occlusion].texture = rough;
    metal.textures[TextureSlot::normal].texture = bumps;
    metal.normal_scale = 0.7f;
    metal.emissive = {0.1f, 0.1f, 0.2f};
    metal.textures[TextureSlot::emissive] = {
        odd,
        0,
        {TextureWrap::clamp, TextureWrap::repeat, TextureFilter::nearest, TextureFilter::nearest, MipFilter::none},
        {4, 0, 0},
        {0, 4, 0}};
    Mesh ball = make_sphere(0.6f, 24, 14);
    generate_tangents(ball, 0);
    const int metal_index = add_material(s, metal);
    add(s, ball, metal_index, translation({-0.9f, 0, 0.2f}));
    // Mirrored, scaled unevenly and rotated: winding, normals and tangent frames turn over.
    add(s, ball, metal_index, translation({0.8f, 0.1f, -0.6f}) * turned(0.2f, 0.5f, 0.1f, 0.8f) * scaling({-1.2f, 0.6f, 0.9f}));

    Material clay;
    clay.metallic = 0;
    clay.roughness = 0.2f;
    clay.lobe = {0.4f, 3.3f, true};
    clay.textures[TextureSlot::base_color] = {
        color,
        1,
        {TextureWrap::clamp, TextureWrap::mirror, TextureFilter::nearest, TextureFilter::linear, MipFilter::nearest},
        {3, 0, 0},
        {0, 3, 0}};
    Mesh torus = make_torus(0.5f, 0.2f, 20, 12);
    torus.uv1 = torus.uv0;
    for (std::size_t i = 0; i < torus.positions.size(); ++i) {
        const Vec3f p = torus.positions[i];
        torus.colors.push_back({0.5f + 0.5f * p.x, 0.5f + 0.5f * p.y, 0.5f + 0.5f * p.z, 1});
    }
    add(s, torus, add_material(s, clay), translation({0.1f, 0.1f, 0.9f}) * turned(0.6f, 0.1f, 0.2f, 0.7f));

    Material grate;
    grate.alpha_mode = AlphaMode::mask;
    grate.alpha_cutoff = 0.45f;
    grate.double_sided = true;
    grate.metallic = 0;
    grate.textures[TextureSlot::base_color].texture = color;
    add(s, make_box({0.35f, 0.35f, 0.35f}), add_material(s, grate), translation({1.4f, 0.1f, 0.8f}) * turned(0.1f, 0.4f, 0.2f, 0.9f));

    Material glass;
    glass.alpha_mode = AlphaMode::blend;
    glass.base_color = {0.3f, 0.6f, 0.9f, 0.4f};
    glass.metallic = 0;
    glass.double_sided = true;
    add(s, make_plane(0.8f, 2), add_material(s, glass), translation({0.3f, 0.3f, 1.5f}) * turned(0.7f, 0.1f, 0, 0.7f));

    Material flag;
    flag.unlit = true;
    flag.double_sided = true;
    flag.base_color = {0.9f, 0.2f, 0.1f, 1};
    Mesh through;  // reaches from the far ground past the eye
    through.positions = {{2.2f, 1.4f, 3.6f}, {-3, 1.8f, -3}, {-3, 2.4f, -3}};
    through.indices = {0, 1, 2};
    add(s, through, add_material(s, flag), {});
    return out;
}

NamedScene small_triangles_scene() {
    NamedScene out{"small triangles", {}, camera_at({0.3f, 0.2f, 2.1f}, {0, 0, 0}, 0.7f, 0.05f)};
    Scene& s = out.scene;
    add_lights(s);
    Material matte;
    matte.metallic = 0;
    matte.lobe = Lobe::valve();
    add(s, make_sphere_of(0.7f, 20'000), add_material(s, matte), {});
    Material back;
    back.metallic = 0;
    back.roughness = 0.3f;
    back.textures[TextureSlot::base_color].texture = add_texture(s, 128, 128, ColorSpace::srgb, 9, false);
    add(s, make_plane(40, 1), add_material(s, back), translation({0, -0.5f, 0}));
    return out;
}

NamedScene layers_scene() {
    NamedScene out{"layers", {}, camera_at({0.5f, 0.8f, 2.6f}, {0, 0, 0}, 0.8f, 0.05f)};
    Scene& s = out.scene;
    add_lights(s);
    Material fence;
    fence.alpha_mode = AlphaMode::mask;
    fence.double_sided = true;
    fence.unlit = true;
    fence.textures[TextureSlot::base_color].texture = add_texture(s, 32, 32, ColorSpace::srgb, 12, false);
    fence.textures[TextureSlot::base_color].row_u = {5, 0, 0};
    add(s, make_plane(1.2f, 1), add_material(s, fence), translation({0, 0, -0.4f}) * turned(0.7f, 0, 0, 0.7f));
    Random random(13);
    for (int i = 0; i < 12; ++i) {
        Material pane;
        pane.alpha_mode = AlphaMode::blend;
        pane.base_color = {random.real32(0, 1), random.real32(0, 1), random.real32(0, 1), random.real32(0.1, 0.9)};
        pane.double_sided = i % 3 != 0;
        pane.unlit = i % 2 == 0;
        pane.metallic = 0;
        // One draw a statement: compilers differ in the order in which they evaluate arguments.
        const float turn_w = random.real32(0.2, 1);
        const float turn_z = random.real32(-1, 1);
        const float turn_y = random.real32(-1, 1);
        const float turn_x = random.real32(-1, 1);
        const Vec3f centre{random.real32(-0.5, 0.5), random.real32(-0.4, 0.4), random.real32(-0.5, 0.8)};
        add(s, make_plane(0.7f, 2), add_material(s, pane), translation(centre) * turned(turn_x, turn_y, turn_z, turn_w));
    }
    return out;
}

NamedScene rough_scene() {
    NamedScene out{"rough", {}, camera_at({0.4f, 0.5f, 3.0f}, {0, 0, 0}, 0.9f, 0.01f)};
    Scene& s = out.scene;
    add_lights(s);
    Material plain;
    plain.metallic = 0.5f;
    plain.roughness = 0.0f;
    const int material = add_material(s, plain);
    Mesh ball = make_sphere(0.5f, 16, 10);
    for (std::size_t i = 0; i < ball.normals.size(); i += 7) ball.normals[i] = ball.normals[i] * 1e-30f;
    for (std::size_t i = 3; i < ball.normals.size(); i += 31) ball.normals[i] = {kNan, 0, kInf};
    for (std::size_t i = 5; i < ball.positions.size(); i += 41) ball.positions[i] = {kNan, 0, 0};
    for (std::size_t i = 6; i < ball.positions.size(); i += 43) ball.positions[i] = {0, kInf, 0};
    add(s, ball, material, translation({-0.6f, 0, 0}));
    add(s, make_box({1e-20f, 1e-20f, 1e-20f}), material, translation({0.7f, 0, 0}) * scaling({4e19f, 3e19f, 5e19f}));
    add(s, make_plane(1e7f, 2), material, translation({0, -0.7f, 0}));
    add(s, make_sphere(1e-30f, 8, 5), material, {});
    Mesh bright = make_box({0.2f, 0.2f, 0.2f});
    for (std::size_t i = 0; i < bright.positions.size(); ++i) bright.colors.push_back({i % 2 ? 1e38f : -1e38f, 3e38f, 1e-42f, 1});
    add(s, bright, material, translation({0, 0.8f, 0}));
    return out;
}

NamedScene many_lights_scene() {
    NamedScene out{"many lights", {}, camera_at({0, 2.5f, 4}, {0, 0, 0}, 0.9f, 0.1f)};
    Scene& s = out.scene;
    add_lights(s);
    Random random(14);
    for (int i = 0; i < 48; ++i) {
        Light light;
        light.type = i % 3 == 0 ? LightType::spot : LightType::point;
        light.position_ws = {random.real32(-4, 4), random.real32(0.1, 0.6), random.real32(-4, 3)};
        light.color_linear = {random.real32(0, 0.1), random.real32(0, 0.1), random.real32(0, 0.1)};
        light.direction_ws = {random.real32(-1, 1), -1, random.real32(-1, 1)};
        light.range = random.real32(0.3, 1.2);
        s.lights.push_back(light);
    }
    Material floor;
    floor.metallic = 0;
    floor.roughness = 0.3f;
    floor.lobe = Lobe::green(0.3f);
    add(s, make_plane(6, 8), add_material(s, floor), {});
    Material ball;
    ball.metallic = 0.8f;
    ball.roughness = 0.5f;
    const int ball_index = add_material(s, ball);
    for (int i = 0; i < 9; ++i)
        add(s, make_sphere(0.3f, 16, 10), ball_index,
            translation({1.2f * static_cast<float>(i % 3 - 1), 0.3f, 1.2f * static_cast<float>(i / 3 - 1)}));
    return out;
}

NamedScene coats_scene() {
    NamedScene out{"coats", {}, camera_at({0.6f, 1.8f, 4.2f}, {0, 0.1f, 0}, 0.75f, 0.05f)};
    Scene& s = out.scene;
    add_lights(s);
    const int bumps = add_texture(s, 48, 48, ColorSpace::linear, 12, true), patches = add_texture(s, 32, 32, ColorSpace::linear, 13, false);
    const auto place = balls_of(s);

    Material lacquer;
    lacquer.base_color = {0.5f, 0.02f, 0.03f, 1};
    lacquer.metallic = 0;
    lacquer.roughness = 0.7f;
    lacquer.clearcoat = 1;
    place(lacquer, -1.3f, 0.3f);
    // A rough metal with bumps below a smooth coat.
    Material flakes = lacquer;
    flakes.base_color = {0.1f, 0.3f, 0.6f, 1};
    flakes.metallic = 0.8f;
    flakes.textures[TextureSlot::normal].texture = bumps;
    place(flakes, 0, 0.5f);
    Material peel = lacquer;
    peel.base_color = {0.1f, 0.4f, 0.15f, 1};
    peel.clearcoat_roughness = 0.3f;
    peel.textures[TextureSlot::clearcoat_normal].texture = bumps;
    peel.clearcoat_normal_scale = 0.4f;
    peel.textures[TextureSlot::clearcoat_roughness].texture = peel.textures[TextureSlot::clearcoat].texture = patches;
    place(peel, 1.3f, 0.3f);
    Material lamp = lacquer;
    lamp.base_color = {0.1f, 0.1f, 0.1f, 1};
    lamp.emissive = {0.5f, 0.4f, 0.1f};
    lamp.clearcoat = 0.6f;
    lamp.clearcoat_roughness = 1;
    lamp.double_sided = true;
    place(lamp, -0.7f, -0.9f);
    Material glass = lacquer;
    glass.base_color = {0.6f, 0.8f, 0.9f, 1};
    glass.transmission = 0.8f;
    glass.clearcoat_roughness = 0.2f;
    place(glass, 0.7f, 1.2f);
    Material floor = lacquer;
    floor.base_color = {0.4f, 0.3f, 0.2f, 1};
    floor.clearcoat = 0.5f;
    floor.clearcoat_roughness = 0.5f;
    add(s, make_plane(7, 3), add_material(s, floor), translation({0, -0.55f, 0}));
    return out;
}

NamedScene fabrics_scene() {
    NamedScene out{"fabrics", {}, camera_at({-0.5f, 1.6f, 4.2f}, {0, 0.1f, 0}, 0.75f, 0.05f)};
    Scene& s = out.scene;
    add_lights(s);
    const int weave = add_texture(s, 32, 32, ColorSpace::srgb, 22, false), bumps = add_texture(s, 48, 48, ColorSpace::linear, 23, true);
    const auto place = balls_of(s);

    Material velvet;
    velvet.base_color = {0.2f, 0.01f, 0.05f, 1};
    velvet.metallic = 0;
    velvet.sheen_color = {0.9f, 0.3f, 0.4f}, velvet.sheen_roughness = 0.3f;
    place(velvet, -1.3f, 0.3f);
    Material wool = velvet;
    wool.base_color = {0.3f, 0.3f, 0.25f, 1};
    wool.sheen_color = {1, 1, 1}, wool.sheen_roughness = 1;
    wool.textures[TextureSlot::sheen_color].texture = wool.textures[TextureSlot::sheen_roughness].texture = weave;
    wool.textures[TextureSlot::normal].texture = bumps;
    place(wool, 0, 0.5f);
    Material dust = velvet;
    dust.base_color = {0.8f, 0.5f, 0.2f, 1};
    dust.metallic = 1;
    dust.roughness = 0.3f;
    dust.sheen_color = {0.3f, 0.3f, 0.5f}, dust.sheen_roughness = 0;
    place(dust, 1.3f, 0.3f);
    Material lacquered = velvet;
    lacquered.clearcoat = 0.7f;
    lacquered.clearcoat_roughness = 0.15f;
    lacquered.emissive = {0, 0.1f, 0};
    lacquered.double_sided = true;
    place(lacquered, -0.7f, -0.9f);
    Material gauze = velvet;
    gauze.base_color = {0.7f, 0.8f, 0.9f, 1};
    gauze.transmission = 0.7f;
    gauze.sheen_roughness = 0.6f;
    place(gauze, 0.7f, 1.2f);
    Material carpet = velvet;
    carpet.base_color = {0.1f, 0.12f, 0.3f, 1};
    carpet.sheen_color = {0.3f, 0.3f, 0.8f}, carpet.sheen_roughness = 0.7f;
    add(s, make_plane(7, 3), add_material(s, carpet), translation({0, -0.55f, 0}));
    return out;
}

NamedScene films_scene() {
    NamedScene out{"films", {}, camera_at({0.4f, 1.7f, 4.2f}, {0, 0.1f, 0}, 0.75f, 0.05f)};
    Scene& s = out.scene;
    add_lights(s);
    const int patches = add_texture(s, 32, 32, ColorSpace::linear, 24, false), bumps = add_texture(s, 48, 48, ColorSpace::linear, 25, true);
    const auto place = balls_of(s);

    Material soap;
    soap.base_color = {0.9f, 0.9f, 0.95f, 1};
    soap.metallic = 0, soap.roughness = 0.1f, soap.transmission = 0.9f;
    soap.iridescence = 1, soap.iridescence_thickness_max_nm = 480;
    place(soap, 0.7f, 1.2f);
    Material steel;
    steel.base_color = {0.6f, 0.58f, 0.55f, 1};
    steel.roughness = 0.25f;
    steel.iridescence = 1, steel.iridescence_ior = 1.8f;
    steel.iridescence_thickness_min_nm = 50, steel.iridescence_thickness_max_nm = 600;
    steel.textures[TextureSlot::iridescence_thickness].texture = patches;
    steel.textures[TextureSlot::normal].texture = bumps;
    place(steel, -1.3f, 0.3f);
    Material beetle = steel;
    beetle.base_color = {0.02f, 0.1f, 0.05f, 1};
    beetle.metallic = 0.4f;
    beetle.specular_color = {1, 0.5f, 0.7f};
    beetle.textures[TextureSlot::iridescence].texture = patches;
    beetle.clearcoat = 0.5f, beetle.clearcoat_roughness = 0.2f;
    place(beetle, 1.3f, 0.3f);
    Material pearl;
    pearl.base_color = {0.8f, 0.75f, 0.7f, 1};
    pearl.metallic = 0, pearl.roughness = 0.4f;
    pearl.iridescence = 0.7f, pearl.iridescence_thickness_max_nm = 300;
    pearl.sheen_color = {0.2f, 0.2f, 0.2f}, pearl.sheen_roughness = 0.5f;
    pearl.double_sided = true;
    place(pearl, -0.5f, -0.8f);
    Material oil = pearl;
    oil.base_color = {0.05f, 0.05f, 0.05f, 1};
    oil.sheen_color = {0, 0, 0};
    add(s, make_plane(7, 3), add_material(s, oil), translation({0, -0.55f, 0}));
    return out;
}

NamedScene brushed_scene() {
    NamedScene out{"brushed", {}, camera_at({0.5f, 1.8f, 4.1f}, {0, 0.1f, 0}, 0.75f, 0.05f)};
    Scene& s = out.scene;
    add_lights(s);
    const int swirl = add_texture(s, 32, 32, ColorSpace::linear, 26, false), bumps = add_texture(s, 48, 48, ColorSpace::linear, 27, true);
    const auto place = balls_of(s);

    Material pan;
    pan.base_color = {0.8f, 0.78f, 0.75f, 1};
    pan.roughness = 0.3f;
    pan.anisotropy_strength = 0.8f;
    place(pan, -1.3f, 0.3f);
    Material across = pan;
    across.anisotropy_rotation_rad = 1.2f;
    across.textures[TextureSlot::normal].texture = bumps;
    across.double_sided = true;
    place(across, 0, 0.6f);
    Material hair = pan;
    hair.base_color = {0.2f, 0.1f, 0.05f, 1};
    hair.metallic = 0.2f;
    hair.textures[TextureSlot::anisotropy].texture = hair.textures[TextureSlot::metallic_roughness].texture = swirl;
    place(hair, 1.3f, 0.3f);
    Material disc = pan;
    disc.anisotropy_strength = 1, disc.roughness = 0;
    disc.iridescence = 1;
    disc.clearcoat = 1;
    place(disc, -0.6f, -0.9f);
    Material silk = pan;
    silk.metallic = 0, silk.roughness = 0.5f;
    silk.base_color = {0.5f, 0.1f, 0.3f, 1};
    silk.sheen_color = {0.3f, 0.2f, 0.3f}, silk.sheen_roughness = 0.4f;
    place(silk, 0.7f, 1.3f);
    Mesh plane = make_plane(7, 3);
    generate_tangents(plane, 0);
    Material floor = pan;
    floor.base_color = {0.3f, 0.3f, 0.32f, 1};
    add(s, plane, add_material(s, floor), translation({0, -0.55f, 0}));
    return out;
}

NamedScene prisms_scene() {
    NamedScene out{"prisms", {}, camera_at({-0.3f, 1.5f, 4.0f}, {0, 0.1f, 0}, 0.75f, 0.05f)};
    Scene& s = out.scene;
    add_lights(s);
    const int checks = add_texture(s, 32, 32, ColorSpace::srgb, 28, false), depths = add_texture(s, 32, 32, ColorSpace::linear, 29, false);
    const auto place = balls_of(s);

    Material crystal;
    crystal.metallic = 0, crystal.roughness = 0;
    crystal.transmission = 1, crystal.thickness = 0.8f, crystal.dispersion = 6;
    place(crystal, 0, 0.9f);
    Material diamond = crystal;
    diamond.dielectric_reflectance = 0.17f, diamond.dispersion = 1;
    diamond.base_color = {0.8f, 0.9f, 1, 1};
    place(diamond, -1.2f, 0.4f);
    Material frosted = crystal;
    frosted.roughness = 0.3f, frosted.double_sided = true;
    frosted.textures[TextureSlot::thickness].texture = frosted.textures[TextureSlot::transmission].texture = depths;
    frosted.attenuation_color = {0.9f, 0.6f, 0.3f}, frosted.attenuation_distance = 0.5f;
    place(frosted, 1.2f, 0.4f);
    Material floor;
    floor.metallic = 0;
    floor.textures[TextureSlot::base_color].texture = checks;
    const int checked = add_material(s, floor);
    add(s, make_plane(7, 3), checked, translation({0, -0.55f, 0}));
    add(s, make_box({3, 1, 0.1f}), checked, translation({0, 0.2f, -1}));
    return out;
}

NamedScene leaves_scene() {
    NamedScene out{"leaves", {}, camera_at({0.2f, 1.4f, 4.0f}, {0, 0.2f, 0}, 0.75f, 0.05f)};
    Scene& s = out.scene;
    add_lights(s);
    s.lights[0].direction_ws = {0.2f, -0.7f, 0.6f};
    s.lights[1].position_ws = {1.3f, 0.1f, 0.3f};
    const int veins = add_texture(s, 32, 32, ColorSpace::srgb, 30, false), bumps = add_texture(s, 48, 48, ColorSpace::linear, 31, true);
    const auto place = balls_of(s);
    Mesh sheet = make_plane(0.6f, 4);
    generate_tangents(sheet, 0);
    const auto hang = [&](const Material& material, float x, float y, float z, float turn) {
        add(s, sheet, add_material(s, material), translation({x, y, z}) * turned(0.7f, turn, 0, 0.7f));
    };

    Material leaf;
    leaf.base_color = {0.1f, 0.3f, 0.05f, 1};
    leaf.metallic = 0, leaf.roughness = 0.5f, leaf.double_sided = true;
    leaf.diffuse_transmission = 0.6f, leaf.diffuse_transmission_color = {0.5f, 0.8f, 0.1f};
    hang(leaf, -1.2f, 0.3f, 0.2f, 0.1f);
    Material autumn = leaf;
    autumn.textures[TextureSlot::diffuse_transmission].texture = autumn.textures[TextureSlot::diffuse_transmission_color].texture = veins;
    autumn.textures[TextureSlot::normal].texture = bumps;
    autumn.alpha_mode = AlphaMode::mask, autumn.alpha_cutoff = 0.2f;
    hang(autumn, 0, 0.3f, -0.6f, -0.2f);
    Material waxed = leaf;
    waxed.clearcoat = 0.8f, waxed.clearcoat_roughness = 0.2f;
    waxed.sheen_color = {0.3f, 0.3f, 0.4f}, waxed.sheen_roughness = 0.5f;
    waxed.transmission = 0.3f;
    waxed.textures[TextureSlot::occlusion].texture = veins;
    hang(waxed, 0.1f, 0.2f, 0.8f, 0.4f);
    // A shade about the light.
    Material shade = leaf;
    shade.base_color = {0.8f, 0.75f, 0.6f, 1};
    shade.diffuse_transmission_color = {1, 0.7f, 0.4f};
    shade.specular_color = {1, 0.5f, 0.5f}, shade.iridescence = 0.4f;
    place(shade, 1.3f, 0.3f);
    Material paper = leaf;
    paper.base_color = {0.8f, 0.8f, 0.8f, 1}, paper.diffuse_transmission = 1, paper.metallic = 0.3f;
    add(s, make_plane(7, 3), add_material(s, paper), translation({0, -0.55f, 0}));
    return out;
}

std::vector<NamedScene> all_scenes() {
    std::vector<NamedScene> scenes;
    Scene demo = demo_scene();
    const Camera camera = demo.cameras.at(0);
    scenes.push_back({"demo", std::move(demo), camera});
    scenes.push_back(materials_scene());
    scenes.push_back(small_triangles_scene());
    scenes.push_back(layers_scene());
    scenes.push_back(rough_scene());
    scenes.push_back(many_lights_scene());
    scenes.push_back(coats_scene());
    scenes.push_back(fabrics_scene());
    scenes.push_back(films_scene());
    scenes.push_back(brushed_scene());
    scenes.push_back(prisms_scene());
    scenes.push_back(leaves_scene());
    return scenes;
}

}  // namespace halflit::raster::test
