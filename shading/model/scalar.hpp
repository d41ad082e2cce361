// The vocabulary's operations (kernels/simd.hpp) for double, so that formulas.hpp can be used outside the kernels.
#pragma once

#include "sh/config.hpp"

namespace halflit {

HALFLIT_INLINE constexpr double vdiv(double a, double b) { return a / b; }
HALFLIT_INLINE constexpr double vmin(double a, double b) { return a < b ? a : b; }
HALFLIT_INLINE constexpr double vmax(double a, double b) { return a > b ? a : b; }
HALFLIT_INLINE constexpr double mad(double a, double b, double c) { return a * b + c; }

}  // namespace halflit

#include "shading/model/constants.hpp"
#include "shading/model/formulas.hpp"

#include <cmath>

namespace halflit::shading {

/// Exponent s of (N.H)^s for a roughness: 2 / roughness^4 - 2. A roughness below kMinRoughness counts as kMinRoughness.
[[nodiscard]] constexpr double specular_exponent(double roughness) { return 2.0 * half_specular_exponent(vmax(roughness, 0.07)); }
static_assert(0.07f == kMinRoughness);

/// Roughness with the exponent s >= 0, the inverse of specular_exponent for s up to 8.3e4.
[[nodiscard]] inline double roughness_of_exponent(double s) { return std::sqrt(std::sqrt(2.0 / (s + 2.0))); }

}  // namespace halflit::shading
