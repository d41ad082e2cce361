#include "shading/plan/material_plan.hpp"

#include "sh/power.hpp"
#include "sh/trig.hpp"
#include "shading/material_properties.hpp"
#include "shading/model/constants.hpp"
#include "shading/model/numbers.hpp"
#include "shading/model/thin_film.hpp"

#include <algorithm>

namespace halflit::shading {
namespace {

SlotMask slots_of(const MaterialPlan& plan, bool lit) {
    SlotMask slots = lit ? kBaseSlots : 0u;
    if ((plan.stages & kStageVertexColor) != 0) slots |= kColorSlot;
    if ((plan.stages & kStageAnisotropy) != 0) slots |= kTangentSlot;
    for (const TextureSlot slot : kAllTextureSlots) {
        const TexturePlan& texture = plan.textures[slot];
        if (texture.data == nullptr) continue;
        slots |= texture.uv_set == 1 ? kUv1Slot : kUv0Slot;
        if (holds_normals(slot)) slots |= kTangentSlot;
    }
    return slots;
}

/// Numbers the textures' taps: textures with the same taps get the same number.
void number_taps(MaterialPlan& plan) {
    std::int32_t number = 0;
    for (TexturePlan& texture : plan.textures) {
        if (texture.data == nullptr) continue;
        TexturePlan* const end = &texture;
        const TexturePlan* const same = std::find_if(
            plan.textures.data(), end, [&](const TexturePlan& earlier) { return earlier.data != nullptr && same_taps(earlier, texture); });
        texture.taps = same == end ? ++number : same->taps;
    }
}

/// Textures of at least so many texels, 2 MiB, are fetched ahead. Frames with smaller ones are 1 to 2 % slower with it.
constexpr std::size_t kLeastTexelsAhead = std::size_t{1} << 18;

/// Lists for each texture what is fetched with it.
void list_ahead(MaterialPlan& plan) {
    for (TexturePlan& texture : plan.textures) {
        if (texture.taps == 0) continue;
        for (const TexturePlan* with = &texture; with != plan.textures.data() + plan.textures.size(); ++with) {
            if (with->taps != texture.taps || with->source->data().size() < 4 * kLeastTexelsAhead) continue;
            const std::uint16_t** const end = texture.ahead + texture.ahead_count;
            if (std::find(texture.ahead, end, with->data) == end) texture.ahead[texture.ahead_count++] = with->data;
        }
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

void plan_iridescence(const Material& material, MaterialPlan& plan) {
    IridescencePlan& film = plan.iridescence;
    film.factor = clamp_or_low(material.iridescence, 0.0f, 1.0f);
    film.ior = clamp_or_low(material.iridescence_ior, 1.0f, kMostFilmIor);
    const float least = clamp_or_low(material.iridescence_thickness_min_nm, 0.0f, kMostFilmNm),
                most = clamp_or_low(material.iridescence_thickness_max_nm, 0.0f, kMostFilmNm);
    const bool textured = plan.textures[TextureSlot::iridescence_thickness].data != nullptr;
    film.thickness_nm = textured ? least : most;
    film.thickness_range_nm = textured ? most - least : 0.0f;
}

/// True if the levels of a texture of normals keep what they lose as roughness.
bool loses_normals(const TexturePlan& normals) {
    return normals.data != nullptr && normals.source->rule() == MipRule::normal && normals.mip != MipFilter::none &&
           normals.level_count > 1;
}

/// Plans what is not a texture: Beer's law over the thickness, colour^(thickness / distance).
void plan_transmission(const Material& material, TransmissionPlan& plan) {
    plan.share = clamp_or_low(material.transmission, 0.0f, 1.0f);
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

/// Plans how light from behind is bent by the index of refraction, and blurred: the nearer the index is to 1, the less facets turn a ray.
void plan_look_through(const Material& material, bool rough, TransmissionPlan& plan) {
    constexpr double kMostReflectance = 0.9;
    const double root =
        __builtin_sqrt(std::min(static_cast<double>(clamp_or_low(material.dielectric_reflectance, 0.0f, 1.0f)), kMostReflectance));
    const double index = (1.0 + root) / (1.0 - root);
    // KHR_materials_dispersion: the index of red is as much lower as that of blue is higher. No index is below that of air.
    const double dispersion = clamp_or_low(material.dispersion, 0.0f, kMostScale);
    const double spread = (index - 1.0) * std::min(0.025 * dispersion, 1.0);
    for (int c = 0; c < 3; ++c) plan.inverse_ior[c] = static_cast<float>(1.0 / (index + spread * (c - 1)));
    plan.disperses = spread > 0.0 && material.thickness > 0.0f;
    plan.blur = static_cast<float>(std::min(1.0, 2.0 * (index - 1.0)));
    plan.thickness = clamp_or_low(material.thickness, 0.0f, kMostNumber);
    plan.looked_through = plan.blur > 0.0f && (rough || plan.thickness > 0.0f);
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

MirrorRow mirror_row(float roughness) {
    constexpr int kLast = kReflectionNodes - 1;
    // The operations are those of the kernel where the roughness varies, and in its order.
    const float row = roughness * static_cast<float>(kLast), low = std::min(__builtin_floorf(row), static_cast<float>(kLast - 1));
    const float down = row - low;
    const ReflectionShape *const upper = kReflectionShapes + static_cast<int>(low) * kReflectionNodes, *const lower =
                                                                                                           upper + kReflectionNodes;
    MirrorRow out;
    out.at_one_roughness = true;
    for (int j = 0; j < kReflectionNodes; ++j) {
        const auto number = [&](int i, float ReflectionShape::*of) {
            out.values[i][j] = down * (lower[j].*of - upper[j].*of) + upper[j].*of;
        };
        number(0, &ReflectionShape::a), number(1, &ReflectionShape::b);
        number(2, &ReflectionShape::turn0), number(3, &ReflectionShape::level0);
        number(4, &ReflectionShape::turn1), number(5, &ReflectionShape::level1), number(6, &ReflectionShape::spread);
    }
    return out;
}

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
    const Vec3f emissive = material.emissive * options.emission_scale;
    plan.emissive[0] = emissive.x, plan.emissive[1] = emissive.y, plan.emissive[2] = emissive.z;
    plan.normal_scale = material.normal_scale * options.normal_scale;
    plan.occlusion_strength = clamp_or_low(material.occlusion_strength, 0.0f, 1.0f);
    plan.alpha_mode = material.alpha_mode;
    plan.alpha_cutoff = material.alpha_cutoff;
    plan.lobe = plan_lobe(lobe_of(material, options), plan.specular_tier);

    const bool coated = material.is_coated() && kinds.specular;
    const bool lit = (!material.unlit && (kinds.lights || kinds.ambient)) || material.transmits() || (coated && !zero(emissive));
    plan.double_sided = material.double_sided && lit;
    if (material.unlit) plan.stages |= kStageUnlit;
    if (lit && kinds.lights) plan.stages |= kStageLights;
    if (lit && kinds.ambient) plan.stages |= kStageAmbient;
    if (lit && kinds.specular) plan.stages |= kStageSpecular;
    plan.ggx = lit && kinds.lights && options.specular == SpecularModel::ggx;
    if (lit && options.rate != ShadingRate::pixel) plan.stages |= kStagePrelit;

    bool gradients = false;
    const auto use_texture = [&](bool wanted, TextureSlot slot) {
        if (!wanted) return;
        TexturePlan& texture = plan.textures[slot];
        texture = plan_texture(material.textures[slot], textures, available, options);
        if (texture.data == nullptr) return;
        plan.stages |= info_of(slot).stage;
        gradients = gradients || texture.needs_lod;
    };
    const bool base_color_seen = lit || material.unlit || material.alpha_mode != AlphaMode::opaque;
    const bool has_tangents = (available & kTangentSlot) != 0, maps_normals = has_tangents && options.normal_scale != 0.0f;
    use_texture(base_color_seen, TextureSlot::base_color);
    use_texture(lit && kinds.specular, TextureSlot::metallic_roughness);
    use_texture(lit && maps_normals, TextureSlot::normal);
    use_texture(lit && kinds.ambient && plan.occlusion_strength > 0.0f, TextureSlot::occlusion);
    use_texture(!material.unlit && !zero(emissive), TextureSlot::emissive);
    const bool film = lit && kinds.specular && material.is_iridescent();
    if (lit && kinds.specular && (material.has_specular_color() || film)) {
        plan.stages |= kStageSpecularColor;
        plan_specular_color(material, plan);
        use_texture(true, TextureSlot::specular);
        use_texture(true, TextureSlot::specular_color);
    }
    if (material.transmits()) {
        plan.stages |= kStageTransmission;
        plan_transmission(material, plan.transmission);
        use_texture(true, TextureSlot::transmission);
        const bool rough = plan.roughness > kMinRoughness;
        if (kinds.specular && options.rate == ShadingRate::pixel) plan_look_through(material, rough, plan.transmission);
        const float(&absorbed)[3] = plan.transmission.absorbed;
        use_texture(absorbed[0] + absorbed[1] + absorbed[2] > 0.0f || (plan.transmission.looked_through && material.thickness > 0.0f),
                    TextureSlot::thickness);
    }
    if (lit && coated) {
        plan.stages |= kStageClearcoat;
        plan.clearcoat.factor = clamp_or_low(material.clearcoat, 0.0f, 1.0f);
        plan.clearcoat.roughness = clamp_or_low(material.clearcoat_roughness, 0.0f, 1.0f);
        plan.clearcoat.normal_scale = material.clearcoat_normal_scale * options.normal_scale;
        use_texture(true, TextureSlot::clearcoat);
        use_texture(true, TextureSlot::clearcoat_roughness);
        use_texture(maps_normals, TextureSlot::clearcoat_normal);
        plan.clearcoat.normal_roughness = loses_normals(plan.textures[TextureSlot::clearcoat_normal]);
    }
    if (lit && kinds.specular && material.has_sheen()) {
        plan.stages |= kStageSheen;
        const float color[] = {material.sheen_color.x, material.sheen_color.y, material.sheen_color.z};
        for (int c = 0; c < 3; ++c) plan.sheen.color[c] = clamp_or_low(color[c], 0.0f, 1.0f);
        plan.sheen.roughness = clamp_or_low(material.sheen_roughness, 0.0f, 1.0f);
        use_texture(true, TextureSlot::sheen_color);
        use_texture(true, TextureSlot::sheen_roughness);
    }
    if (film) {
        plan.stages |= kStageIridescence;
        use_texture(true, TextureSlot::iridescence);
        use_texture(true, TextureSlot::iridescence_thickness);
        plan_iridescence(material, plan);
    }
    if (lit && kinds.specular && has_tangents && material.is_anisotropic()) {
        plan.stages |= kStageAnisotropy;
        plan.anisotropy.strength = clamp_or_low(material.anisotropy_strength, 0.0f, 1.0f);
        const SinCos turn = sin_cos(static_cast<double>(clamp_or_low(material.anisotropy_rotation_rad, -kMostScale, kMostScale)));
        plan.anisotropy.sine = static_cast<float>(turn.sin), plan.anisotropy.cosine = static_cast<float>(turn.cos);
        use_texture(true, TextureSlot::anisotropy);
    }
    if ((plan.stages & (kStageLights | kStageAmbient)) != 0 && has_layer(material, kStageDiffuseTransmission)) {
        plan.stages |= kStageDiffuseTransmission;
        plan.diffuse_transmission.share = clamp_or_low(material.diffuse_transmission, 0.0f, 1.0f);
        const Vec3f color = material.diffuse_transmission_color;
        const float channels[] = {color.x, color.y, color.z};
        for (int c = 0; c < 3; ++c) plan.diffuse_transmission.color[c] = clamp_or_low(channels[c], 0.0f, 1.0f);
        use_texture(true, TextureSlot::diffuse_transmission);
        use_texture(true, TextureSlot::diffuse_transmission_color);
    }
    plan.normal_roughness = kinds.specular && loses_normals(plan.textures[TextureSlot::normal]);
    if (gradients) plan.stages |= kStageGradients;
    if (base_color_seen && (available & kColorSlot) != 0) plan.stages |= kStageVertexColor;
    plan.occlusion_is_metallic_roughness =
        (plan.stages & kStageOcclusionTexture) != 0 && (plan.stages & kStageMetallicRoughnessTexture) != 0 &&
        same_fetch(plan.textures[TextureSlot::occlusion], plan.textures[TextureSlot::metallic_roughness]);
    number_taps(plan);
    list_ahead(plan);
    plan.slots = slots_of(plan, lit);
    return plan;
}

}  // namespace halflit::shading
