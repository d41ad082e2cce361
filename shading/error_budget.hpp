// An error in 8-bit sRGB codes, given beforehand, turned into what a frame may leave out.
//
// The sRGB curve c(v) is concave: light that is left out shows most where nothing else shines, and a part of the light that is off by a
// relative error r is off by at most S(v) r codes with S = dc / d ln v, which grows up to 112 at white. So errors of single parts, each
// as if it were alone, add up to a bound for all of them together, whatever the surface's colour is.
#pragma once

#include "shading/plan.hpp"

#include <vector>

namespace halflit::shading {

/// Largest change of a code when v grows by `delta` >= 0: from black.
[[nodiscard]] double codes_of_absolute(double delta);
/// Largest change of a code when v >= 0 is multiplied by 1 + r or divided by it, r >= 0, and white stays white.
[[nodiscard]] double codes_of_relative(double r);

/// What the shading model cannot know of a scene.
struct SceneFacts {
    std::vector<double> light_strength;  ///< for each of the plan's lights: no surface gets more of it, times its colour; directional: 1
    std::vector<double> light_farthest_squared;  ///< likewise: no surface is farther from it, squared
    std::vector<bool> drawn;             ///< for each of the plan's materials: something is made of it
    bool shadows = false;                ///< shadow maps: what they hide is to stay the same to the last bit
    double vertex_color = 1.0;           ///< the largest channel of all vertex colours
};

/// How much of a budget goes to the environment's bands; the rest is for spend_error_budget.
inline constexpr double kEnvironmentShare = 0.3;

/// Takes the cheapest polynomials, reaches and thresholds whose bounds, with those of float32 itself and of the bands, stay below
/// `budget_codes` for each material, and writes plan.error. Shadows count as the same for all; so do the pixel's visible surfaces. Light
/// once a vertex or a triangle is not bounded.
void spend_error_budget(FramePlan& plan, double budget_codes, double exposure, const SceneFacts& facts);

}  // namespace halflit::shading
