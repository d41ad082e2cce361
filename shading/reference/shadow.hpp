// Reference for shadows in float64: the hidden share of a light, from the shadow map that the kernels read, written in the plainest way.
#pragma once

#include "halflit/lobe.hpp"
#include "halflit/math.hpp"
#include "shading/plan/plan.hpp"

namespace halflit::shading::reference {

/// Hidden shares of a light, in [0, 1]. Both are exact except for the float32 distances of the map.
struct Hidden {
    double hard = 0;  ///< share of light that a shadow cuts off
    double soft = 0;  ///< share of light that fades with the blocker's distance; `hard` where nothing fades
    /// Distance of the receiver to the nearest jump of a share, world units: a texel's distance, the rim of the map, another face of the
    /// cube. If it is less than the rounding error, a look-up in float32 may decide otherwise.
    double margin = 0;
};

/// Hidden shares of a light at a surface point, from `map` or the coarser ones that follow it. `surface_normal` and `to_light` are unit
/// vectors. `material` gives the distance over which wrapped light fades in shadows.
[[nodiscard]] Hidden hidden_share(const ShadowMapPlan& map, Vec3d position, Vec3d surface_normal, Vec3d to_light,
                                  const MaterialPlan& material, ShadowMode mode);

/// The lobe at x = N.L under a shadow, its scale included: f - hard core - soft excess. Highlights are multiplied by 1 - hard.
[[nodiscard]] double shadowed_lobe(const Lobe& lobe, double x, const Hidden& hidden, ShadowMode mode);

}  // namespace halflit::shading::reference
