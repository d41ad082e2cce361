// How many bands are enough: a bound on the error of the truncated series, made from the environment's own bands before anything is drawn.
//
// By the addition theorem a band adds at most |f_l| |L_l| sqrt((2l+1)/(4 pi)) to any normal's value, so dropping the bands from N on costs
// at most B_N = the sum of that over l >= N. Bands 0..63 enter one by one; the rest by the smaller of two estimates, Cauchy and Schwarz's
// inequality on what the 64 bands leave of |L|, and |L_l| <= sqrt((2l+1)/(4 pi)) times the integral of |L|, which is the sharp one for a
// sun. The error of an order is not monotone in N (Lambert at order 4 is order 3); the bound is, and it is what the choice goes by.
#pragma once

#include "sh/project.hpp"
#include "sh/zonal.hpp"

namespace halflit::sh {

/// by_order[N - 1]: no normal's value is off by more than this when the bands 0..N-1 are used. In the units of what is reflected by a white
/// surface, (1/pi) integral of L f, channel by channel.
struct OrderBounds {
    std::array<Vec3d, kMaxBands> by_order{};
};

[[nodiscard]] OrderBounds order_bounds(const Spectrum& environment, const LobeSpectrum& lobe);

struct OrderChoice {
    int order = kMaxBands;  ///< bands, 1..10
    double bound = 0.0;     ///< of its error, the worst channel
    bool within = false;    ///< whether that is within the tolerance; false only at order 10
};

/// The smallest order whose bound, in every channel, is at most `tolerance` times `scale`. The scale says what the tolerance is a part of:
/// with 1 it is absolute; with 1/exposure, a part of display white, so that half an 8-bit code in linear light is 1/510; with the output's
/// mean, f_0 times mean radiance, a relative error.
[[nodiscard]] OrderChoice pick_order(const OrderBounds& bounds, double tolerance, double scale = 1.0);

[[nodiscard]] inline double largest(Vec3d v) {
    const double xy = v.x > v.y ? v.x : v.y;
    return xy > v.z ? xy : v.z;
}

}  // namespace halflit::sh
