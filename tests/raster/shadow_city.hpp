// A wide city with one small box, and boxes against rays.
#pragma once

#include "raster/frame_plan.hpp"
#include "tests/raster/box_shadow.hpp"
#include "tests/support/isas.hpp"

#include <cstring>
#include <vector>

namespace halflit::test {

inline const Vec3d kToLight = Vec3d{0.5, 0.7, 0.3} * (1 / std::sqrt(0.83));
inline constexpr double kLampDistance = 700.0;

/// A city of `count` x `count` houses of 10 m on 4 km x 4 km, and a box of one metre at a crossing.
struct City : ShadowSetup {
    Vec3d foot;
    std::vector<Box> boxes;  ///< the box, and the houses near it

    City(int count, LightType type, Vec3d near_to) : ShadowSetup(Lobe::sloan(0), ShadowMode::hard) {
        const double step = 4000.0 / count, half = 0.2 * step < 4.0 ? 0.2 * step : 4.0;
        const auto crossing = [&](double v) { return std::floor(v / step + 0.5) * step; };  // count is even
        foot = {crossing(near_to.x), 0, crossing(near_to.z)};
        add(make_plane(2010, 1));
        add_metre_box(*this, foot);
        boxes.push_back(metre_box(foot));
        Mesh house = make_box(to_float({half, 5, half}));
        house.material = 0;
        scene.meshes.push_back(std::move(house));
        for (int i = 0; i < count; ++i)
            for (int j = 0; j < count; ++j) {
                const Vec3d at{(i - 0.5 * (count - 1)) * step, 5, (j - 0.5 * (count - 1)) * step};
                scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, translation(to_float(at))});
                if (length(at - foot) < 3 * step) boxes.push_back({at - Vec3d{half, 5, half}, at + Vec3d{half, 5, half}});
            }
        Light& light = scene.lights[0];
        light.type = type;
        light.direction_ws = to_float(kToLight * -1.0);
        light.position_ws = to_float(foot + kToLight * kLampDistance);
        light.outer_cone_rad = 1.2f;
        const double strength = type == LightType::directional ? 1.0 : kLampDistance * kLampDistance;
        light.color_linear = Vec3f{1, 1, 1} * static_cast<float>(strength);
        camera = camera_above(foot);
    }
    [[nodiscard]] ShadowArea area() {
        return shadow_area(*this, foot, boxes, kToLight, scene.lights[0].type == LightType::directional ? 0.0 : kLampDistance);
    }
};

inline raster::FramePlan plan_of(const ShadowSetup& setup, int width = kSide, int height = kSide) {
    const auto prepared = raster::PreparedData::make(setup.scene, {});
    REQUIRE(prepared);
    auto plan = plan_frame(*prepared, prepared->scene(), setup.camera, setup.settings, width, height);
    REQUIRE(plan);
    return std::move(*plan);
}

/// Each region by every instruction set, by several numbers of threads and sizes of tiles, has the bits of the whole picture.
inline void check_parts(const City& city, int width, int height, const std::vector<Region>& regions) {
    const std::vector<float> whole = city.draw(width, height);
    int turn = 0;
    for (const Isa isa : available_isas())
        for (const Region& region : regions) {
            INFO(isa_name(isa) << ", region " << region.x << ", " << region.y);
            City part = city;
            part.settings.region = region;
            part.settings.execution.isa = isa;
            part.settings.execution.tile_size = 16 << turn % 3;
            part.settings.execution.threads = 1 + turn++ % 4;
            const std::vector<float> drawn = part.draw(width, height);
            const int right = region.width != 0 ? region.x + region.width : width;
            const int bottom = region.width != 0 ? region.y + region.height : height;
            int wrong = 0;
            for (int y = region.y; y < bottom; ++y)
                for (int x = region.x; x < right; ++x) {
                    const auto at = static_cast<std::size_t>(4 * (y * width + x));
                    wrong += std::memcmp(&drawn[at], &whole[at], 4 * sizeof(float)) != 0;
                }
            CHECK(wrong == 0);
        }
}

/// Boxes that are larger on all sides, or smaller; those that vanish are left out.
inline std::vector<Box> enlarged(const std::vector<Box>& boxes, double by) {
    std::vector<Box> out;
    for (const Box& box : boxes) {
        const Box moved{box.low - Vec3d{by, by, by}, box.high + Vec3d{by, by, by}};
        if (moved.low.x < moved.high.x && moved.low.y < moved.high.y && moved.low.z < moved.high.z) out.push_back(moved);
    }
    return out;
}

}  // namespace halflit::test
