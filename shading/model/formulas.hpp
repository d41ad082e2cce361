// Formulas of the shading model over a number type T: lanes of floats in the kernels, double in bounds and plans. T's operations vdiv, vmax
// and mad must be declared before this is included: scalar.hpp for double, kernels/simd.hpp for lanes. The order of operations is the
// kernels' order, bit for bit. The float64 reference has its own copy of the formulas, so that it can show when one is wrong.
#pragma once

#include "sh/config.hpp"

namespace halflit {

/// Half the exponent s of (N.H)^s, s = 2 / roughness^4 - 2, for a roughness that is at least kMinRoughness.
template <class T>
HALFLIT_INLINE constexpr T half_specular_exponent(T roughness) {
    const T alpha = roughness * roughness;
    return vdiv(T(1.0f), alpha * alpha) - T(1.0f);
}

/// Factor (s + 8) / 8 from s / 2: makes sharper highlights brighter.
template <class T>
HALFLIT_INLINE constexpr T specular_normalization(T half_exponent) {
    return mad(T(0.25f), half_exponent, T(1.0f));
}

/// Share of the surroundings that a surface reflects: F0 seen straight on, rising towards 1 - roughness at grazing angles. `grazing` is
/// Schlick's fifth power, (1 - N.V)^5.
template <class T>
HALFLIT_INLINE constexpr T environment_reflectance(T f0, T roughness, T grazing) {
    return mad(vmax(T(1.0f) - roughness, f0) - f0, grazing, f0);
}

/// Factor that takes a local light to zero at the end of its range: max(0, 1 - (d / range)^4), from (d / range)^2.
template <class T>
HALFLIT_INLINE constexpr T range_window(T in_range_squared) {
    return vmax(T(1.0f) - in_range_squared * in_range_squared, T(0.0f));
}

}  // namespace halflit
