// Upper bounds on the light that reaches a surface and on what it reflects. What a cheaper computation may cost follows from them.
#pragma once

#include "shading/budget/error_budget.hpp"

namespace halflit::shading {

struct Surface {
    double albedo = 0, reflectance = 0;      ///< largest colour; largest F0
    double exponent = 0, normalization = 1;  ///< those of the sharpest highlight
    double least_albedo = 0;                 ///< smallest colour that diffuse light is multiplied by; 0: not known
    double reflectance_at_least = 0;         ///< F0 of that colour
    double layers = 0;                       ///< what a coat and sheen reflect of a light of colour 1
    bool specular = false;
};

[[nodiscard]] Surface surface_of(const ShadingPlan& plan, const MaterialPlan& material, const SceneFacts& facts);

/// Upper bounds on the light that reaches a surface, in units of display white.
struct Arriving {
    double sum = 0, largest = 0;  ///< sum and largest of the lights' colours times attenuation
    int count = 0, local = 0;
};

[[nodiscard]] Arriving arriving(const ShadingPlan& plan, double exposure, const SceneFacts& facts);

/// True if a shadow may cut the lobe's core off and leave its excess (ShadowMode::soft_split). The excess is nearly black where lobe and
/// core are close, so an error of the lobe shows most there.
[[nodiscard]] bool may_split(const ShadingPlan& plan, const MaterialPlan& material);

}  // namespace halflit::shading
