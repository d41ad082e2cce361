// Vectors of doubles, as the parts outside the kernels use them.
#pragma once

#include "halflit/math.hpp"

namespace halflit {

HALFLIT_INLINE constexpr Vec3d to_double(Vec3f v) { return {v.x, v.y, v.z}; }
HALFLIT_INLINE constexpr Vec3f to_float(Vec3d v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

HALFLIT_INLINE constexpr double absolute(double x) { return x < 0 ? -x : x; }
HALFLIT_INLINE constexpr Vec3d absolute(Vec3d v) { return {absolute(v.x), absolute(v.y), absolute(v.z)}; }

}  // namespace halflit
