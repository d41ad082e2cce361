// Values of a lobe for one directional light, and the error when its series is cut after N bands. For reports and tests: it uses the C
// library's pow, so nothing here may reach a pixel.
#pragma once

#include "sh/zonal.hpp"

namespace halflit::sh {

/// f(x; w, n) times its scale; 0 for x <= -w, whatever the power.
[[nodiscard]] double lobe_value(const WrapLobe& lobe, double x);

/// The series of f cut after `bands` bands, at x: the sum of (2l+1)/4 f_l P_l(x), P_l the Legendre polynomials. bands in 0..10.
[[nodiscard]] double series_value(const BandFactors& f, int bands, double x);

/// df/dx at x = -w from above: 0 for powers above 1, infinite below 1.
[[nodiscard]] double slope_at_boundary(const WrapLobe& lobe);

struct TruncationError {
    double l2 = 0.0;   ///< sqrt of the integral over the sphere of (f - f_N)^2
    double sup = 0.0;  ///< largest |f - f_N|
    double min = 0.0;  ///< smallest f_N; negative where the series rings
};

[[nodiscard]] TruncationError truncation_error(const WrapLobe& lobe, int bands);

}  // namespace halflit::sh
