// The vocabulary's operations (kernels/simd.hpp) for double, so that formulas.hpp can be used outside the kernels.
#pragma once

#include "sh/config.hpp"

namespace halflit {

HALFLIT_INLINE constexpr double vdiv(double a, double b) { return a / b; }
HALFLIT_INLINE constexpr double vmin(double a, double b) { return a < b ? a : b; }
HALFLIT_INLINE constexpr double vmax(double a, double b) { return a > b ? a : b; }
HALFLIT_INLINE constexpr double mad(double a, double b, double c) { return a * b + c; }

}  // namespace halflit

#include "shading/model/formulas.hpp"
