// A surface at the origin under directional lights or a sky, shaded by the kernels: what tests of single stages need.
#pragma once

#include "sh/vec3d.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/planner.hpp"
#include "tests/sh/sky_images.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace halflit::testing {

inline Vec3d unit(Vec3d v) { return v * (1 / std::sqrt(dot(v, v))); }
/// A direction at an angle from +z, in radians, turned about it from +x.
inline Vec3d at_angle(double from_normal, double turn = 0) {
    return {std::sin(from_normal) * std::cos(turn), std::sin(from_normal) * std::sin(turn), std::cos(from_normal)};
}

/// Bright panels in a dark room, a horizon, and smooth noise; grey. Twice as wide as high.
inline std::array<test::Sky, 3> three_skies(int height) {
    const auto grey = [](double v) { return Vec3d{v, v, v}; };
    const auto panel = [](Vec3d d, Vec3d at, double size) {
        return std::clamp((dot(d, unit(at)) - std::cos(size * 1.1)) / (std::cos(size) - std::cos(size * 1.1)), 0.0, 1.0);
    };
    const auto sky = [&](const auto& radiance) {
        return test::painted_sky(2 * height, height, [&](Vec3d d) { return grey(radiance(d)); });
    };
    return {sky([&](Vec3d d) {
                return 0.1 + 12 * panel(d, {1, 1, 1}, 0.35) + 6 * panel(d, {-1, 0.5, 0.4}, 0.25) + 4 * panel(d, {0, 1, -0.3}, 0.5);
            }),
            sky([](Vec3d d) { return d.y > 0 ? 1 + d.y : 0.2; }),
            sky([](Vec3d d) { return 1 + 0.9 * std::sin(5 * d.x + 2 * d.y) * std::cos(7 * d.z - d.x); })};
}

/// The sky's radiance of the pixel that a direction is in.
inline double radiance_at(const test::Sky& sky, Vec3d d) {
    const sh::EquirectPoint p = sh::equirect_point(d);
    return sky.view()
        .at(std::min(sky.width - 1, static_cast<int>(p.u * sky.width)), std::min(sky.height - 1, static_cast<int>(p.v * sky.height)))
        .x;
}

/// The surface has a normal and a tangent.
struct SurfaceBench {
    Material material;
    std::vector<Texture> textures;
    std::vector<Light> lights;
    Ambient ambient;
    std::shared_ptr<const Environment> environment;
    ShadingSettings options;
    Vec3d normal{0, 0, 1}, tangent{1, 0, 0};

    void add_light(Vec3d to_light, double color = 1) {
        lights.push_back({.color_linear = to_float({color, color, color}), .direction_ws = to_float(to_light * -1.0)});
    }
    void set_sky(const test::Sky& sky) {
        EnvironmentOptions keep;
        keep.extract_suns = false;
        environment = std::make_shared<Environment>(shading::make_environment(sky.view(), keep));
        memory_ = std::make_shared<shading::PlanMemory>();
    }
    /// The same radiance from everywhere.
    void set_sky(double radiance) {
        set_sky(test::painted_sky(64, 32, [&](Vec3d) { return Vec3d{radiance, radiance, radiance}; }));
    }
    /// A linear texture of one texel.
    int add_texel(double r, double g, double b, double a = 1) {
        const auto code = [](double v) { return static_cast<std::uint16_t>(std::lround(v * 65535)); };
        const std::uint16_t texel[] = {code(r), code(g), code(b), code(a)};
        textures.push_back(Texture::from_rgba16(texel, 1, 1).value());
        return static_cast<int>(textures.size()) - 1;
    }
    [[nodiscard]] shading::ShadingPlan plan() const {
        const std::vector<shading::SlotMask> slots{7u, 7u};
        shading::PlanMemory own;
        return shading::plan_shading({.materials = {&material, 1},
                                      .textures = textures,
                                      .available_slots = slots,
                                      .lights = shading::plan_lights(lights),
                                      .ambient = ambient,
                                      .options = options,
                                      .environment = environment},
                                     memory_ ? *memory_ : own);
    }
    [[nodiscard]] Vec3d seen_from(Vec3d to_eye, Isa isa = Isa::scalar) const {
        shading::ShadingPlan frame = plan();
        return seen_from(to_eye, isa, frame);
    }
    /// `frame` is plan()'s, of which only the eye is changed.
    Vec3d seen_from(Vec3d to_eye, Isa isa, shading::ShadingPlan& frame) const {
        using namespace shading;
        frame.orthographic = true;
        frame.view_direction_ws = to_float(to_eye * -1.0);
        FragmentBlock block{};
        const Vec3f n = to_float(normal), t = to_float(tangent);
        for (int lane = 0; lane < kBlockSize; ++lane) {
            block.lane[kNormalX][lane] = n.x, block.lane[kNormalX + 1][lane] = n.y, block.lane[kNormalX + 2][lane] = n.z;
            block.lane[kTangentX][lane] = t.x, block.lane[kTangentX + 1][lane] = t.y, block.lane[kTangentX + 2][lane] = t.z;
            block.lane[kTangentW][lane] = 1, block.lane[kFacing][lane] = 1;
        }
        shade_kernels(isa).shade(frame, frame.materials[0], all_lights(frame), block, kBlockSize);
        return {block.red[0], block.green[0], block.blue[0]};
    }

private:
    std::shared_ptr<shading::PlanMemory> memory_;
};

}  // namespace halflit::testing
