// Windows over bands, against the ringing of a truncated series [Sloan08]. None is applied by default: for wrapped lobes at order 3 Hann's
// window triples the error and makes the most negative value more negative still (Lambert: -.040 becomes -.047). Taking the sun out
// (sh/sun.hpp) removes the cause of the ringing; use dering() where that is not enough.
#pragma once

#include "sh/coefficients.hpp"

namespace halflit::sh {

/// (1 + cos(pi l / width)) / 2 below l = width, 0 from there on. width >= 1; `bands` is the usual choice.
[[nodiscard]] BandFactors hann_window(double width);

/// sin(pi l / width) / (pi l / width) below l = width, 0 from there on.
[[nodiscard]] BandFactors lanczos_window(double width);

/// 1 / (1 + lambda l^2 (l+1)^2): least squares with a penalty on the squared Laplacian [Sloan08].
[[nodiscard]] BandFactors laplacian_window(double lambda);

struct Deringed {
    RadianceSh sh;
    double lambda = 0.0;  ///< 0: no window was needed
};

/// Applies the weakest Laplacian window with which no channel goes below `floor` in 8,192 directions. `floor` is an absolute value below
/// the mean; a channel whose mean is below it is left out of the search. Use this on reflected light, which is radiance times the lobe's
/// bands.
[[nodiscard]] Deringed dering(const RadianceSh& sh, double floor = 0.0);

}  // namespace halflit::sh
