// Normalised associated Legendre functions for 64 bands, for work done once per image. Shading uses the 10 bands of sh/basis.hpp instead.
#pragma once

#include "sh/basis.hpp"
#include "sh/zonal.hpp"

#include <array>

namespace halflit::sh::detail {

inline constexpr int kSpectrumCoefficients = kSpectrumBands * kSpectrumBands;

/// Values p_lm of one order m: p[l - m] for l = m..63. Y_lm = p_lm(z) cos(m phi) and Y_l,-m = p_lm(z) sin(m phi), with the sign convention
/// of sh/basis.hpp.
struct LegendreRow {
    std::array<double, kSpectrumBands> p{};
};

/// Computes all p_lm at z = cos theta; row m of `rows` is order m. Requires: sin_theta >= 0.
void legendre(double cos_theta, double sin_theta, std::array<LegendreRow, kSpectrumBands>& rows);

/// Value of each band in a direction d: the sum over m of c_lm Y_lm(d), for 64 bands and three channels.
void band_values(const Vec3d* coefficients, Vec3d direction, std::array<Vec3d, kSpectrumBands>& values);

}  // namespace halflit::sh::detail
