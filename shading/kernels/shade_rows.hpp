// Rows passed between the stages of shading a block.
#pragma once

#include "shading/fragment_block.hpp"
#include "shading/kernels/vector.hpp"
#include "shading/plan/material_plan.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Rows passed between the stages, one value a lane. Rows that the material does not need are not set.
struct alignas(64) ShadeRows {
    using Row = float[shading::kBlockSize];
    using Row3 = Row[3];
    Row3 base, emitted;
    Row alpha;
    Row3 texel;  ///< of the normal map
    Row metallic, roughness, occlusion;
    Row3 normal, surface, to_eye;      ///< unit: with the normal map, without it; towards the viewer
    Row half_exponent, normalization;  ///< of highlights
    Row3 diffuse, specular;            ///< light through the lobe, its scale included; highlights, before the reflectance
    Row3 specular_grazing;             ///< of GGX: highlights times (1 - V.H)^5; `specular` has them times the rest
    Row3 ambient, mirrored;            ///< light of the surroundings towards the normal and the reflected view, times occlusion
    Row grazing;                       ///< (1 - N.V)^5; without an environment
    Row share_a, share_b, share_more;  ///< sky_share's, with an environment
    Row3 dielectric;                   ///< F0 where not metallic; with kStageSpecularColor
    Row specular_weight;               ///< factor of what is mirrored at grazing views there; with kStageSpecularColor
    Row transmitted;                   ///< share of the light that enters the surface which passes through; of materials that transmit
    Row3 layers;                       ///< light of the layers above the base, which is added to the base's
    Row passed_layers;                 ///< share of light from below that passes through all of them
    Row passed_coat;                   ///< share of the base's light that passes through a coat; with kStageClearcoat
    Row film_share, film_r0;           ///< share of the surface below a thin film; (n - 1) / (n + 1) of the film; with kStageIridescence
    Row film_outer, film_grazing;      ///< what the film's outer side reflects; (1 - cos)^5 at its inner side
    Row film_schlick;                  ///< (1 - N.V)^5, N.V from kLeastFilmCosine
    Row3 film_once, film_twice;        ///< how light that went through the film once, or twice, interferes
    Row3 along;                        ///< unit, in the plane of the normal: the direction of a brushed surface; with kStageAnisotropy
    Row alpha_along, alpha_across;     ///< widths of its facets; `roughness` is that of their geometric mean
    Row3 passed;                       ///< share of that light which is not absorbed
    Row thickness;                     ///< of the body below the surface, world units; 0 at the back face of a double-sided one
};
HALFLIT_INLINE V3 load3(const ShadeRows::Row3& rows, int lane) {
    return {load(rows[0] + lane), load(rows[1] + lane), load(rows[2] + lane)};
}
HALFLIT_INLINE void store3(ShadeRows::Row3& rows, int lane, V3 v) {
    store(rows[0] + lane, v.x);
    store(rows[1] + lane, v.y);
    store(rows[2] + lane, v.z);
}

/// Stages that add to the row `layers`, from the lowest layer to the highest.
inline constexpr Stage kLayerOrder[] = {kStageDiffuseTransmission, kStageSheen, kStageClearcoat};
inline constexpr std::uint32_t kLayerStages = [] {
    std::uint32_t stages = 0;
    for (const Stage stage : kLayerOrder) stages |= stage;
    return stages;
}();
constexpr std::uint32_t layers_below(Stage stage) {
    std::uint32_t stages = 0;
    for (const Stage* below = kLayerOrder; *below != stage; ++below) stages |= *below;
    return stages;
}
/// Adds a layer's light, and lets a share of that of the layers below it pass.
template <Stage kStage>
HALFLIT_INLINE void lay(const shading::MaterialPlan& material, ShadeRows& rows, int lane, V3 light, F passed) {
    if ((material.stages & layers_below(kStage)) != 0) light = light + load3(rows.layers, lane) * passed;
    store3(rows.layers, lane, light);
}

/// Takes a share from the light that reaches the base at a lane: what it reflects is linear in these rows.
HALFLIT_INLINE void dim_base(const shading::MaterialPlan& material, ShadeRows& rows, int lane, F left) {
    const auto dim = [&](ShadeRows::Row3 & light) __attribute__((always_inline)) { store3(light, lane, load3(light, lane) * left); };
    if ((material.stages & kStageLights) != 0) {
        dim(rows.diffuse);
        dim(rows.specular);
        if (material.ggx) dim(rows.specular_grazing);
    }
    if ((material.stages & kStageAmbient) != 0) {
        dim(rows.ambient);
        dim(rows.mirrored);
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
