// Error budgets: turns a largest difference from the exact picture, in 8-bit sRGB codes, into work that a frame may leave out.
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
    double worth_texels = 1e300;  ///< the largest number of texels that are worth reading: more cost more than a budget can save
    bool read_texels = false;     ///< texels are read for their least values; false: they may be 0
};

/// How many surfaces add their errors to a pixel's at most: 2 behind glass that blurs or bends, which looks at a picture of what is behind.
/// 0: there may be any number, of panes of clear glass; or a ground that shows what shadows hide, whose alpha is a quotient.
[[nodiscard]] double surfaces_in_a_pixel(const ShadingPlan& plan, const SceneFacts& facts);
/// Texels of the textures of materials that are drawn.
[[nodiscard]] double texels_of(const ShadingPlan& plan, const SceneFacts& facts);

/// The curve by which a material's highlights are as good as exact; null: there is none.
[[nodiscard]] const SpecularFit* exact_highlight(const ShadingPlan& plan, const MaterialPlan& material, PowerFits& fits);

/// Turns the exact plan into a cheaper one whose picture differs from the exact one by at most `budget_codes`, after the tone curve of
/// `costs`: polynomials, cutoff radii, thresholds and light in cells. The bands of plan.environments have been chosen, and their bound is
/// part of plan.error, which this writes. A plan from which nothing can be left out within the budget is not changed; its error is 0.
/// Returns false if the bands alone exceed the budget. Fits are looked up in `fits`, and added there where missing.
[[nodiscard]] bool spend_error_budget(ShadingPlan& plan, double budget_codes, const CodeCosts& costs, double exposure,
                                      const SceneFacts& facts, PowerFits& fits);

}  // namespace halflit::shading
