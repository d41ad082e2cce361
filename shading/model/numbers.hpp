// Tests and clamps for numbers from users, which may be NaN or infinite.
#pragma once

#include "halflit/math.hpp"

namespace halflit::shading {

[[nodiscard]] constexpr bool finite(float x) { return x - x == 0.0f; }
[[nodiscard]] constexpr bool finite(Vec3f v) { return finite(v.x) && finite(v.y) && finite(v.z); }
[[nodiscard]] constexpr bool finite(double x) { return x - x == 0.0; }
[[nodiscard]] constexpr bool finite(Vec3d v) { return finite(v.x) && finite(v.y) && finite(v.z); }
[[nodiscard]] constexpr bool zero(Vec3f v) { return v.x == 0.0f && v.y == 0.0f && v.z == 0.0f; }

/// max(lo, min(x, hi)); NaN gives lo.
[[nodiscard]] constexpr float clamp_or_low(float x, float lo, float hi) { return x > lo ? (x < hi ? x : hi) : lo; }

}  // namespace halflit::shading
