// The angle of a direction in the plane, in double from + - * / alone, for the reason that sh/trig.hpp gives.
#pragma once

#include "sh/trig.hpp"

namespace halflit {

/// atan2(y, x) in [-pi, pi], error below 1e-14; (0, 0) gives 0.
HALFLIT_INLINE double angle_of(double y, double x) {
    const double ax = x < 0 ? -x : x, ay = y < 0 ? -y : y;
    const double low = ax < ay ? ax : ay, high = ax < ay ? ay : ax;
    if (!(high > 0)) return 0.0;
    // atan t = pi/8 + atan r, |r| <= tan(pi/8) = 0.414; the series' first dropped term is below 2e-15.
    constexpr double kTan = 0.41421356237309504880;  // sqrt(2) - 1
    const double t = low / high, r = (t - kTan) / (1.0 + t * kTan), s = r * r;
    double p = 1.0 / 33.0;
    for (int k = 31; k >= 3; k -= 2) p = 1.0 / k - s * p;
    const double octant = kPi / 8 + (r - r * (s * p));
    const double quadrant = ax < ay ? 0.5 * kPi - octant : octant;
    const double half = x < 0 ? kPi - quadrant : quadrant;
    return y < 0 ? -half : half;
}

/// atan(t) for t >= 0, infinity included.
HALFLIT_INLINE double arc_tangent(double t) { return t <= 1.0 ? angle_of(t, 1.0) : angle_of(1.0, 1.0 / t); }

}  // namespace halflit
