#include "shading/budget/surface_bounds.hpp"

#include "shading/model/constants.hpp"
#include "shading/model/reflection_tables.hpp"
#include "shading/model/scalar.hpp"

#include <algorithm>
#include <initializer_list>

namespace halflit::shading {
namespace {

double held(double roughness) { return std::max(roughness, double{kMinRoughness}); }

/// Largest highlight of GGX: D is at most 1 / a^2, times pi, and (N.L) V at most 1 / (2 a).
double ggx_most(double roughness) {
    const double a = held(roughness) * held(roughness);
    return 0.5 / (a * a * a);
}

/// Largest factor by which light that bounces between facets brightens a highlight: 1 / (A + B).
double most_bounced() {
    static const double most = [] {
        double least = 1.0;
        for (const ReflectionShape& at : kReflectionShapes) least = std::min(least, static_cast<double>(at.a) + static_cast<double>(at.b));
        return 1.0 / least;
    }();
    return most;
}

/// The least value of a channel in the whole texture; 1 where there is none.
double least_value(const TexturePlan& texture, int c, const SceneFacts& facts) {
    if (texture.data == nullptr) return 1.0;
    return facts.read_texels ? texture.source->least()[static_cast<std::size_t>(c)] / 65535.0 : 0.0;
}

/// The largest highlight of a light of colour 1, before the reflectance.
double normalization_of(const ShadingPlan& plan, bool ggx, double roughness, double reflectance) {
    if (ggx) return ggx_most(roughness) * most_bounced() * reflectance;
    return plan.normalize_specular ? specular_normalization(0.5 * specular_exponent(roughness), plan.specular == SpecularModel::phong)
                                   : 1.0;
}

/// What a coat and sheen reflect at most. Sheen: D is at most 1 + 1 / (2 a), and V (N.L) at most 1 / 4.
double layers_of(const ShadingPlan& plan, const MaterialPlan& material, const SceneFacts& facts) {
    double most = 0.0;
    if ((material.stages & kStageClearcoat) != 0) {
        const ClearcoatPlan& coat = material.clearcoat;
        const double roughness = coat.roughness * least_value(material.textures[TextureSlot::clearcoat_roughness], 1, facts);
        const double reflectance = material.ggx ? 1.0 : double{coat.factor};
        most += reflectance * normalization_of(plan, material.ggx, roughness, reflectance);
    }
    if ((material.stages & kStageSheen) != 0) {
        const SheenPlan& sheen = material.sheen;
        const double roughness = held(sheen.roughness * least_value(material.textures[TextureSlot::sheen_roughness], 3, facts));
        most +=
            static_cast<double>(std::max({sheen.color[0], sheen.color[1], sheen.color[2]})) * (1.0 + 0.5 / (roughness * roughness)) * 0.25;
    }
    return most;
}

}  // namespace

Surface surface_of(const ShadingPlan& plan, const MaterialPlan& material, const SceneFacts& facts) {
    const auto has = [&](Stage stage) { return (material.stages & stage) != 0; };
    Surface s;
    const auto& [red, green, blue, alpha] = material.base_color;
    s.albedo = std::max({red, green, blue}) * (has(kStageVertexColor) ? facts.vertex_color : 1.0);
    s.specular = has(kStageSpecular) && (has(kStageLights) || has(kStageAmbient));
    const double dielectric = material.dielectric, metallic = material.metallic;
    double least_color = has(kStageVertexColor) ? 0.0 : std::min({red, green, blue});
    for (const int c : {0, 1, 2})
        least_color = std::min(least_color, material.base_color[c] * least_value(material.textures[TextureSlot::base_color], c, facts));
    // Where something else takes a part of the light that enters, the least colour is not known.
    constexpr std::uint32_t kTakes =
        kStageSpecularColor | kStageIridescence | kStageTransmission | kStageDiffuseTransmission | kStageClearcoat | kStageSheen;
    if ((material.stages & kTakes) == 0 && (metallic == 0.0 || !has(kStageMetallicRoughnessTexture))) {
        s.least_albedo = least_color * (1.0 - metallic) * (1.0 - dielectric);
        s.reflectance_at_least = dielectric + metallic * (least_color - dielectric);
    }
    constexpr double kLeastReflectance = 1e-6;  // costs are divided by it
    s.reflectance = std::max({kLeastReflectance, dielectric, metallic > 0.0 ? s.albedo : 0.0});
    if (has(kStageIridescence)) s.reflectance = 1.0;
    if (has(kStageDiffuseTransmission)) {
        // Light of both sides has weights that sum to no more than the brighter of the two colours.
        const DiffuseTransmissionPlan& through = material.diffuse_transmission;
        s.albedo = std::max(s.albedo, static_cast<double>(std::max({through.color[0], through.color[1], through.color[2]})));
    }
    const double roughness = material.roughness * least_value(material.textures[TextureSlot::metallic_roughness], 1, facts);
    s.exponent = specular_exponent(roughness);
    if (material.ggx) s.reflectance = std::max(1.0, s.reflectance);  // at grazing views
    s.normalization = normalization_of(plan, material.ggx, roughness, s.reflectance);
    s.layers = layers_of(plan, material, facts);
    return s;
}

Arriving arriving(const ShadingPlan& plan, double exposure, const SceneFacts& facts) {
    Arriving a;
    for (std::size_t i = 0; i < plan.lights.size(); ++i) {
        const LightPlan& light = plan.lights[i];
        const double most = light.brightness * facts.light_attenuation[i] * exposure;
        a.sum += most;
        a.largest = std::max(a.largest, most);
        ++a.count;
        a.local += kind_of(light.type).placed ? 1 : 0;
    }
    return a;
}

bool may_split(const ShadingPlan& plan, const MaterialPlan& material) {
    return plan.shadow_mode == ShadowMode::soft_split && material.shadow_fade_scale > 0.0f && (material.stages & kStageLights) != 0;
}

}  // namespace halflit::shading
