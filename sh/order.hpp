// How many bands are enough: a bound on the error of the truncated series, made from the environment's own bands before anything is drawn.
//
// By the addition theorem a band adds at most |f_l| |L_l| sqrt((2l+1)/(4 pi)) to any normal's value, so dropping the bands from N on costs
// at most B_N = the sum of that over l >= N. Bands 0..63 enter one by one; the rest by the smaller of two estimates, Cauchy and Schwarz's
// inequality on what the 64 bands leave of |L|, and |L_l| <= sqrt((2l+1)/(4 pi)) times the integral of |L|, which is the sharp one for a
// sun.
//
// BandGrid is sharper, because bands seldom reach their largest values at one place: it looks at the sum of the bands N..23 itself, on a
// grid. On every great circle that sum is a trigonometric polynomial of degree 23, and such a polynomial stays above cos(23 d) of its
// maximum within the distance d of it (M. Riesz), so the grid's maximum bounds the maximum. The bands from 24 on are added as above. A sun
// that was left in keeps those large; but of one direction's light no order loses more than the lobe's series is off the lobe, so the
// integral of |L| / pi times that is a third bound, and the smallest holds.
//
// The error of an order is not monotone in N; the first bound is, the others nearly, and they are what the choice goes by.
#pragma once

#include "sh/project.hpp"
#include "sh/zonal.hpp"

namespace halflit::sh {

/// by_order[N - 1]: no normal's value is off by more than this when the bands 0..N-1 are used. In the units of what is reflected by a white
/// surface, (1/pi) integral of L f, channel by channel.
struct OrderBounds {
    std::array<Vec3d, kMaxBands> by_order{};
};

/// From the norms alone.
[[nodiscard]] OrderBounds order_bounds(const Spectrum& environment, const LobeSpectrum& lobe);

/// The values of an environment's bands on a grid, made once for all lobes: 5 MB, 20 ms.
class BandGrid {
public:
    /// Of darkness; holds nothing.
    BandGrid() = default;
    explicit BandGrid(const Projection& environment);

    /// Never above order_bounds() of the norms, and usually half of it.
    [[nodiscard]] OrderBounds order_bounds(const LobeSpectrum& lobe) const;

private:
    Spectrum spectrum_;
    std::vector<Vec3f> values_;  ///< [point][band]
};

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
