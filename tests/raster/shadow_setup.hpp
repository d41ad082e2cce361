// White diffuse surface under one light of colour 1, so that a pixel is V f(N.L): V the visibility of the light, f the lobe.
#pragma once

#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/setup.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <cstring>

namespace halflit::test {

inline constexpr int kWidth = 1024, kHeight = 4;
inline constexpr float kRadians = 0.0174532925f;  // pi / 180

struct ShadowSetup {
    Scene scene;
    Camera camera;
    halflit::test::Setup settings;

    /// Light from +x; the camera looks along -z, at right angles to it: x in the picture is N.L on a unit sphere.
    explicit ShadowSetup(const Lobe& lobe, ShadowMode mode) {
        Material clay;
        clay.metallic = 0;
        clay.lobe = lobe;
        clay.has_own_lobe = true;
        scene.materials.push_back(clay);
        scene.lights.push_back({});
        scene.lights[0].direction_ws = {-1, 0, 0};
        settings.shading.specular = SpecularModel::none;
        settings.shadows = mode;
        settings.shadow_size = 2048;
        camera = camera_flat(static_cast<float>(kHeight) / kWidth);
        camera.half_width = 1.0f;
    }
    void add(Mesh mesh, const Mat4& place = {}) {
        mesh.material = 0;
        scene.meshes.push_back(std::move(mesh));
        scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, place});
    }
    [[nodiscard]] std::vector<float> draw(int width = kWidth, int height = kHeight) const {
        std::vector<float> rgba(static_cast<std::size_t>(4 * width * height));
        const auto report = render(scene, camera, settings, {width, height, nullptr, rgba.data()}, settings.execution);
        REQUIRE(report);
        CHECK(report->nan_pixels == 0);
        return rgba;
    }
};

inline int differing(const std::vector<float>& a, const std::vector<float>& b) {
    REQUIRE(a.size() == b.size());
    int count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) count += std::memcmp(&a[i], &b[i], sizeof(float)) != 0;
    return count;
}

/// Value of the lobe at N.L = 0, where the surface turns away from the light.
inline double boundary_value(const Lobe& lobe) {
    return static_cast<double>(lobe.scale()) * std::pow(lobe.wrap / (1.0 + lobe.wrap), static_cast<double>(lobe.power));
}

}  // namespace halflit::test
