// Error budgets: turns a largest error in 8-bit sRGB codes, given beforehand, into work that a frame may leave out.
#pragma once

#include "shading/budget/power_fit.hpp"
#include "shading/budget/shares.hpp"
#include "shading/model/code_costs.hpp"
#include "shading/plan/plan.hpp"

#include <vector>

namespace halflit::shading {

/// Facts about a scene that the shading model cannot know.
struct SceneFacts {
    std::vector<double> light_attenuation;       ///< upper bound on the attenuation at any surface, for each planned light; directional: 1
    std::vector<double> light_farthest_squared;  ///< upper bound on the squared distance to any surface, for each planned light
    std::vector<bool> drawn;                     ///< true for each planned material of which an object is made
    double vertex_color = 1.0;                   ///< the largest channel of all vertex colours
    bool measure_rounding = true;                ///< of texels to 16 bits; false: the most that it may be is taken, at no cost
    double largest_uv = 0.0;                     ///< the largest texture coordinate; needed where texture coordinates are transformed
};

/// False if a budget is surely exceeded, by the cheapest facts: the light of the environments, and glass that blurs or bends.
[[nodiscard]] bool may_keep(const ShadingPlan& plan, double budget_codes, const SceneFacts& facts);

/// Chooses the cheapest polynomials, cutoff radii and thresholds whose bounds, with those of float32 and of the bands, stay below
/// `budget_codes` for each material, after the tone curve of `costs`. Writes plan.error. Shadows and the visible surfaces of a pixel are
/// taken as given, and so is that no material is looked through (may_keep). Light that is computed once a vertex or a triangle has no
/// bound. Fits are looked up in `fits`, and added there where missing.
void spend_error_budget(ShadingPlan& plan, double budget_codes, const CodeCosts& costs, double exposure, const SceneFacts& facts,
                        PowerFits& fits);

}  // namespace halflit::shading
