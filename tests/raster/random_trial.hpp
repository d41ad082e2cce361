// Random scenes for tests of promised errors: lobes, lights, skies, normal maps.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/mesh.hpp"
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "shading/environment.hpp"

#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

namespace halflit::raster::test {

inline constexpr int kTrialWidth = 64, kTrialHeight = 48;

class Numbers {
public:
    explicit Numbers(std::uint32_t seed) : engine_(seed) {}
    float in(float low, float high) { return low + (high - low) * static_cast<float>(engine_() >> 8) * 0x1p-24f; }
    std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_()) % n; }
    /// Number from low to high whose logarithm is evenly distributed.
    float decades(float low, float high) { return std::pow(10.0f, in(std::log10(low), std::log10(high))); }
    Vec3f color(float brightness) { return {brightness * in(0.2f, 1), brightness * in(0.2f, 1), brightness * in(0.2f, 1)}; }

private:
    std::mt19937 engine_;
};

inline Lobe some_lobe(Numbers& make) {
    switch (make.below(7)) {
        case 0:
            return Lobe::lambert();
        case 1:
            return Lobe::green(make.in(0, 1));
        case 2:
            return Lobe::valve();
        case 3:
            return Lobe::sloan(0.5f);
        case 4:
            return Lobe::mcauley(make.in(0, 1), make.in(1, 5));
        default:
            return Lobe::sloan(make.in(0, 1));
    }
}

/// A normal map of slopes up to some 30 degrees.
inline Texture bumps(Numbers& make) {
    constexpr int kSize = 32;
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < kSize * kSize; ++i) {
        const float x = make.in(-0.5f, 0.5f), y = make.in(-0.5f, 0.5f), z = std::sqrt(1 - x * x - y * y);
        for (const float c : {x, y, z}) rgba.push_back(static_cast<std::uint8_t>(std::lround((c * 0.5f + 0.5f) * 255.0f)));
        rgba.push_back(255);
    }
    return *Texture::from_rgba8(rgba, kSize, kSize, ColorSpace::linear);
}

inline std::shared_ptr<const Environment> some_sky(Numbers& make) {
    constexpr int kSkyWidth = 32, kSkyHeight = 16;
    const float sun = make.below(2) == 0 ? make.decades(1, 1000) : 0.0f, level = make.decades(0.05f, 2);
    const std::uint32_t at = make.below(kSkyWidth * kSkyHeight / 2);
    std::vector<float> rgb;
    for (std::uint32_t i = 0; i < kSkyWidth * kSkyHeight; ++i) {
        const float up = 1.0f - static_cast<float>(i / kSkyWidth) / kSkyHeight;
        const float l = level * (0.3f + up) + (i == at ? sun : 0.0f);
        rgb.insert(rgb.end(), {l, l * 1.1f, l * 1.3f});
    }
    return std::make_shared<Environment>(shading::make_environment({kSkyWidth, kSkyHeight, rgb}, {make.below(2) == 0, 0.3, false, true}));
}

struct Trial {
    Scene scene;
    Camera camera;
    Settings settings;
};

/// Floor with three bodies: lobes, 1 to 64 lights of all kinds, skies, normal maps, intensities over eight powers of ten.
inline Trial random_trial(std::uint32_t seed) {
    Numbers make(seed);
    Trial t;
    Scene& scene = t.scene;
    const bool bumpy = make.below(4) == 0;
    if (bumpy) scene.textures.push_back(bumps(make));
    for (int i = 0; i < 4; ++i) {
        Material material;
        const Vec3f c = make.color(1);
        material.base_color = {c.x, c.y, c.z, 1};
        material.metallic = make.below(4) == 0 ? make.in(0, 1) : 0.0f;
        material.roughness = make.in(0.15f, 1);
        if (make.below(3) == 0) material.dielectric_reflectance = make.in(0, 1);
        material.lobe = some_lobe(make);
        material.has_own_lobe = true;
        if (bumpy && i == 1) material.textures[TextureSlot::normal].texture = 0;
        scene.materials.push_back(material);
    }
    Mesh bodies[] = {make_plane(6, 4), make_sphere(1, 24, 16), make_torus(1, 0.4f, 24, 12), make_box({0.7f, 0.7f, 0.7f})};
    const Vec3f places[] = {{0, -1, 0}, {-1.6f, 0, 0}, {1.4f, 0, 0.3f}, {0, 0.1f, -1.7f}};
    for (int i = 0; i < 4; ++i) {
        bodies[i].material = i;
        if (bumpy) generate_tangents(bodies[i], 0);
        scene.meshes.push_back(bodies[i]);
        Instance instance{i, {}};
        instance.world_from_object.c[3] = {places[i].x, places[i].y, places[i].z, 1};
        scene.instances.push_back(instance);
    }
    const std::uint32_t count = make.below(3) == 0 ? 1 + make.below(64) : 1 + make.below(6);
    const float brightness = (make.below(8) == 0 ? make.decades(1e-4f, 1e4f) : make.in(0.3f, 2)) / std::sqrt(static_cast<float>(count));
    for (std::uint32_t i = 0; i < count; ++i) {
        Light light;
        light.type = static_cast<LightType>(make.below(3));
        light.color_linear = make.color(brightness * (light.type == LightType::directional ? 1.0f : 6.0f));
        light.position_ws = {make.in(-6, 6), make.in(1.5f, 6), make.in(-6, 6)};
        light.direction_ws = {make.in(-1, 1), -1, make.in(-1, 1)};
        light.range = make.below(2) == 0 ? 0.0f : make.in(3, 12);
        light.source_radius = 0.05f;
        light.outer_cone_rad = make.in(0.3f, 1.4f);
        light.inner_cone_rad = light.outer_cone_rad * make.in(0, 0.9f);
        light.cone_power = make.below(3) == 0 ? make.in(0, 20) : 0.0f;
        scene.lights.push_back(light);
    }
    if (make.below(5) == 0) {
        scene.environment = some_sky(make);
        for (Material& material : scene.materials) material.lobe = scene.materials[0].lobe;  // the reference takes a second each
    } else if (make.below(2) == 0) {
        scene.ambient = {make.color(0.4f), make.color(0.2f)};
    }
    t.camera = frame_scene(scene, static_cast<float>(kTrialWidth) / kTrialHeight, {});
    t.settings.shading.specular = static_cast<SpecularModel>(make.below(3));
    t.settings.shadows = make.below(4) == 0 ? ShadowMode::soft_split : ShadowMode::off;
    t.settings.shadow_size = 128;
    t.settings.background_linear = {0, 0, 0, 1};
    if (make.below(4) == 0) t.settings.exposure = make.decades(0.1f, 10);
    return t;
}

}  // namespace halflit::raster::test
