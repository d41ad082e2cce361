// Lights as the kernels read them.
#pragma once

#include "halflit/light.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace halflit::shading {

/// A light as a kernel sees it.
struct LightPlan {
    LightType type;
    std::int32_t source;  ///< index into the lights that were planned
    float color[3];
    float position[3];
    float to_light[3];               ///< directional: unit vector towards the light; spot: minus the axis
    float inv_range_squared;         ///< 1 / range^2; 0: no limit
    float min_distance_squared;      ///< source radius squared
    float cone_cutoff;               ///< spot: 1 - cos(outer angle)
    std::int32_t shadow_map = -1;    ///< index into ShadingPlan::shadow_maps; -1: casts no shadow
    float cone_scale;                ///< spot: 1 / (cos(inner) - cos(outer)); see kernels/light_kernel.hpp
    float half_cone_power;           ///< spot: half the power of the cosine; 0: none
    float cutoff_squared;            ///< point, spot: squared distance from which on the light is left out; 0: no limit but the range
    float brightness;                ///< the largest channel of the colour
    float shadow_radius = 0;         ///< Light::shadow_radius; 0: none
    std::int32_t shadow_points = 1;  ///< points of the light that maps are looked up for, of which some may have none
};

/// Plans lights in list order; black lights and those not finite are left out. A point or spot light so far away that float32 cannot hold
/// the square of its distance becomes a directional one.
[[nodiscard]] std::vector<LightPlan> plan_lights(std::span<const Light> lights);

}  // namespace halflit::shading
