// Layers above a surface, coats and sheen: what they reflect, as bounds, and the codes that their roundings and textures cost.
#pragma once

#include "shading/budget/surface_bounds.hpp"

namespace halflit::shading {

/// A coat as a metal of the coat's roughness and normals, whose colour is the share that is coated; of materials with kStageClearcoat.
[[nodiscard]] MaterialPlan coat_as_metal(const MaterialPlan& material);
[[nodiscard]] Surface coat_surface(const ShadingPlan& plan, const MaterialPlan& material, const SceneFacts& facts);
/// Error of the share that a coat lets through; coat: coat_surface().
[[nodiscard]] Factor passed_by_coat(const MaterialPlan& material, const Surface& coat);

/// Sheen, as bounds; of materials with kStageSheen.
struct SheenSurface {
    double most;                      ///< largest sheen of a light of colour 1
    double color;                     ///< largest channel
    double exponent;                  ///< 1 / a of the smoothest fibres
    double nodes;                     ///< error of a place in the table
    Factor roughness, texture, left;  ///< texture: of the colour; left: share of the base's light
};
[[nodiscard]] SheenSurface sheen_surface(const MaterialPlan& material, double normal_error, const SceneFacts& facts);

/// Costs that all layers of a material add.
struct LayerCosts {
    double codes = 0;      ///< roundings and textures
    double reflected = 0;  ///< largest light reflected, per light of colour 1
};
/// s: the surface below; reflections: of the plan's map; null: there is none.
[[nodiscard]] LayerCosts layer_costs(const CodeCosts& costs, const ShadingPlan& plan, const MaterialPlan& material, const Surface& s,
                                     const Arriving& light, const ReflectionSteps* reflections, double exposure, const SceneFacts& facts);

}  // namespace halflit::shading
