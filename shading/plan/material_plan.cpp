#include "shading/plan/material_plan.hpp"

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
    return slots;
}

/// Numbers the textures' taps: textures with the same taps get the same number.
void number_taps(MaterialPlan& plan) {
    TexturePlan* const textures[] = {&plan.base_color_texture, &plan.metallic_roughness_texture, &plan.normal_texture,
                                     &plan.occlusion_texture, &plan.emissive_texture};
    std::int32_t number = 0;
    for (TexturePlan* const& texture : textures) {
        const auto* const same = std::find_if(
            textures, &texture, [&](const TexturePlan* earlier) { return earlier->data != nullptr && same_taps(*earlier, *texture); });
        texture->taps = same == &texture ? ++number : (*same)->taps;
    }
}

}  // namespace

MaterialPlan plan_material(const Material& material, std::span<const Texture> textures, SlotMask available, const LightKinds& kinds,
                           const ShadingSettings& options) {
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

    const bool lit = !material.unlit && (kinds.lights || kinds.ambient);
    plan.double_sided = material.double_sided && lit;
    if (material.unlit) plan.stages |= kStageUnlit;
    if (lit && kinds.lights) plan.stages |= kStageLights;
    if (lit && kinds.ambient) plan.stages |= kStageAmbient;
    if (lit && kinds.specular) plan.stages |= kStageSpecular;
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
    const TexturePlan& normals = plan.normal_texture;
    plan.normal_roughness = kinds.specular && normals.data != nullptr && normals.source->rule() == MipRule::normal &&
                            normals.mip != MipFilter::none && normals.level_count > 1;
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
