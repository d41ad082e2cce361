// Bounds on the change of an 8-bit sRGB code by errors of light, for single parts of a pixel's light, each as if it were alone.
//
// The sRGB curve c(v) is concave, v being linear light. An absolute error, such as light left out, therefore shows most where nothing else
// shines. A part that is off by a relative error r changes the code by at most S(v) r, with S = dc / d ln v, which grows up to 112 at
// white. So the bounds of single parts add up to a bound for all of them together, whatever the surface's colour is.
#pragma once

#include "sh/power.hpp"
#include "shading/model/srgb.hpp"

#include <algorithm>
#include <array>

namespace halflit::shading {

/// kSlopeAtBlack: d code / d v for v up to kLinearEnd, the end of the curve's straight part.
/// kSlopeAtWhite: d code / d ln v at white, 255 * 1.055 / 2.4, rounded up.
inline constexpr double kSlopeAtWhite = 112.1;
inline constexpr double kSlopeAtBlack = 255.0 * 12.92, kLinearEnd = kSrgbLinearEnd;

/// d code / d v for v > 0; the curve is continued beyond white.
[[nodiscard]] inline double code_slope(double v) {
    return v <= kLinearEnd ? kSlopeAtBlack : (255.0 * 1.055 / 2.4) * power_of(v, 1.0 / 2.4 - 1.0);
}

struct CurvePoint {
    double v, log2_v, slope;
};
/// Points from the end of the curve's straight part to white; v grows by a tenth from one to the next.
[[nodiscard]] const std::array<CurvePoint, 61>& curve_points();

/// The largest f(CurvePoint) for v from the end of the curve's straight part to white. Requires: f does not rise as v falls below this
/// range, and f(1.1 v) < 1.05 f(v) within it. This holds for slope(v) g(v) with g concave, g(0) = 0, and g not decreasing.
template <class Function>
double largest_on_curve(const Function& f) {
    constexpr double kBetween = 1.05;
    double most = 0.0;
    for (const CurvePoint& point : curve_points()) most = std::max(most, f(point));
    return most * kBetween;
}

/// Largest change of a code when v grows by `delta` >= 0; it occurs at black.
[[nodiscard]] double codes_of_absolute(double delta);
/// Largest change of a code when v >= 0 is multiplied by 1 + r or divided by it, r >= 0, with codes clamped at white.
[[nodiscard]] double codes_of_relative(double r);

/// Largest change of a code by highlights v = K e^-z, K = `peak`, whose logarithm is off by `constant` + `linear` z. `count` of them
/// together change it by no more than one of `count` times the peak (concavity).
[[nodiscard]] double codes_of_specular(double peak, int count, double constant, double linear);

}  // namespace halflit::shading
