// The meaning of shadows in float64: the hidden share of a light from the same map as the kernels read, written the plain way.
#pragma once

#include "sh/vec3.hpp"
#include "shading/lobe.hpp"
#include "shading/plan/plan.hpp"

namespace halflit::shading::reference {

/// Shares of a light that are hidden, in [0, 1]. Both are exact but for the float32 distances of the map.
struct Hidden {
    double hard = 0;  ///< cut off
    double soft = 0;  ///< of light that fades with the blocker's distance; `hard` where nothing fades
    /// How far the receiver is from where a share jumps, world units: from a texel's distance, the rim of the map, another face of the
    /// cube. Nearer than its own rounding, a look-up in float32 may decide otherwise.
    double margin = 0;
};

/// `map`'s distances as seen from a point whose surface has that unit normal; `to_light` is a unit vector. `material` says over what
/// distance shadows on wrapped light fade.
[[nodiscard]] Hidden hidden_share(const ShadowMapPlan& map, Vec3d position, Vec3d surface_normal, Vec3d to_light,
                                  const MaterialPlan& material, ShadowMode mode);

/// The lobe at x = N.L under a shadow, its scale included: f - hard core - soft excess. Highlights keep 1 - hard of theirs.
[[nodiscard]] double shadowed_lobe(const Lobe& lobe, double x, const Hidden& hidden, ShadowMode mode);

}  // namespace halflit::shading::reference
