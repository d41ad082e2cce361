// Bounds on the light that reaches a surface and that it reflects, and the error of float32 and of textures that follows from them.
#pragma once

#include "shading/budget/error_budget.hpp"
#include "shading/budget/reflection_bounds.hpp"

namespace halflit::shading {

/// A factor of some light: its error, absolute and as a share of its least value.
struct Factor {
    double absolute = 0, relative = 0;
};

/// `least`: of the factor.
[[nodiscard]] Factor factor_of(double error, double least);
/// Codes that the factor's error costs: the light is the factor times at most `strength`.
[[nodiscard]] double codes_of(const CodeCosts& costs, const Factor& factor, double strength);

/// Upper bounds on what a surface reflects, and the errors of its inputs. Members for which there is no texture have no error.
struct Surface {
    double albedo, reflectance;      ///< largest colour; largest F0
    double metallic;                 ///< largest
    double exponent, normalization;  ///< those of the sharpest highlight
    double least_roughness;
    double least_albedo = 0;          ///< smallest colour that diffuse light is multiplied by; 0: not known
    double reflectance_at_least = 0;  ///< F0 of that colour
    double normal_error;
    Factor base_color, roughness, diffuse, shiny, occlusion,
        emissive;        ///< diffuse: 1 - metallic; shiny: F0, by the metallic texture's error
    Factor dielectric;   ///< F0 where not metallic, by textures of its own
    Factor scattered;    ///< share of the light that enters which does not pass through
    Factor passed;       ///< share of all light that a coat lets through
    Factor below_sheen;  ///< share of the base's light that sheen leaves
    bool specular;

    [[nodiscard]] double cosine_error() const;  ///< of N.L
};

[[nodiscard]] Surface surface_of(const ShadingPlan& plan, const MaterialPlan& material, const SceneFacts& facts);

/// Upper bounds on the light that reaches a surface, in units of display white.
struct Arriving {
    double sum = 0, largest = 0;  ///< sum and largest of the lights' colours times attenuation
    double cone_error = 0;        ///< largest error of a spot's cosine, as a share of its cone's width
    int count = 0, local = 0;
};

[[nodiscard]] Arriving arriving(const ShadingPlan& plan, double exposure, const SceneFacts& facts);

/// True if a shadow may cut the lobe's core off and leave its excess (ShadowMode::soft_split). The excess is nearly black where lobe and
/// core are close, so an error of the lobe shows most there.
[[nodiscard]] bool may_split(const ShadingPlan& plan, const MaterialPlan& material);

/// Codes by which the share of diffuse light that sky shadows leave is wrong: by its sums' roundings, and by weights that change with the
/// normal, no faster than a lobe's slope, or the grid's. most: of that light.
[[nodiscard]] double sky_share_codes(const CodeCosts& costs, const ShadingPlan& plan, const MaterialPlan& material, double normal_error,
                                     double most);

/// Codes that cannot be chosen: roundings, and the errors of textures. reflections: of the plan's map; null: there is none.
[[nodiscard]] double rounding_codes(const CodeCosts& costs, const MaterialPlan& material, const ShadingPlan& plan, const Surface& s,
                                    const Arriving& light, const ReflectionSteps* reflections, double exposure);

}  // namespace halflit::shading
