// Materials as the kernels read them: stages, attribute slots, textures, lobe.
#pragma once

#include "halflit/material.hpp"
#include "halflit/shading.hpp"
#include "shading/fragment_block.hpp"
#include "shading/model/reflection_tables.hpp"
#include "shading/plan/lobe_plan.hpp"
#include "shading/plan/texture_plan.hpp"

#include <cstdint>
#include <span>

namespace halflit::shading {

/// Curve for (cos^2)^(s/2): p(cos^2) squared `squarings` times, p(x) = c[0] + c[1] x + .. (power_fit.hpp).
struct SpecularCurve {
    static constexpr int kMostTerms = 8, kFewTerms = 4;
    std::int32_t squarings = -1;     ///< -1: no curve; the power is computed by log2 and exp2
    std::int32_t terms = kFewTerms;  ///< kFewTerms, or kMostTerms
    float c[kMostTerms] = {};
    float least = 1;  ///< least cos^2 with a highlight; below it there is none
};

/// Stages of materials whose light is never fitted over cells: it does not follow from the mesh's normals alone, or is seen through others.
inline constexpr std::uint32_t kStagesWithoutCells =
    kStageNormalMap | kStageTransmission | kStageClearcoat | kStageSheen | kStageAnisotropy | kStageDiffuseTransmission;

/// Largest error of the light of a cell (light_cell.hpp), as light through the lobe, before its scale.
struct CellTolerance {
    float relative = 0, absolute = 0;  ///< share of the light, and light; 0: this material's light is never fitted
    /// Error that a highlight left out counts for, as a share of it, or 0 where the albedo may be black; then highlights left out may be
    /// absolute_specular together.
    float specular_ratio = 0, absolute_specular = 0;
    float half_exponent = 0, peak = 0;  ///< of the widest highlight; normalisation of the sharpest
};

/// Transmission as planned; used with kStageTransmission, as its textures are.
struct TransmissionPlan {
    float share = 0;
    float passed[3] = {1, 1, 1};    ///< share of light that is not absorbed, without a texture of thickness
    float absorbed[3] = {0, 0, 0};  ///< -log2 of it where the texture of thickness is 1
    /// Light from behind is blurred or bent: it comes from ShadingPlan::behind and the surroundings.
    bool looked_through = false;
    bool disperses = false;            ///< light of different colours is bent differently
    float inverse_ior[3] = {1, 1, 1};  ///< 1 / index of refraction, by channel
    float blur = 0;                    ///< per roughness: min(1, 2 (index - 1))
    float thickness = 0;               ///< of the body below, world units
};

/// A coat as planned; used with kStageClearcoat.
struct ClearcoatPlan {
    float factor = 0, roughness = 0, normal_scale = 1;
    bool normal_roughness = false;  ///< as MaterialPlan's, of the coat's own normal texture
};

/// Sheen as planned; used with kStageSheen.
struct SheenPlan {
    float color[3] = {0, 0, 0};
    float roughness = 0;
};

/// A thin film as planned; used with kStageIridescence.
struct IridescencePlan {
    float factor = 0, ior = 1;
    float thickness_nm = 0, thickness_range_nm = 0;  ///< without a texture; by which a texture of 1 exceeds it
};

/// A brushed surface as planned; used with kStageAnisotropy.
struct AnisotropyPlan {
    float strength = 0, cosine = 1, sine = 0;  ///< of the direction from the tangent
};

/// Diffuse transmission as planned; used with kStageDiffuseTransmission.
struct DiffuseTransmissionPlan {
    float share = 0;
    float color[3] = {1, 1, 1};
};

/// kReflectionShapes between two of its rows, at a material's one roughness.
struct MirrorRow {
    bool at_one_roughness = false;           ///< false: the roughness differs from fragment to fragment, and the rest is not set
    float values[7][kReflectionNodes] = {};  ///< by the order of ReflectionShape's numbers
};
[[nodiscard]] MirrorRow mirror_row(float roughness);

struct MaterialPlan {
    std::uint32_t stages = 0;  ///< bits of Stage; a block runs only these
    SlotMask slots = 0;        ///< vertex slots that raster interpolates
    float base_color[4] = {1, 1, 1, 1};
    float metallic = 0, roughness = 1;
    float dielectric = 0.04f, refracted = 0.96f;        ///< F0 where not metallic; 1 - F0, which the diffuse part gets
    float dielectric_color[3] = {0.04f, 0.04f, 0.04f};  ///< with kStageSpecularColor: F0 where not metallic, before its limit of 1
    float specular_weight = 1;  ///< with kStageSpecularColor: factor of that, and of what is mirrored at grazing views
    float emissive[3] = {0, 0, 0};
    float normal_scale = 1, occlusion_strength = 1;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    LobePlan lobe;
    PowTier specular_tier = PowTier::exact;
    /// A light's highlight, before the reflectance, is left out where it is surely below this. 0: only where it is exactly 0.
    float specular_threshold = 0;
    SpecularCurve specular_curve;
    bool ggx = false;  ///< highlights of lights are SpecularModel::ggx
    CellTolerance cells;
    /// 1 / d0, d0 in world units: a blocker at the distance d0 or more hides all wrapped light. 0: no fading; shadows cut wrapped light
    /// off.
    float shadow_fade_scale = 0;
    /// Factor of -N.L that gives a body's own thickness towards the light, as a share of d0, where it turns away from the light. The body
    /// does not shade itself within that thickness.
    float shadow_turn_scale = 0;
    int environment = -1;                          ///< index into ShadingPlan::environments
    int reflection_lobes = 0;                      ///< lobes by which the environment's reflections are taken, 0 to 2; 0: there are none
    MirrorRow mirror;                              ///< of those reflections
    bool normal_roughness = false;                 ///< minified normals make the surface rougher: their texture was made so
    bool occlusion_is_metallic_roughness = false;  ///< both read the same texels the same way: one fetch serves both
    BySlot<TexturePlan> textures;
    TransmissionPlan transmission;
    ClearcoatPlan clearcoat;
    SheenPlan sheen;
    IridescencePlan iridescence;
    AnisotropyPlan anisotropy;
    DiffuseTransmissionPlan diffuse_transmission;
};

/// True if the roughness may differ from fragment to fragment.
[[nodiscard]] inline bool roughness_varies(const MaterialPlan& material) {
    return (material.stages & (kStageMetallicRoughnessTexture | kStageAnisotropy)) != 0 || material.normal_roughness;
}

/// Kinds of light in the frame, which decide what a material needs.
struct LightKinds {
    bool lights = false, ambient = false, specular = false;
};

/// Plans a material. `available`: attribute slots that its meshes have; what the meshes lack is left out of the plan.
[[nodiscard]] MaterialPlan plan_material(const Material& material, std::span<const Texture> textures, SlotMask available,
                                         const LightKinds& kinds, const ShadingSettings& options);

}  // namespace halflit::shading
