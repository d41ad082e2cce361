// How far a code moves when light does: bounds in 8-bit sRGB codes for single parts of a pixel's light, each as if it were alone.
//
// The sRGB curve c(v) is concave: light that is left out shows most where nothing else shines, and a part of the light that is off by a
// relative error r is off by at most S(v) r codes with S = dc / d ln v, which grows up to 112 at white. So errors of single parts add up
// to a bound for all of them together, whatever the surface's colour is.
#pragma once

#include "sh/power.hpp"
#include "shading/model/srgb.hpp"

#include <algorithm>
#include <array>

namespace halflit::shading {

/// d code / d v for v up to kLinearEnd, where the curve leaves its straight part.
inline constexpr double kSlopeAtBlack = 255.0 * 12.92, kLinearEnd = kSrgbLinearEnd;

/// d code / d v for v > 0; beyond white as if the curve went on.
[[nodiscard]] inline double code_slope(double v) {
    return v <= kLinearEnd ? kSlopeAtBlack : (255.0 * 1.055 / 2.4) * power_of(v, 1.0 / 2.4 - 1.0);
}

struct CurvePoint {
    double v, log2_v, slope;
};
/// From the end of the curve's straight part to white, v growing by a tenth from one to the next.
[[nodiscard]] const std::array<CurvePoint, 61>& curve_points();

/// The largest f(CurvePoint) for v from the end of the curve's straight part to white. Below, f must only fall, and from v to
/// 1.1 v it must grow by less than a twentieth: so do slope(v) times anything concave that is 0 at 0 and does not fall.
template <class Function>
double largest_on_curve(const Function& f) {
    constexpr double kBetween = 1.05;
    double most = 0.0;
    for (const CurvePoint& point : curve_points()) most = std::max(most, f(point));
    return most * kBetween;
}

/// Largest change of a code when v grows by `delta` >= 0: from black.
[[nodiscard]] double codes_of_absolute(double delta);
/// Largest change of a code when v >= 0 is multiplied by 1 + r or divided by it, r >= 0, and white stays white.
[[nodiscard]] double codes_of_relative(double r);

/// v = A t^n off by t's error. Lights with A_1, A_2.. together are off by no more than one with their sum (Hoelder's inequality).
[[nodiscard]] double codes_of_edge(double amplitude, double n, double t_error);

/// Highlights v = K e^-z whose logarithm is off by `constant` + `linear` z + `root` sqrt(z). `count` of them together are off by no more
/// than one of `count` times the peak (concavity, and Cauchy and Schwarz's inequality for the root).
[[nodiscard]] double codes_of_specular(double peak, int count, double constant, double linear, double root);

}  // namespace halflit::shading
