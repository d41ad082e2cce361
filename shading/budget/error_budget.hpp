// An error in 8-bit sRGB codes, given beforehand, turned into what a frame may leave out.
#pragma once

#include "shading/budget/power_fit.hpp"
#include "shading/budget/shares.hpp"
#include "shading/plan/plan.hpp"

#include <vector>

namespace halflit::shading {

/// What the shading model cannot know of a scene.
struct SceneFacts {
    std::vector<double>
        light_attenuation;  ///< for each of the plan's lights: no surface gets more of it, as a share of its colour; directional: 1
    std::vector<double> light_farthest_squared;  ///< likewise: no surface is farther from it, squared
    std::vector<bool> drawn;                     ///< for each of the plan's materials: something is made of it
    double vertex_color = 1.0;                   ///< the largest channel of all vertex colours
    double largest_uv = 0.0;                     ///< the largest texture coordinate; needed where a texture's are transformed
};

/// Takes the cheapest polynomials, cutoff radii and thresholds whose bounds, with those of float32 itself and of the bands, stay below
/// `budget_codes` for each material, and writes plan.error. Shadows count as the same for all; so do the pixel's visible surfaces. Light
/// once a vertex or a triangle is not bounded. Fits are looked up in `fits`, and made where they are not there.
void spend_error_budget(ShadingPlan& plan, double budget_codes, double exposure, const SceneFacts& facts, PowerFits& fits);

}  // namespace halflit::shading
