// Random scenes for tests that change a scene in a way that its picture must not show, and the comparison of such pictures.
#pragma once

#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "tests/raster/random_geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace halflit::raster::test {

/// Everything that a picture is made of.
struct Shot {
    Scene scene;
    Camera camera;
    Settings settings;
};

inline constexpr int kViewWidth = 97, kViewHeight = 75;  // neither a multiple of a tile

struct Pixels {
    std::vector<std::uint8_t> rgba8 = std::vector<std::uint8_t>(4 * kViewWidth * kViewHeight, 0xCD);
    std::vector<float> linear = std::vector<float>(4 * kViewWidth * kViewHeight, -123.0f);
    std::vector<float> depth = std::vector<float>(kViewWidth * kViewHeight, -5.0f);
    std::uint64_t visible = 0, fragments = 0;

    [[nodiscard]] Target target() {
        return {.width = kViewWidth, .height = kViewHeight, .pixels = rgba8.data(), .linear = linear.data(), .depth = depth.data()};
    }
};

inline Pixels draw(const Shot& shot, Renderer& renderer, const Execution& execution = {.threads = 1}) {
    Pixels pixels;
    const auto report = renderer.render(shot.scene, shot.camera, shot.settings, pixels.target(), execution);
    if (!report) throw std::runtime_error(report.error().message);
    pixels.visible = report->pixels_visible;
    pixels.fragments = report->fragments_shaded;
    return pixels;
}

inline Pixels draw(const Shot& shot, const Execution& execution = {.threads = 1}) {
    Renderer renderer;
    return draw(shot, renderer, execution);
}

/// Pixels of which any bit differs. Depth counts unless the world has another scale.
inline int differing(const Pixels& a, const Pixels& b, bool with_depth = true) {
    int count = 0;
    for (std::size_t i = 0; i < a.depth.size(); ++i)
        count += std::memcmp(&a.rgba8[4 * i], &b.rgba8[4 * i], 4) != 0 || std::memcmp(&a.linear[4 * i], &b.linear[4 * i], 16) != 0 ||
                 (with_depth && std::memcmp(&a.depth[i], &b.depth[i], 4) != 0);
    return count;
}

/// Sphere or box that fits into the unit sphere, with everything that its material may ask for.
inline Mesh random_body(Random& random, int material) {
    Mesh mesh = random.chance(0.6) ? make_sphere_of(1, random.integer(40, 900))
                                   : make_box({random.real32(0.2, 0.57), random.real32(0.2, 0.57), random.real32(0.2, 0.57)});
    generate_tangents(mesh, 0);
    if (random.chance(0.3))
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            mesh.colors.push_back({random.real32(0.2, 1), random.real32(0.2, 1), random.real32(0.2, 1), 1});
    mesh.material = material;
    return mesh;
}

inline Texture random_texture(Random& random, ColorSpace space) {
    constexpr int kSize = 16;
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < kSize * kSize; ++i) {
        // As a normal map: slopes up to 45 degrees.
        for (int c = 0; c < 2; ++c)
            rgba.push_back(static_cast<std::uint8_t>(space == ColorSpace::srgb ? random.index(256) : 64 + random.index(128)));
        rgba.push_back(static_cast<std::uint8_t>(space == ColorSpace::srgb ? random.index(256) : 220));
        rgba.push_back(static_cast<std::uint8_t>(random.index(256)));
    }
    return *Texture::from_rgba8(rgba, kSize, kSize, space);
}

inline Material random_material(Random& random) {
    Material material;
    material.base_color = {random.real32(0.1, 1), random.real32(0.1, 1), random.real32(0.1, 1), 1};
    material.metallic = random.chance(0.3) ? random.real32(0, 1) : 0.0f;
    material.roughness = random.real32(0.2, 1);
    if (random.chance(0.2)) material.emissive = {random.real32(0, 0.3), 0, random.real32(0, 0.3)};
    if (random.chance(0.5)) material.textures[TextureSlot::base_color].texture = 0;
    if (random.chance(0.2)) material.textures[TextureSlot::normal].texture = 1;
    if (random.chance(0.2)) material.alpha_mode = AlphaMode::mask;
    material.unlit = random.chance(0.05);
    material.lobe = random.chance(0.3)   ? Lobe::lambert()
                    : random.chance(0.5) ? Lobe::sloan(random.real32(0, 1))
                                         : Lobe::green(random.real32(0, 1));
    return material;
}

inline Light random_light(Random& random) {
    Light light;
    light.type = static_cast<LightType>(random.index(3));
    const float bright = light.type == LightType::directional ? 0.5f : 8.0f;
    light.color_linear = Vec3f{random.real32(0.2, 1), random.real32(0.2, 1), random.real32(0.2, 1)} * bright;
    light.position_ws = {random.real32(-5, 5), random.real32(2, 6), random.real32(-5, 5)};
    light.direction_ws = normalize_or({random.real32(-1, 1), -1, random.real32(-1, 1)}, {0, -1, 0});
    light.range = random.chance(0.5) ? 0.0f : random.real32(4, 12);
    light.source_radius = 0.0625f;
    light.outer_cone_rad = random.real32(0.3, 1.4);
    light.inner_cone_rad = light.outer_cone_rad * random.real32(0, 0.9);
    return light;
}

inline Settings random_settings(Random& random) {
    Settings settings;
    static constexpr std::array<int, 4> kSamples = {1, 4, 8, 16};
    settings.samples = kSamples[static_cast<std::size_t>(random.index(4))];
    settings.background_linear = {0.1f, 0.2f, 0.3f, random.chance(0.5) ? 1.0f : 0.0f};
    settings.shadows = static_cast<ShadowMode>(random.index(3));
    settings.shadow_size = 128;
    // Otherwise it comes from the size of the largest object, which is another one where a mesh is split.
    settings.shadow_fade = 0.75f;
    settings.shadow_terminator_offset = random.chance(0.3);
    settings.shading.specular = static_cast<SpecularModel>(random.index(4));
    if (random.chance(0.3)) settings.shading.rate = static_cast<ShadingRate>(random.index(3));
    return settings;
}

/// Convex closed bodies without double sides, apart from each other and from the floor below them, seen from outside. So the order of
/// opaque triangles cannot matter: of one body a ray meets one front face, and the faces of two bodies that it meets are at least their gap
/// of 0.1 apart, 10^4 times what rounding moves a depth. A triangle of the floor meets no other one of it but at edges, where each sample
/// belongs to one of the two.
inline Shot separate_bodies(std::uint64_t seed) {
    Random random(seed);
    Shot shot;
    Scene& scene = shot.scene;
    scene.textures = {random_texture(random, ColorSpace::srgb), random_texture(random, ColorSpace::linear)};
    for (int i = 0; i < 4; ++i) scene.materials.push_back(random_material(random));
    for (int i = 0; i < 4; ++i) scene.meshes.push_back(random_body(random, random.index(5) - 1));
    scene.meshes.push_back(make_plane(5, 6));
    scene.meshes.back().material = 3;
    generate_tangents(scene.meshes.back(), 0);
    constexpr float kCell = 2.1f;
    for (int x = -1; x <= 1; ++x)
        for (int y = 0; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z) {
                if (random.chance(0.5)) continue;
                const float size = random.real32(0.4, 1);
                const Vec3f at{kCell * static_cast<float>(x), kCell * static_cast<float>(y), kCell * static_cast<float>(z)};
                scene.instances.push_back({random.index(4), translation(at) * random_rotation(random) * scaling({size, size, size})});
            }
    scene.instances.push_back({4, translation({0, -1.1f, 0})});
    for (auto lights = random.integer(1, 6); lights > 0; --lights) scene.lights.push_back(random_light(random));
    if (random.chance(0.7)) scene.ambient = {{0.1f, 0.15f, 0.2f}, {0.05f, 0.04f, 0.03f}};
    // Above the floor and outside of the bodies.
    shot.camera =
        frame_scene(scene, static_cast<float>(kViewWidth) / kViewHeight,
                    {.azimuth_deg = random.real32(-180, 180), .elevation_deg = random.real32(5, 60), .zoom = random.real32(1, 2)});
    shot.settings = random_settings(random);
    return shot;
}

}  // namespace halflit::raster::test
