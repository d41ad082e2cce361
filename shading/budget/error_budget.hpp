// Error budgets: turns a largest error in 8-bit sRGB codes, given beforehand, into work that a frame may leave out.
#pragma once

#include "shading/budget/power_fit.hpp"
#include "shading/budget/shares.hpp"
#include "shading/budget/texture_bounds.hpp"
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
    TexelFacts texels;
    double worth_texels = 1e300;  ///< the largest number of texels that are worth reading: more cost more than a budget can save
};

/// True if glass that blurs or bends is drawn: what lies behind is another picture, with errors of its own, which have no bound.
[[nodiscard]] bool looks_through(const ShadingPlan& plan, const SceneFacts& facts);
/// False if a budget is surely exceeded, by the cheapest facts: the light of the environments, and glass.
[[nodiscard]] bool may_keep(const ShadingPlan& plan, double budget_codes, const SceneFacts& facts);
/// Texels of all levels of the textures of materials that are drawn.
[[nodiscard]] double texels_of(const ShadingPlan& plan, const SceneFacts& facts);

/// The curve by which a material's highlights are as good as exact; null: there is none.
[[nodiscard]] const SpecularFit* exact_highlight(const ShadingPlan& plan, const MaterialPlan& material, PowerFits& fits);

/// Chooses the cheapest polynomials, cutoff radii and thresholds whose bounds, with those of float32 and of the bands, stay below
/// `budget_codes` for each material, after the tone curve of `costs`. Writes plan.error. Shadows and the visible surfaces of a pixel are
/// taken as given, and so is that no material is looked through. Light that is computed once a vertex or a triangle has no
/// bound. Fits are looked up in `fits`, and added there where missing. A budget of 0 changes nothing, so that plan.error is the bound of
/// the exact plan, with curves of exact_highlight().
void spend_error_budget(ShadingPlan& plan, double budget_codes, const CodeCosts& costs, double exposure, const SceneFacts& facts,
                        PowerFits& fits);

}  // namespace halflit::shading
