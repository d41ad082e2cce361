#include "shading/plan/material_plan.hpp"

#include "sh/power.hpp"
#include "shading/model/numbers.hpp"

#include <algorithm>

namespace halflit::shading {
namespace {

SlotMask slots_of(const MaterialPlan& plan, bool lit) {
    SlotMask slots = lit ? kBaseSlots : 0u;
    if ((plan.stages & kStageNormalMap) != 0) slots |= kTangentSlot;
    if ((plan.stages & kStageVertexColor) != 0) slots |= kColorSlot;
    const auto add = [&](Stage stage, const TexturePlan& texture) {
        if ((plan.stages & stage) != 0) slots |= texture.uv_set == 1 ? kUv1Slot : kUv0Slot;
    };
    add(kStageBaseColorTexture, plan.base_color_texture);
    add(kStageMetallicRoughnessTexture, plan.metallic_roughness_texture);
    add(kStageNormalMap, plan.normal_texture);
    add(kStageOcclusionTexture, plan.occlusion_texture);
    add(kStageEmissiveTexture, plan.emissive_texture);
    for (const TexturePlan* texture : {&plan.specular_texture, &plan.specular_color_texture})
        if (texture->data != nullptr) add(kStageSpecularColor, *texture);
    for (const TexturePlan* texture : {&plan.transmission.texture, &plan.transmission.thickness_texture})
        if (texture->data != nullptr) add(kStageTransmission, *texture);
    for (const TexturePlan* texture : {&plan.clearcoat.texture, &plan.clearcoat.roughness_texture, &plan.clearcoat.normal_texture})
        if (texture->data != nullptr) add(kStageClearcoat, *texture);
    for (const TexturePlan* texture : {&plan.sheen.color_texture, &plan.sheen.roughness_texture})
        if (texture->data != nullptr) add(kStageSheen, *texture);
    if (plan.clearcoat.normal_texture.data != nullptr) slots |= kTangentSlot;
    return slots;
}

/// Numbers the textures' taps: textures with the same taps get the same number.
void number_taps(MaterialPlan& plan) {
    TexturePlan* const textures[] = {&plan.base_color_texture,
                                     &plan.metallic_roughness_texture,
                                     &plan.normal_texture,
                                     &plan.occlusion_texture,
                                     &plan.emissive_texture,
                                     &plan.transmission.texture,
                                     &plan.transmission.thickness_texture,
                                     &plan.specular_texture,
                                     &plan.specular_color_texture,
                                     &plan.clearcoat.texture,
                                     &plan.clearcoat.roughness_texture,
                                     &plan.clearcoat.normal_texture,
                                     &plan.sheen.color_texture,
                                     &plan.sheen.roughness_texture};
    std::int32_t number = 0;
    for (TexturePlan* const& texture : textures) {
        const auto* const same = std::find_if(
            textures, &texture, [&](const TexturePlan* earlier) { return earlier->data != nullptr && same_taps(*earlier, *texture); });
        texture->taps = same == &texture ? ++number : (*same)->taps;
    }
}

/// Where not metallic: F0 by channel, and the weight. Leaves the largest F0 in `dielectric`, which bounds go by.
void plan_specular_color(const Material& material, MaterialPlan& plan) {
    const float color[] = {material.specular_color.x, material.specular_color.y, material.specular_color.z};
    constexpr float kMost = 1e18f;
    plan.specular_weight = clamp_or_low(material.specular, 0.0f, 1.0f);
    float largest = 0.0f;
    for (int c = 0; c < 3; ++c) {
        plan.dielectric_color[c] = plan.dielectric * clamp_or_low(color[c], 0.0f, kMost);
        largest = std::max(largest, plan.dielectric_color[c]);
    }
    plan.dielectric = std::min(largest, 1.0f) * plan.specular_weight;
    plan.refracted = 1.0f - plan.dielectric;
}

/// True if the levels of a texture of normals keep what they lose as roughness.
bool loses_normals(const TexturePlan& normals) {
    return normals.data != nullptr && normals.source->rule() == MipRule::normal && normals.mip != MipFilter::none &&
           normals.level_count > 1;
}

/// Plans what is not a texture: Beer's law over the thickness, colour^(thickness / distance).
void plan_transmission(const Transmission& material, TransmissionPlan& plan) {
    plan.share = clamp_or_low(material.share, 0.0f, 1.0f);
    const double ways = material.attenuation_distance > 0.0f && material.thickness > 0.0f
                            ? static_cast<double>(material.thickness) / static_cast<double>(material.attenuation_distance)
                            : 0.0;
    const float color[] = {material.attenuation_color.x, material.attenuation_color.y, material.attenuation_color.z};
    for (int c = 0; c < 3; ++c) {
        constexpr double kDarkest = 1e-37, kAll = 1e30;
        const auto held = static_cast<double>(clamp_or_low(color[c], 0.0f, 1.0f));
        const double bits = ways > 0.0 ? std::min(kAll, held > kDarkest ? -log2_of(held) * ways : kAll) : 0.0;
        plan.absorbed[c] = static_cast<float>(bits);
        plan.passed[c] = static_cast<float>(exp2_of(-bits));
    }
}

/// Lit by lights and surroundings through its lobe, at each fragment, and nothing else.
MaterialPlan plan_shadow_catcher(const Material& material, const LightKinds& kinds, const ShadingSettings& options) {
    MaterialPlan plan;
    plan.base_color[3] = material.base_color.w;
    plan.metallic = 0.0f;
    plan.alpha_mode = AlphaMode::blend;
    plan.double_sided = material.double_sided;
    plan.lobe = plan_lobe(lobe_of(material, options), plan.specular_tier);
    plan.stages = kStageShadowCatcher;
    if (kinds.lights) plan.stages |= kStageLights;
    if (kinds.ambient) plan.stages |= kStageAmbient;
    plan.slots = slots_of(plan, true);
    return plan;
}

}  // namespace

MaterialPlan plan_material(const Material& material, std::span<const Texture> textures, SlotMask available, const LightKinds& kinds,
                           const ShadingSettings& options) {
    if (material.shadow_catcher) return plan_shadow_catcher(material, kinds, options);
    MaterialPlan plan;
    plan.base_color[0] = material.base_color.x, plan.base_color[1] = material.base_color.y;
    plan.base_color[2] = material.base_color.z, plan.base_color[3] = material.base_color.w;
    plan.metallic = clamp_or_low(material.metallic, 0.0f, 1.0f);
    plan.roughness = clamp_or_low(material.roughness, 0.0f, 1.0f);
    plan.dielectric = clamp_or_low(material.dielectric_reflectance, 0.0f, 1.0f);
    plan.refracted = 1.0f - plan.dielectric;
    plan.emissive[0] = material.emissive.x, plan.emissive[1] = material.emissive.y, plan.emissive[2] = material.emissive.z;
    plan.normal_scale = material.normal_scale;
    plan.occlusion_strength = clamp_or_low(material.occlusion_strength, 0.0f, 1.0f);
    plan.alpha_mode = material.alpha_mode;
    plan.alpha_cutoff = material.alpha_cutoff;
    plan.lobe = plan_lobe(lobe_of(material, options), plan.specular_tier);

    const bool coated = material.is_coated() && kinds.specular;
    const bool lit = (!material.unlit && (kinds.lights || kinds.ambient)) || material.transmits() || (coated && !zero(material.emissive));
    plan.double_sided = material.double_sided && lit;
    if (material.unlit) plan.stages |= kStageUnlit;
    if (lit && kinds.lights) plan.stages |= kStageLights;
    if (lit && kinds.ambient) plan.stages |= kStageAmbient;
    if (lit && kinds.specular) plan.stages |= kStageSpecular;
    plan.ggx = lit && kinds.lights && options.specular == SpecularModel::ggx;
    if (lit && options.rate != ShadingRate::pixel) plan.stages |= kStagePrelit;

    bool gradients = false;
    const auto use_texture = [&](bool wanted, Stage stage, const TextureUse& use, TexturePlan& target) {
        if (!wanted) return;
        target = plan_texture(use, textures, available, options);
        if (target.data == nullptr) return;
        plan.stages |= stage;
        gradients = gradients || target.needs_lod;
    };
    const bool base_color_seen = lit || material.unlit || material.alpha_mode != AlphaMode::opaque;
    use_texture(base_color_seen, kStageBaseColorTexture, material.base_color_texture, plan.base_color_texture);
    use_texture(lit && kinds.specular, kStageMetallicRoughnessTexture, material.metallic_roughness_texture,
                plan.metallic_roughness_texture);
    use_texture(lit && (available & kTangentSlot) != 0, kStageNormalMap, material.normal_texture, plan.normal_texture);
    use_texture(lit && kinds.ambient && plan.occlusion_strength > 0.0f, kStageOcclusionTexture, material.occlusion_texture,
                plan.occlusion_texture);
    use_texture(!material.unlit && !zero(material.emissive), kStageEmissiveTexture, material.emissive_texture, plan.emissive_texture);
    if (lit && kinds.specular && material.has_specular_color()) {
        plan.stages |= kStageSpecularColor;
        plan_specular_color(material, plan);
        use_texture(true, kStageSpecularColor, material.specular_texture, plan.specular_texture);
        use_texture(true, kStageSpecularColor, material.specular_color_texture, plan.specular_color_texture);
    }
    if (material.transmits()) {
        plan.stages |= kStageTransmission;
        plan_transmission(material.transmission, plan.transmission);
        use_texture(true, kStageTransmission, material.transmission.texture, plan.transmission.texture);
        const float(&absorbed)[3] = plan.transmission.absorbed;
        use_texture(absorbed[0] + absorbed[1] + absorbed[2] > 0.0f, kStageTransmission, material.transmission.thickness_texture,
                    plan.transmission.thickness_texture);
    }
    if (lit && coated) {
        const Clearcoat& coat = material.clearcoat;
        plan.stages |= kStageClearcoat;
        plan.clearcoat.factor = clamp_or_low(coat.factor, 0.0f, 1.0f);
        plan.clearcoat.roughness = clamp_or_low(coat.roughness, 0.0f, 1.0f);
        plan.clearcoat.normal_scale = coat.normal_scale;
        use_texture(true, kStageClearcoat, coat.texture, plan.clearcoat.texture);
        use_texture(true, kStageClearcoat, coat.roughness_texture, plan.clearcoat.roughness_texture);
        use_texture((available & kTangentSlot) != 0, kStageClearcoat, coat.normal_texture, plan.clearcoat.normal_texture);
        plan.clearcoat.normal_roughness = loses_normals(plan.clearcoat.normal_texture);
    }
    if (lit && kinds.specular && material.has_sheen()) {
        const Sheen& sheen = material.sheen;
        plan.stages |= kStageSheen;
        const float color[] = {sheen.color.x, sheen.color.y, sheen.color.z};
        for (int c = 0; c < 3; ++c) plan.sheen.color[c] = clamp_or_low(color[c], 0.0f, 1.0f);
        plan.sheen.roughness = clamp_or_low(sheen.roughness, 0.0f, 1.0f);
        use_texture(true, kStageSheen, sheen.color_texture, plan.sheen.color_texture);
        use_texture(true, kStageSheen, sheen.roughness_texture, plan.sheen.roughness_texture);
    }
    plan.normal_roughness = kinds.specular && loses_normals(plan.normal_texture);
    if (gradients) plan.stages |= kStageGradients;
    if (base_color_seen && (available & kColorSlot) != 0) plan.stages |= kStageVertexColor;
    plan.occlusion_is_metallic_roughness = (plan.stages & kStageOcclusionTexture) != 0 &&
                                           (plan.stages & kStageMetallicRoughnessTexture) != 0 &&
                                           same_fetch(plan.occlusion_texture, plan.metallic_roughness_texture);
    number_taps(plan);
    plan.slots = slots_of(plan, lit);
    return plan;
}

}  // namespace halflit::shading
