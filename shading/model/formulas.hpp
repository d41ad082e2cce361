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

/// Factor that makes sharper highlights brighter, from h = s / 2. Phong: (s + 8) / 8 = (p + 2) / 2 of p = s / 4, with which a mirror that
/// faces the light reflects all of it. Blinn: all would be (s + 2)(s + 4) / (8 (2^(-s/2) + s)); this is at most 2.9 % less, and never more:
/// (s^2 + 10 s + 32) / (8 (s + 4)) = (h + 3) / 4 + 1 / (2 (h + 2)).
template <class T>
HALFLIT_INLINE constexpr T specular_normalization(T half_exponent, bool phong) {
    if (phong) return mad(T(0.25f), half_exponent, T(1.0f));
    return mad(T(0.25f), half_exponent, T(0.75f)) + vdiv(T(0.5f), half_exponent + T(2.0f));
}

/// Schlick's rise towards grazing views, of one minus a cosine.
template <class T>
HALFLIT_INLINE constexpr T fifth_power(T x) {
    const T x2 = x * x;
    return (x2 * x2) * x;
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
