// What a material requires, as plain data that the kernels read: attributes, textures, lobe path, lights. What the scene does
// not need is not in the plan, and what is not in the plan is not computed.
#pragma once

#include "shading/plan/accuracy.hpp"
#include "shading/plan/environment_plan.hpp"
#include "shading/kernels/fragment_block.hpp"
#include "shading/light.hpp"
#include "shading/material.hpp"
#include "shading/shadow.hpp"
#include "shading/texture.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace halflit::shading {

/// A texture as a kernel sees it. Texel (x, y) of level l: data + 4 * (offset[l] + y * width[l] + x).
struct TexturePlan {
    const std::uint16_t* data = nullptr;  ///< null: not used
    const TextureRange* range = nullptr;  ///< for bounds alone
    std::int32_t level_count = 0;
    std::int32_t width[kMaxTextureLevels], height[kMaxTextureLevels], offset[kMaxTextureLevels];
    float row_u[3], row_v[3];  ///< texture transform
    std::int32_t uv_set = 0;
    bool transform = false;  ///< row_u, row_v are not the identity
    bool needs_lod = false;  ///< the kDu.. rows decide which level or which filter
    Wrap wrap_u, wrap_v;
    Filter mag, min;
    MipFilter mip;
};

/// How t^n is computed, t = max(0, (x + w) / (1 + w)); the cheapest form that is within 2 ulp for this n, or, for an error budget, a
/// curve: t times a polynomial in sqrt(t) (power_fit.hpp).
enum class LobePath : std::uint8_t { step, linear, square, sqrt_product, integer, general, curve };
inline constexpr int kLobeCurveTerms = 6;

struct LobePlan {
    LobePath path = LobePath::linear;
    float wrap = 0;
    float inv_one_plus_wrap = 1;  ///< 1 / (1 + w), rounded so that (1 + w) times it is not below 1: t(1) = 1 after the clamp
    float scale = 1;
    std::int32_t integer_power = 1;  ///< path integer: n, 3 to 5
    float power_minus_one = 0;       ///< path general: n - 1, and the same in two parts of 18 and 6 bits (pow.hpp)
    float power_minus_one_high = 0, power_minus_one_low = 0;
    PowTier tier = PowTier::exact;  ///< path general
    float curve[kLobeCurveTerms] = {};  ///< path curve
};

/// (cos^2)^(s/2) as p(cos^2) squared so many times, p(x) = ((c[3] x + c[2]) x + c[1]) x + c[0] (power_fit.hpp).
struct SpecularCurve {
    std::int32_t squarings = -1;  ///< -1: none, the power is taken by log2 and exp2
    float c[4] = {};
    float least = 1;  ///< of cos^2; where it is smaller there is no highlight
};

/// Stages, one bit each; a block runs only those that its material's plan names.
enum Stage : std::uint32_t {
    kStageBaseColorTexture = 1u << 0,
    kStageVertexColor = 1u << 1,
    kStageNormalMap = 1u << 2,
    kStageMetallicRoughnessTexture = 1u << 3,
    kStageOcclusionTexture = 1u << 4,
    kStageEmissiveTexture = 1u << 5,
    kStageLights = 1u << 6,
    kStageSpecular = 1u << 7,
    kStageAmbient = 1u << 8,
    kStageUnlit = 1u << 9,
    kStageGradients = 1u << 10,  ///< some texture has mips: raster fills the kDu.. rows
    kStagePrelit = 1u << 11,     ///< light comes in with the fragments: a shading rate below one a pixel
    kStageEnvironment = 1u << 12,  ///< the ambient light is an environment's, in spherical harmonics
    kStageCount = 13
};

struct MaterialPlan {
    std::uint32_t stages = 0;
    SlotMask slots = 0;  ///< vertex slots that raster interpolates
    float base_color[4] = {1, 1, 1, 1};
    float metallic = 0, roughness = 1;
    float emissive[3] = {0, 0, 0};
    float normal_scale = 1, occlusion_strength = 1;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    LobePlan lobe;
    PowTier specular_tier = PowTier::exact;
    /// A light's highlight, before the reflectance, is left out where it is surely below this; 0: only where it is exactly 0.
    float specular_threshold = 0;
    SpecularCurve specular_curve;
    /// 1 / d0: wrapped light is gone where its blocker is d0 away; 0: no wrapped light.
    float shadow_fade_scale = 0;
    /// Times -N.L: the share of d0 that a body which turns away from the light by N.L is thick, and that it does not shade itself by.
    float shadow_turn_scale = 0;
    int environment = -1, specular_environment = -1;  ///< indices into ShadingPlan::environments
    bool occlusion_is_metallic_roughness = false;  ///< both read the same texels the same way: one fetch serves both
    TexturePlan base_color_texture, metallic_roughness_texture, normal_texture, occlusion_texture, emissive_texture;
};

/// A light as a kernel sees it.
struct LightPlan {
    LightType type;
    std::int32_t source;         ///< index into the lights that were planned
    float color[3];
    float position[3];
    float to_light[3];           ///< directional: unit vector towards the light; spot: minus the axis
    float inv_range_squared;     ///< 1 / range^2; 0: no limit
    float min_distance_squared;  ///< source radius squared
    float cone_cutoff;           ///< spot: 1 - cos(outer angle)
    std::int32_t shadow_map = -1;  ///< index into ShadingPlan::shadow_maps; -1: casts no shadow
    float cone_scale;            ///< spot: 1 / (cos(inner) - cos(outer)); see kernels/light_kernel.hpp
    float half_cone_power;       ///< spot: half the power of the cosine; 0: none
    float cutoff_squared;         ///< point, spot: left out from this distance on, squared; 0: no limit but the range
    float brightness;            ///< the largest channel of the colour
};

/// Shape of the highlight. Phong looks at the mirrored light, Blinn at the half vector; both with the exponent that gives the same
/// width, four times larger for Blinn.
enum class SpecularModel : std::uint8_t { none, phong, blinn };

/// Everything about the frame that shading needs, the same for all fragments.
struct ShadingPlan {
    std::vector<MaterialPlan> materials;  ///< index = index of Scene material; one more at the end for "no material"
    std::vector<LightPlan> lights;        ///< in list order: sums keep it; black lights and those not finite are left out
    std::vector<ShadowMapPlan> shadow_maps;
    std::vector<EnvironmentPlan> environments;  ///< one for each lobe that meets the environment
    ShadowMode shadow_mode = ShadowMode::off;
    bool shadow_offset = false;  ///< shadows are looked up off the position: raster fills the kShadowX.. rows
    SpecularModel specular = SpecularModel::blinn;
    bool normalize_specular = true;
    Ambient ambient;
    Vec3f eye_ws{0, 0, 0};              ///< perspective: camera position
    Vec3f view_direction_ws{0, 0, -1};  ///< orthographic: the way the camera looks, unit
    bool orthographic = false;
    ErrorBound error;
};

/// Which of a texture's filters are used at most.
enum class TextureDetail : std::uint8_t {
    full,      ///< as the sampler asks for
    bilinear,  ///< one level of the mips, the nearest
    nearest    ///< one texel of that
};

/// How often light is evaluated. Textures and base colour are always read at every pixel.
enum class ShadingRate : std::uint8_t {
    flat,     ///< once a visible triangle, at its centroid, with the triangle's own normal
    gouraud,  ///< once a vertex, interpolated
    pixel
};

class EnvironmentPlans;

/// Settings that change what a plan contains.
struct PlanOptions {
    ShadingRate rate = ShadingRate::pixel;
    bool override_lobe = false;  ///< use `lobe` for all materials that do not bring their own
    Lobe lobe;
    SpecularModel specular = SpecularModel::blinn;  ///< none: no specular stage, albedo is the base colour itself
    bool normalize_specular = true;         ///< times (s + 8) / 8, so that sharper highlights are brighter; off: a peak of 1 for every exponent
    EnvironmentOrder environment_order;
    Accuracy accuracy = Accuracy::exact;
    double max_error_codes = 0.0;  ///< 0: as `accuracy` says; otherwise the cheapest whose bound is below this (error_budget.hpp)
    TextureDetail texture_detail = TextureDetail::full;
};

/// The lobe that a material is drawn with.
[[nodiscard]] inline const Lobe& lobe_of(const Material& material, const PlanOptions& options) {
    return options.override_lobe && !material.has_own_lobe ? options.lobe : material.lobe;
}

/// Materials without vertex data that they ask for (texture coordinates, colours, tangents) must be planned without it:
/// `available_slots[i]` is the union of what the primitives of material i bring.
[[nodiscard]] ShadingPlan plan_shading(std::span<const Material> materials, std::span<const Texture> textures,
                                        std::span<const SlotMask> available_slots, std::span<const Light> lights, const Ambient& ambient,
                                        const PlanOptions& options, EnvironmentPlans* environment = nullptr);

}  // namespace halflit::shading
