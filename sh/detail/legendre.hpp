// Normalised associated Legendre functions to 64 bands, for what is done once per image. The 10 bands that shading uses: sh/basis.hpp.
#pragma once

#include "sh/basis.hpp"
#include "sh/zonal.hpp"

#include <array>

namespace halflit::sh::detail {

inline constexpr int kSpectrumCoefficients = kSpectrumBands * kSpectrumBands;

/// Row (m): the values p_lm for l = m..63 at l - m. Y_lm = p_lm(z) * (cos or sin of m phi), the sign convention of sh/basis.hpp.
struct LegendreRow {
    std::array<double, kSpectrumBands> p{};
};

/// All p_lm at z = cos theta, given sin theta >= 0.
void legendre(double cos_theta, double sin_theta, std::array<LegendreRow, kSpectrumBands>& rows);

/// The value of each band's zonal sum at a direction: sum over m of c_lm Y_lm(d), for 64 bands and three channels.
void band_values(const Vec3d* coefficients, Vec3d direction, std::array<Vec3d, kSpectrumBands>& values);

}  // namespace halflit::sh::detail
