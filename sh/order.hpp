// Choice of the number of bands: a bound on the error of the truncated series, computed from the environment's own bands before anything is
// drawn.
//
// L is the environment's radiance, |L_l| the norm of its band l, f_l the band of the lobe. By the addition theorem a band adds at most
// |f_l| |L_l| sqrt((2l+1)/(4 pi)) at any normal. Dropping the bands from N on therefore costs at most B_N, the sum of this over l >= N.
// Bands 0..63 enter one by one. The rest enters by the smaller of two estimates: Cauchy and Schwarz's inequality with the norm of L beyond
// the 64 bands, and |L_l| <= sqrt((2l+1)/(4 pi)) times the integral of |L|, which is the sharp one for a sun.
//
// BandGrid gives smaller bounds, because the bands seldom reach their largest values at the same normal. It evaluates the sum of the bands
// N..23 on a grid. On every great circle this sum is a trigonometric polynomial of degree 23. Within the distance d of its maximum such a
// polynomial stays above cos(23 d) times the maximum (M. Riesz), so the largest value on the grid bounds the maximum. The bands from 24 on
// are added as above. They are large where a sun was left in. A third bound helps there: light from one direction is off by at most the
// largest difference between the lobe and its series, so all light is off by at most that times the integral of |L| / pi. The smallest
// bound holds.
//
// The error may grow from one order to the next. B_N never grows with N, and the bounds of BandGrid hardly ever do. The order is chosen by
// these bounds.
#pragma once

#include "sh/project.hpp"
#include "sh/zonal.hpp"

namespace halflit::sh {

/// by_order[N - 1]: bound on the error at any normal when the bands 0..N-1 are used, channel by channel. Unit: light reflected by a white
/// surface, (1/pi) integral of L f.
struct OrderBounds {
    std::array<Vec3d, kMaxBands> by_order{};
    Vec3d beyond;  ///< bound on the error when all kSpectrumBands bands are used
};

/// Bounds B_N from the norms alone.
[[nodiscard]] OrderBounds order_bounds(const Spectrum& environment, const LobeSpectrum& lobe);

/// Values of an environment's bands on a grid, made once for all lobes: 5 MB, 20 ms.
class BandGrid {
public:
    /// The grid of a black environment; empty.
    BandGrid() = default;
    explicit BandGrid(const Projection& environment);

    /// Bounds that never exceed sh::order_bounds() and are usually half as large.
    [[nodiscard]] OrderBounds order_bounds(const LobeSpectrum& lobe) const;

private:
    Spectrum spectrum_;
    std::vector<Vec3f> values_;  ///< [point][band]
};

struct OrderChoice {
    int order = kMaxBands;  ///< bands, 1..10
    double bound = 0.0;     ///< bound on the error, worst channel
    bool within = false;    ///< the bound is within the tolerance; false only at order 10
};

/// The smallest order whose bound is at most `tolerance` times `scale` in every channel. The scale says what the tolerance is relative to.
/// With 1 it is absolute. With 1/exposure it is relative to display white: half an 8-bit code in linear light is then 1/510. With the
/// output's mean, f_0 times the mean radiance, it is a relative error.
[[nodiscard]] OrderChoice pick_order(const OrderBounds& bounds, double tolerance, double scale = 1.0);

[[nodiscard]] inline double largest(Vec3d v) {
    const double xy = v.x > v.y ? v.x : v.y;
    return xy > v.z ? xy : v.z;
}

}  // namespace halflit::sh
