// Tone curves in float64, written from their publications, for tests and for accuracy reference.
#pragma once

#include "halflit/math.hpp"
#include "halflit/shading.hpp"
#include "sh/vec3d.hpp"

namespace halflit::shading::reference {

/// Display light in [0, 1] of linear light after exposure. Channels below 0 and NaN count as 0; infinity is white.
[[nodiscard]] Vec3d toned(ToneCurve curve, Vec3d light);

}  // namespace halflit::shading::reference
