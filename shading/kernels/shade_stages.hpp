// The stages of shading a block, in order: surfaces, directions, lights, surroundings, reflection. Each is a loop over the whole block,
// with rows in memory between the stages: in one loop over all stages a vector of lanes would be a single chain of a thousand operations,
// longer than the processor looks ahead, and roots and divisions would be waited for.
#pragma once

#include "shading/kernels/anisotropy_kernel.hpp"
#include "shading/kernels/cell_kernel.hpp"
#include "shading/kernels/clearcoat_kernel.hpp"
#include "shading/kernels/environment_kernel.hpp"
#include "shading/kernels/ggx_kernel.hpp"
#include "shading/kernels/highlight_sums.hpp"
#include "shading/kernels/iridescence_kernel.hpp"
#include "shading/kernels/reflection_kernel.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/kernels/shade_rows.hpp"
#include "shading/kernels/shadow_catcher_kernel.hpp"
#include "shading/kernels/sheen_kernel.hpp"
#include "shading/kernels/sky_shadow_kernel.hpp"
#include "shading/kernels/specular_color_kernel.hpp"
#include "shading/kernels/surface_kernel.hpp"
#include "shading/kernels/transmission_kernel.hpp"
#include "shading/model/constants.hpp"
#include "shading/model/formulas.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Stages that need a surface's direction and its metallic and rough parts.
inline constexpr std::uint32_t kSurfaceStages = kStageLights | kStageAmbient | kStageTransmission | kStageClearcoat;

/// Base colour, emission and alpha; `needs_color` is false where only light is asked for.
static void fetch_surfaces(const shading::MaterialPlan& material, const shading::FragmentBlock& block, int count, bool needs_color,
                           ShadeRows& rows) {
    const bool lit = (material.stages & kSurfaceStages) != 0 && !has(material, kStagePrelit);
    for (int lane = 0; lane < count; lane += kWidth) {
        TexelTaps taps;
        if (needs_color) {
            const Sample base = base_color(material, block, lane, taps);
            store(rows.base[0] + lane, base.r);
            store(rows.base[1] + lane, base.g);
            store(rows.base[2] + lane, base.b);
            store(rows.alpha + lane, base.a);
        }
        if (lit || !needs_color) {
            F lost(0.0f);
            if (has(material, kStageNormalMap)) {
                const Sample texel = sample_texture(material.textures[TextureSlot::normal], block, lane, taps);
                store3(rows.texel, lane, {texel.r, texel.g, texel.b});
                lost = texel.a * F(material.normal_scale);
            }
            const Reflectance surface = reflectance(material, block, lane, taps);
            store(rows.metallic + lane, surface.metallic);
            const F roughness = vmax(surface.roughness, F(shading::kMinRoughness));
            store(rows.roughness + lane, material.normal_roughness ? rougher(roughness, lost) : roughness);
            store(rows.occlusion + lane, surface.occlusion);
        }
        if (needs_color) store3(rows.emitted, lane, emitted(material, block, lane, taps));
    }
}

template <bool kSpecular>
static void find_directions(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, const shading::FragmentBlock& block,
                            int count, ShadeRows& rows) {
    for (int lane = 0; lane < count; lane += kWidth) {
        V3 texel{F(0.0f), F(0.0f), F(0.0f)};
        if (has(material, kStageNormalMap)) texel = load3(rows.texel, lane);
        const Normals facing = normals(material, block, lane, texel);
        store3(rows.normal, lane, facing.shading);
        store3(rows.surface, lane, facing.surface);
        if constexpr (!kSpecular) continue;
        store3(rows.to_eye, lane, view_vector(frame, row3(block, shading::kPosX, lane)));
        const F half_exponent = half_specular_exponent(load(rows.roughness + lane));
        store(rows.half_exponent + lane, half_exponent);
        F normalization(1.0f);
        if (frame.normalize_specular) normalization = specular_normalization(half_exponent, frame.specular == SpecularModel::phong);
        store(rows.normalization + lane, normalization);
    }
}

template <bool kSpecular>
static void add_lights(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::LightList lights,
                       const shading::FragmentBlock& block, int count, ShadeRows& rows) {
    SpecularShape shape{frame.specular, material.specular_tier, material.specular_threshold, material.specular_curve, F(0.0f), F(1.0f)};
    V3 to_eye{F(0.0f), F(0.0f), F(0.0f)};
    for (int lane = 0; lane < count; lane += kWidth) {
        const V3 position = row3(block, shading::kPosX, lane), normal = load3(rows.normal, lane);
        if constexpr (kSpecular) {
            to_eye = load3(rows.to_eye, lane);
            shape.half_exponent = load(rows.half_exponent + lane);
            shape.normalization = load(rows.normalization + lane);
        }
        const ShadowReceiver receiver{
            frame, looked_up(frame, block, lane), load3(rows.surface, lane), {material.shadow_fade_scale, material.shadow_turn_scale}};
        LightSums sums = sum_lights<kSpecular>(lights.lights, lights.count, material.lobe, receiver, position, normal, to_eye, shape);
        if (lights.cell != nullptr) {
            const CellPlace place = cell_place(*lights.cell, position, normal);
            sums.diffuse = sums.diffuse + cell_sum(lights.cell->term, place);
            if constexpr (kSpecular)
                if (lights.cell->shines) sums.specular = sums.specular + cell_sum(lights.cell->highlight, place);
        }
        store3(rows.diffuse, lane, sums.diffuse * F(material.lobe.scale));
        if constexpr (kSpecular) store3(rows.specular, lane, sums.specular * shape.normalization);
    }
}

/// Not inlined, like add_lights.
[[gnu::noinline]] static void add_lights_by_ggx(const shading::ShadingPlan& frame, const shading::MaterialPlan& material,
                                                shading::LightList lights, const shading::FragmentBlock& block, int count,
                                                ShadeRows& rows) {
    add_ggx_lights(
        frame, material, lights, block, count, [&](int lane) __attribute__((always_inline)) { return looked_up(frame, block, lane); },
        rows);
}

/// Light of the surroundings through a material's lobe, hidden nowhere.
HALFLIT_INLINE V3 surroundings_at(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, V3 normal) {
    if (has(material, kStageEnvironment))
        return surrounding_light(frame.environments[static_cast<std::size_t>(material.environment)], normal);
    return hemisphere(frame.ambient, normal.y);
}

template <bool kSpecular>
static void add_surroundings(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, int count, ShadeRows& rows) {
    const bool environment = has(material, kStageEnvironment);
    for (int lane = 0; lane < count; lane += kWidth) {
        const V3 normal = load3(rows.normal, lane);
        const F occlusion = frame.sky.empty() ? load(rows.occlusion + lane) : F(1.0f);
        store3(rows.ambient, lane, surroundings_at(frame, material, normal) * occlusion);
        if constexpr (!kSpecular) continue;
        const V3 to_eye = load3(rows.to_eye, lane);
        const F n_dot_v = dot(normal, to_eye);
        const F twice = n_dot_v + n_dot_v;
        const F away = F(1.0f) - clamp(n_dot_v, F(0.0f), F(1.0f));
        if (!environment) store(rows.grazing + lane, fifth_power(away));
        const V3 reflection{mad(twice, normal.x, F(0.0f) - to_eye.x), mad(twice, normal.y, F(0.0f) - to_eye.y),
                            mad(twice, normal.z, F(0.0f) - to_eye.z)};
        if (!environment) {
            store3(rows.mirrored, lane, hemisphere(frame.ambient, reflection.y) * occlusion);
            continue;
        }
        const MirrorShape shape = mirror_shape(material, load(rows.roughness + lane), clamp(n_dot_v, F(0.0f), F(1.0f)));
        const V3 mirrored = has(material, kStageAnisotropy)
                                ? stretched_radiance(frame, rows, lane)
                                : mirrored_radiance(frame.reflections, material.reflection_lobes, shape, normal, n_dot_v, reflection);
        store3(rows.mirrored, lane, mirrored * occlusion);
        store(rows.share_a + lane, shape.a);
        store(rows.share_b + lane, shape.b);
        store(rows.share_more + lane, vdiv(F(1.0f), shape.a + shape.b) - F(1.0f));
    }
}

/// Sky shadows. A texture's occlusion stands for what is too small for the maps, and for the same bodies that they show: the darker of
/// both counts.
template <bool kSpecular>
[[gnu::noinline]] static void hide_sky(const shading::ShadingPlan& frame, const shading::MaterialPlan& material,
                                       const shading::FragmentBlock& block, int count, ShadeRows& rows) {
    for (int lane = 0; lane < count; lane += kWidth) {
        const V3 normal = load3(rows.normal, lane);
        V3 reflection = normal;
        F roughness(1.0f);
        if constexpr (kSpecular) {
            const V3 to_eye = load3(rows.to_eye, lane);
            const F n_dot_v = dot(normal, to_eye);
            reflection = normal * (n_dot_v + n_dot_v) - to_eye;
            roughness = load(rows.roughness + lane);
        }
        const ShadowReceiver receiver{
            frame, looked_up(frame, block, lane), load3(rows.surface, lane), {material.shadow_fade_scale, material.shadow_turn_scale}};
        const SkyVisibility seen = sky_visibility<kSpecular>(receiver, material.lobe, normal, reflection, roughness);
        const F occlusion = load(rows.occlusion + lane);
        const V3 diffuse{vmin(seen.diffuse.x, occlusion), vmin(seen.diffuse.y, occlusion), vmin(seen.diffuse.z, occlusion)};
        store3(rows.ambient, lane, load3(rows.ambient, lane) * diffuse);
        if constexpr (kSpecular) store3(rows.mirrored, lane, load3(rows.mirrored, lane) * vmin(seen.mirrored, occlusion));
    }
}

/// All stages before reflection, for a material that is lit.
template <bool kSpecular>
HALFLIT_INLINE void add_light(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::LightList lights,
                              const shading::FragmentBlock& block, int count, ShadeRows& rows) {
    find_directions<kSpecular>(frame, material, block, count, rows);
    const bool stretched = kSpecular && has(material, kStageAnisotropy);
    if (stretched) fetch_anisotropy(frame, material, block, count, rows);
    if (has(material, kStageLights)) {
        if (stretched)
            add_stretched_lights(frame, material, lights, block, count, rows);
        else if (kSpecular && material.ggx)
            add_lights_by_ggx(frame, material, lights, block, count, rows);
        else
            add_lights<kSpecular>(frame, material, lights, block, count, rows);
    }
    if (has(material, kStageAmbient)) {
        add_surroundings<kSpecular>(frame, material, count, rows);
        if (!frame.sky.empty()) hide_sky<kSpecular>(frame, material, block, count, rows);
    }
    if (has(material, kStageSpecularColor)) fetch_specular_color(material, block, count, rows);
    if (has(material, kStageIridescence)) fetch_film(material, block, count, rows);
    if (has(material, kStageTransmission)) {
        fetch_transmission(material, block, count, rows);
        dim_matt_light(material, count, rows);
    }
    if (has(material, kStageDiffuseTransmission))
        scatter_through<kSpecular>(
            frame, material, lights, block, count,
            rows, [&](V3 normal) __attribute__((always_inline)) { return surroundings_at(frame, material, normal); });
    if (has(material, kStageSheen)) add_sheen(frame, material, lights, block, count, rows);
    if (has(material, kStageClearcoat)) add_clearcoat(frame, material, lights, block, count, rows);
}

/// Light that a surface of this base colour reflects to the eye.
template <bool kSpecular>
HALFLIT_INLINE V3 reflected(const shading::MaterialPlan& material, const ShadeRows& rows, int lane, V3 base) {
    V3 albedo = base, f0{F(0.0f), F(0.0f), F(0.0f)};
    if constexpr (kSpecular) {
        if (has(material, kStageSpecularColor)) {
            reflect_colored(material, rows, lane, base, albedo);
            return albedo;
        }
        const F metallic = load(rows.metallic + lane);
        const F dielectric = F(material.dielectric) * (F(1.0f) - metallic);  // no difference that could cancel
        f0 = base * metallic + V3{dielectric, dielectric, dielectric};
        albedo = base * ((F(1.0f) - metallic) * F(material.refracted));
    }
    V3 color{F(0.0f), F(0.0f), F(0.0f)};
    if (has(material, kStageLights)) {
        color = albedo * load3(rows.diffuse, lane);
        if constexpr (kSpecular) color = color + (material.ggx ? ggx_reflected(rows, lane, f0, F(1.0f)) : f0 * load3(rows.specular, lane));
    }
    if constexpr (kSpecular) {
        if (has(material, kStageEnvironment)) {
            const F a = load(rows.share_a + lane), b = load(rows.share_b + lane), more = load(rows.share_more + lane);
            const F refracted = F(1.0f) - sky_share(a, b, more, F(material.dielectric));
            const V3 diffuse = base * ((F(1.0f) - load(rows.metallic + lane)) * refracted);
            const V3 share{sky_share(a, b, more, f0.x), sky_share(a, b, more, f0.y), sky_share(a, b, more, f0.z)};
            return color + (diffuse * load3(rows.ambient, lane) + share * load3(rows.mirrored, lane));
        }
    }
    if (has(material, kStageAmbient)) {
        color = color + albedo * load3(rows.ambient, lane);
        if constexpr (kSpecular) {
            const F roughness = load(rows.roughness + lane), grazing = load(rows.grazing + lane);
            const V3 share{environment_reflectance(f0.x, roughness, grazing), environment_reflectance(f0.y, roughness, grazing),
                           environment_reflectance(f0.z, roughness, grazing)};
            color = color + share * load3(rows.mirrored, lane);
        }
    }
    return color;
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
