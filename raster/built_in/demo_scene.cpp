// The built-in scene: five clay balls that differ only in their lobe, from Lambert on the left to full wrap on the right, under a low key
// light from the side. Behind them a lacquered trefoil knot stands on a plinth with a mosaic.
#include "halflit/scene.hpp"
#include "halflit/shapes.hpp"
#include "raster/built_in/demo_parts.hpp"
#include "sh/fp_environment.hpp"
#include "sh/trig.hpp"

#include <utility>

namespace halflit {

namespace {

constexpr float kBallRadius = 0.5f, kBallStep = 1.22f;
constexpr int kBalls = 5, kMiddleBall = kBalls / 2;
constexpr Vec3f kPlinthFoot{0.0f, 0.0f, -2.7f};
constexpr float kPlinthRadius = 1.5f, kPlinthSide = 0.95f, kPlinthLip = 0.05f;

Vec3f ball_foot(int i) { return {kBallStep * static_cast<float>(i - kMiddleBall), 0.0f, 0.0f}; }

int add_material(Scene& scene, const char* name, Vec3f color, float metallic, float roughness) {
    Material m;
    m.name = name;
    m.base_color = {color.x, color.y, color.z, 1};
    m.metallic = metallic;
    m.roughness = roughness;
    scene.materials.push_back(std::move(m));
    return static_cast<int>(scene.materials.size()) - 1;
}

void add_object(Scene& scene, Mesh mesh, int material, const Mat4& place) {
    mesh.material = material;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, place});
}

/// Index of the new texture; -1 if it cannot be made, and the material is drawn without it.
int add_texture(Scene& scene, Result<Texture> texture) {
    if (!texture) return -1;
    scene.textures.push_back(std::move(*texture));
    return static_cast<int>(scene.textures.size()) - 1;
}

void add_backdrop(Scene& scene) {
    std::vector<raster::detail::Occluder> occluders;
    for (int i = 0; i < kBalls; ++i) occluders.push_back({ball_foot(i), kBallRadius, 0.0f});
    occluders.push_back({kPlinthFoot, kPlinthRadius, kPlinthSide});
    const int paper = add_material(scene, "paper", {1, 1, 1}, 0.0f, 1.0f);
    add_object(scene, raster::detail::make_cyclorama(16.0f, {0.17f, 0.215f, 0.27f}, occluders), paper, {});
    scene.instances.back().backdrop = true;
}

void add_balls(Scene& scene) {
    constexpr const char* kNames[kBalls] = {"wrap 0", "wrap 1/4", "wrap 1/2", "wrap 3/4", "wrap 1"};
    for (int i = 0; i < kBalls; ++i) {
        const int clay = add_material(scene, kNames[i], {0.84f, 0.76f, 0.66f}, 0.0f, 0.55f);
        Material& material = scene.materials[static_cast<std::size_t>(clay)];
        material.lobe = Lobe::sloan(0.25f * static_cast<float>(i));
        material.has_own_lobe = true;
        add_object(scene, make_sphere(kBallRadius, 96, 64), clay, translation(ball_foot(i) + Vec3f{0, kBallRadius, 0}));
    }
}

void add_plinth(Scene& scene) {
    const int tiles = add_material(scene, "mosaic", {1, 1, 1}, 1.0f, 1.0f);
    const raster::detail::Mosaic mosaic = raster::detail::make_mosaic(8, 6);
    const auto make = [&](const std::vector<std::uint8_t>& texels, ColorSpace space) {
        return add_texture(scene, Texture::from_rgba8(texels, mosaic.width, mosaic.height, space));
    };
    const int color = make(mosaic.color_srgb, ColorSpace::srgb), normal = make(mosaic.normal, ColorSpace::linear);
    const int roughness_metal = make(mosaic.roughness_metal, ColorSpace::linear);
    Material& material = scene.materials[static_cast<std::size_t>(tiles)];
    material.textures[TextureSlot::base_color].texture = color;
    material.textures[TextureSlot::normal].texture = normal;
    material.textures[TextureSlot::metallic_roughness].texture = roughness_metal;
    add_object(scene, raster::detail::make_plinth_side(kPlinthRadius, kPlinthSide, 7, 128), tiles, translation(kPlinthFoot));
}

/// Adds the trefoil, and the lid that it stands on.
void add_trefoil(Scene& scene) {
    const int lacquer = add_material(scene, "lacquer", {0.58f, 0.10f, 0.045f}, 0.0f, 0.28f);
    scene.materials[static_cast<std::size_t>(lacquer)].lobe = Lobe::sloan(0.5f);
    scene.materials[static_cast<std::size_t>(lacquer)].has_own_lobe = true;
    constexpr float kTube = 0.175f;
    Mesh trefoil = raster::detail::make_trefoil(0.66f, 0.33f, kTube, 320, 40);
    Vec3f lowest{0, 1e9f, 0};
    for (const Vec3f p : trefoil.positions)
        if (p.y < lowest.y) lowest = p;
    // The trefoil sinks 0.01 into the lid, so that no light shows below it.
    const float lift = kPlinthSide + 2 * kPlinthLip - lowest.y - 0.01f;
    add_object(scene, std::move(trefoil), lacquer, translation(kPlinthFoot + Vec3f{0, lift, 0}));

    const int stone = add_material(scene, "stone", {0.62f, 0.58f, 0.52f}, 0.0f, 0.6f);
    add_object(scene, raster::detail::make_plinth_lid(kPlinthRadius, kPlinthLip, 128, {{lowest.x, 2 * kPlinthLip, lowest.z}, kTube}), stone,
               translation(kPlinthFoot + Vec3f{0, kPlinthSide, 0}));
}

/// Adds a small emissive sphere with a point light in its centre.
void add_bulb(Scene& scene, const char* name, Vec3f place, Vec3f color, float power) {
    constexpr float kRadius = 0.06f;
    const int glass = add_material(scene, name, {0, 0, 0}, 0.0f, 1.0f);
    scene.materials[static_cast<std::size_t>(glass)].emissive = color;
    add_object(scene, make_sphere(kRadius, 32, 24), glass, translation(place));
    Light light;
    light.type = LightType::point;
    light.color_linear = color * power;
    light.position_ws = place;
    light.range = 4.0f;
    light.source_radius = 4 * kRadius;
    scene.lights.push_back(light);
}

void add_spot(Scene& scene, Vec3f place, Vec3f target, Vec3f color, float inner_deg, float outer_deg) {
    Light light;
    light.type = LightType::spot;
    light.position_ws = place;
    light.direction_ws = normalize_or(target - place, {0, -1, 0});
    // `color` is the light at the target: this undoes the inverse square of the distance.
    const Vec3f reach = target - place;
    light.color_linear = color * dot(reach, reach);
    light.inner_cone_rad = static_cast<float>(inner_deg * (kPi / 180.0));
    light.outer_cone_rad = static_cast<float>(outer_deg * (kPi / 180.0));
    scene.lights.push_back(light);
}

void add_lights(Scene& scene) {
    Light key;
    key.direction_ws = normalize_or({0.90f, -0.43f, -0.28f}, {0, -1, 0});
    key.color_linear = {0.98f, 0.84f, 0.66f};
    scene.lights.push_back(key);
    add_spot(scene, {5.0f, 3.6f, -4.6f}, {0.6f, 0.4f, 0.0f}, {0.11f, 0.21f, 0.40f}, 4, 48);  // cool rim light from behind
    add_spot(scene, {0.0f, 6.5f, 0.5f}, {0.0f, 2.6f, -8.0f}, {0.30f, 0.52f, 0.66f}, 2, 36);  // a glow on the wall
    add_bulb(scene, "amber bulb", {-1.83f, 0.06f, 0.75f}, {1.0f, 0.50f, 0.12f}, 0.05f);
    add_bulb(scene, "rose bulb", {0.61f, 0.06f, 0.80f}, {1.0f, 0.22f, 0.34f}, 0.05f);
    add_bulb(scene, "blue bulb", {3.1f, 0.06f, 0.55f}, {0.20f, 0.52f, 1.0f}, 0.06f);
    scene.ambient.sky_linear = {0.075f, 0.095f, 0.125f};
    scene.ambient.ground_linear = {0.045f, 0.042f, 0.042f};
}

void add_camera(Scene& scene) {
    // In front and a little above, looking slightly down.
    const SinCos pitch = sin_cos(-7.0 * (kPi / 180.0));
    const auto c = static_cast<float>(pitch.cos), s = static_cast<float>(pitch.sin);
    Camera camera;
    camera.name = "front";
    camera.world_from_camera = {{{1, 0, 0, 0}, {0, c, s, 0}, {0, -s, c, 0}, {0, 2.35f, 9.6f, 1}}};
    camera.fov_y_rad = static_cast<float>(25.0 * (kPi / 180.0));
    camera.aspect = 16.0f / 9.0f;
    camera.near_z = 0.5f;
    scene.cameras.push_back(camera);
}

}  // namespace

Scene demo_scene() {
    const FpEnvironment environment_of_host;
    Scene scene;
    add_backdrop(scene);
    add_balls(scene);
    add_plinth(scene);
    add_trefoil(scene);
    add_lights(scene);
    add_camera(scene);
    return scene;
}

}  // namespace halflit
