// Zonal bands of the wrap family f(x; w, n) = scale max(0, (x + w)/(1 + w))^n, x = N.L, with P_l the Legendre polynomials:
//     f_l = 2 * integral of f(x) P_l(x) over [-w, 1].
// This is the band factor of [SNY11] with the 1/pi inside: the reflected light is the sum of f_l L_lm Y_lm(N). Lambert has
// {1, 2/3, 1/4, 0, -1/24, 0, ..}, the A_l / pi of [RH01].
//
// differs: [SNY11] prints polynomials for two members up to band 5; the last lacks a factor (a+7) in its denominator. One recurrence serves
// every w and n here and is as accurate:
//     f_0 = 2 (1+w)/(n+1),  g_l = f_l/f_0,  g_{-1} = g_0 = 1,  (l+n+2) g_{l+1} = (n+1-l) g_{l-1} - (2l+1) w g_l.
// Its error stays below 3 eps f_0 for 33 bands. For large l, |g_l| falls like l^-(n + 3/2).
#pragma once

#include "sh/coefficients.hpp"

namespace halflit::sh {

/// A member of the family, in double. wrap in [0, 1], power >= 0.
struct WrapLobe {
    double wrap = 0.0;
    double power = 1.0;
    double scale = 1.0;
    bool operator==(const WrapLobe&) const = default;
};

/// The scale that makes f_0 = 1: every sky of constant radiance then looks as bright as with Lambert. [McA13]
constexpr double normalizing_scale(double wrap, double power) { return (power + 1.0) / (2.0 * (1.0 + wrap)); }

/// Number of bands that error bounds take one by one; the bands beyond are bounded together.
inline constexpr int kSpectrumBands = 64;

/// A lobe's bands, and bounds on the rest. For powers up to 1/2 the sum of the rest diverges: tail_sum is infinite.
struct LobeSpectrum {
    std::array<double, kSpectrumBands> f{};
    double tail_norm = 0.0;               ///< sqrt of the sum of f_l^2 (2l+1)/(4 pi) over l >= kSpectrumBands
    double tail_sum = 0.0;                ///< sum of |f_l| (2l+1)/(4 pi) over l >= kSpectrumBands
    double slope = 0.0;                   ///< bound on |df/dtheta|; infinite for powers below 1
    std::array<double, kMaxBands> sup{};  ///< [N - 1]: bound on |f less its bands 0..N-1| at any angle; infinite for powers below 1
};

/// Bands 0..9, scale included. Bands below 8 eps f_0 are set to 0, so that Valve's lobe is recognised as order 3 and Green's w = 1 as
/// order 2.
[[nodiscard]] BandFactors zonal_bands(const WrapLobe& lobe);

[[nodiscard]] LobeSpectrum lobe_spectrum(const WrapLobe& lobe);

}  // namespace halflit::sh
