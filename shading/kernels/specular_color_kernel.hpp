// KHR_materials_specular: where not metallic, F0 has a colour and a weight. These stages run only for materials that have them.
#pragma once

#include "shading/kernels/ggx_kernel.hpp"
#include "shading/kernels/iridescence_kernel.hpp"
#include "shading/kernels/reflection_kernel.hpp"
#include "shading/kernels/shade_rows.hpp"
#include "shading/kernels/surface_kernel.hpp"
#include "shading/model/formulas.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Sets the rows `dielectric` and `specular_weight`.
[[gnu::noinline]] static void fetch_specular_color(const shading::MaterialPlan& material, const shading::FragmentBlock& block, int count,
                                                   ShadeRows& rows) {
    const F one(1.0f);
    for (int lane = 0; lane < count; lane += kWidth) {
        TexelTaps taps;
        F weight(material.specular_weight);
        V3 color = broadcast(material.dielectric_color);
        if (material.textures[TextureSlot::specular].data != nullptr)
            weight = weight * sample_texture(material.textures[TextureSlot::specular], block, lane, taps).a;
        if (material.textures[TextureSlot::specular_color].data != nullptr) {
            const Sample texture = sample_texture(material.textures[TextureSlot::specular_color], block, lane, taps);
            color = color * V3{texture.r, texture.g, texture.b};
        }
        store3(rows.dielectric, lane, V3{vmin(color.x, one), vmin(color.y, one), vmin(color.z, one)} * weight);
        store(rows.specular_weight + lane, weight);
    }
}

/// Shares of the surroundings that are mirrored, per channel, by F0 and by a factor of what is mirrored at grazing views.
struct SkyShare {
    const shading::MaterialPlan& material;
    F a, b, more, roughness, grazing;

    SkyShare(const shading::MaterialPlan& of, const ShadeRows& rows, int lane) : material(of) {
        if (has(of, kStageEnvironment))
            a = load(rows.share_a + lane), b = load(rows.share_b + lane), more = load(rows.share_more + lane);
        else
            roughness = load(rows.roughness + lane), grazing = load(rows.grazing + lane);
    }
    F operator()(F f0, F weight) const {
        if (has(material, kStageEnvironment)) return sky_share(a, b * weight, more, f0);
        return mad(vmax((F(1.0f) - roughness) * weight, f0) - f0, grazing, f0);
    }
};

/// As reflected(), of shade_stages.hpp.
[[gnu::noinline]] static void reflect_colored(const shading::MaterialPlan& material, const ShadeRows& rows, int lane, V3 base, V3& color) {
    const F metallic = load(rows.metallic + lane), diffuse = F(1.0f) - metallic, weight = load(rows.specular_weight + lane);
    const V3 dielectric = load3(rows.dielectric, lane),
             metal = has(material, kStageIridescence) && material.metallic > 0.0f ? below_film(rows, lane, base) : base;
    const V3 f0 = metal * metallic + dielectric * diffuse;
    const F largest = vmax(dielectric.x, vmax(dielectric.y, dielectric.z));
    const V3 albedo = base * (diffuse * (F(1.0f) - largest));
    color = {F(0.0f), F(0.0f), F(0.0f)};
    const F at_grazing = mad(weight, diffuse, metallic);
    if (has(material, kStageLights))
        color = albedo * load3(rows.diffuse, lane) +
                (material.ggx ? ggx_reflected(rows, lane, f0, at_grazing) : f0 * load3(rows.specular, lane));
    if (!has(material, kStageAmbient)) return;
    const SkyShare share(material, rows, lane);
    const V3 scattered = has(material, kStageEnvironment) ? base * (diffuse * (F(1.0f) - share(largest, weight))) : albedo;
    const V3 mirrored{share(f0.x, at_grazing), share(f0.y, at_grazing), share(f0.z, at_grazing)};
    color = color + (scattered * load3(rows.ambient, lane) + mirrored * load3(rows.mirrored, lane));
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
