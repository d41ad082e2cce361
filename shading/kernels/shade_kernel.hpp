// The shading kernel: one source, compiled once for each instruction set.
#pragma once

#include "shading/kernels/cell_kernel.hpp"
#include "shading/kernels/color_kernel.hpp"
#include "shading/kernels/environment_kernel.hpp"
#include "shading/kernels/highlight_sums.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/kernels/surface_kernel.hpp"
#include "shading/model/constants.hpp"
#include "shading/model/formulas.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

HALFLIT_INLINE V3 lerp(V3 a, V3 b, F weight) { return a + (b - a) * weight; }

/// Sky and ground light that reaches a surface; `up` is the y component of the surface's direction.
HALFLIT_INLINE V3 hemisphere(const Ambient& ambient, F up) {
    const V3 ground = broadcast(ambient.ground_linear);
    return lerp(ground, broadcast(ambient.sky_linear), F(0.5f) * (F(1.0f) + up));
}

/// Point at which a fragment's shadows are looked up.
HALFLIT_INLINE V3 looked_up(const shading::ShadingPlan& frame, const shading::FragmentBlock& block, int lane) {
    const V3 position = row3(block, shading::kPosX, lane);
    return frame.shadow_offset ? position + row3(block, shading::kShadowX, lane) : position;
}

/// All light that reaches a surface point, before the base colour is applied.
struct IncidentLight {
    V3 diffuse;                    ///< through the lobe, its scale included
    V3 specular;                   ///< the highlight, before the reflectance
    V3 ambient, specular_ambient;  ///< surroundings' light towards the normal and towards the reflected view, times occlusion
    F metallic, roughness, grazing;
};

template <bool kSpecular>
HALFLIT_INLINE IncidentLight incident_light(const shading::ShadingPlan& frame, const shading::MaterialPlan& material,
                                            shading::LightList lights, const shading::FragmentBlock& block, int lane, TexelTaps& taps) {
    const V3 zero{F(0.0f), F(0.0f), F(0.0f)};
    const V3 position = row3(block, shading::kPosX, lane);
    const Normals facing = normals(material, block, lane, taps);
    const V3 normal = facing.shading;
    const Reflectance surface = reflectance(material, block, lane, taps);
    IncidentLight light{zero, zero, zero, zero, surface.metallic, F(1.0f), F(0.0f)};
    V3 to_eye = zero;
    SpecularShape shape{frame.specular, material.specular_tier, material.specular_threshold, material.specular_curve, F(0.0f), F(1.0f)};
    if constexpr (kSpecular) {
        to_eye = view_vector(frame, position);
        light.roughness = vmax(surface.roughness, F(shading::kMinRoughness));
        shape.half_exponent = half_specular_exponent(light.roughness);
        if (frame.normalize_specular)
            shape.normalization = specular_normalization(shape.half_exponent, frame.specular == SpecularModel::phong);
    }
    if (has(material, kStageLights)) {
        const ShadowReceiver receiver{
            frame, looked_up(frame, block, lane), facing.surface, {material.shadow_fade_scale, material.shadow_turn_scale}};
        LightSums sums = sum_lights<kSpecular>(lights.lights, lights.count, material.lobe, receiver, position, normal, to_eye, shape);
        if (lights.cell != nullptr) {
            const CellPlace place = cell_place(*lights.cell, position, normal);
            sums.diffuse = sums.diffuse + cell_sum(lights.cell->term, place);
            if constexpr (kSpecular)
                if (lights.cell->shines) sums.specular = sums.specular + cell_sum(lights.cell->highlight, place);
        }
        light.diffuse = sums.diffuse * F(material.lobe.scale);
        if constexpr (kSpecular) light.specular = sums.specular * shape.normalization;
    }
    if (has(material, kStageAmbient)) {
        const bool environment = has(material, kStageEnvironment);
        light.ambient = (environment ? surrounding_light(frame.environments[static_cast<std::size_t>(material.environment)], normal)
                                     : hemisphere(frame.ambient, normal.y)) *
                        surface.occlusion;
        if constexpr (kSpecular) {
            const F n_dot_v = dot(normal, to_eye);
            const F twice = n_dot_v + n_dot_v;
            const F away = F(1.0f) - clamp(n_dot_v, F(0.0f), F(1.0f));
            const F away2 = away * away;
            light.grazing = (away2 * away2) * away;
            const V3 reflection{mad(twice, normal.x, F(0.0f) - to_eye.x), mad(twice, normal.y, F(0.0f) - to_eye.y),
                                mad(twice, normal.z, F(0.0f) - to_eye.z)};
            light.specular_ambient =
                (environment ? environment_light(frame.environments[static_cast<std::size_t>(material.specular_environment)], reflection)
                             : hemisphere(frame.ambient, reflection.y)) *
                surface.occlusion;
        }
    }
    return light;
}

/// Light that a surface of this base colour reflects to the eye.
template <bool kSpecular>
HALFLIT_INLINE V3 reflected(const shading::MaterialPlan& material, const IncidentLight& light, V3 base) {
    V3 albedo = base, f0{F(0.0f), F(0.0f), F(0.0f)};
    if constexpr (kSpecular) {
        const F dielectric = F(material.dielectric) * (F(1.0f) - light.metallic);  // no difference that could cancel
        f0 = base * light.metallic + V3{dielectric, dielectric, dielectric};
        albedo = base * ((F(1.0f) - light.metallic) * F(material.refracted));
    }
    V3 color{F(0.0f), F(0.0f), F(0.0f)};
    if (has(material, kStageLights)) {
        color = albedo * light.diffuse;
        if constexpr (kSpecular) color = color + f0 * light.specular;
    }
    if (has(material, kStageAmbient)) {
        color = color + albedo * light.ambient;
        if constexpr (kSpecular) {
            const V3 share{environment_reflectance(f0.x, light.roughness, light.grazing),
                           environment_reflectance(f0.y, light.roughness, light.grazing),
                           environment_reflectance(f0.z, light.roughness, light.grazing)};
            color = color + share * light.specular_ambient;
        }
    }
    return color;
}

HALFLIT_INLINE V3 emitted(const shading::MaterialPlan& material, const shading::FragmentBlock& block, int lane, TexelTaps& taps) {
    V3 emissive = broadcast(material.emissive);
    if (has(material, kStageEmissiveTexture)) {
        const Sample texture = sample_texture(material.emissive_texture, block, lane, taps);
        emissive = emissive * V3{texture.r, texture.g, texture.b};
    }
    return emissive;
}

template <bool kSpecular>
HALFLIT_INLINE void shade_block(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::LightList lights,
                                shading::FragmentBlock& block, int count) {
    for (int lane = 0; lane < count; lane += kWidth) {
        TexelTaps taps;
        const Sample base = base_color(material, block, lane, taps);
        V3 color{base.r, base.g, base.b};
        if (!has(material, kStageUnlit)) {
            if (has(material, kStagePrelit))
                color = color * row3(block, shading::kPosX, lane) + row3(block, shading::kNormalX, lane);
            else if ((material.stages & (kStageLights | kStageAmbient)) != 0)
                color = reflected<kSpecular>(material, incident_light<kSpecular>(frame, material, lights, block, lane, taps), color);
            else
                color = {F(0.0f), F(0.0f), F(0.0f)};
            color = color + emitted(material, block, lane, taps);
        }
        store(block.red + lane, color.x);
        store(block.green + lane, color.y);
        store(block.blue + lane, color.z);
        const bool blended = material.alpha_mode == AlphaMode::blend;
        store(block.alpha + lane, blended ? clamp(base.a, F(0.0f), F(1.0f)) : F(1.0f));
    }
}

/// Writes the reflected colour as factor and offset of the base colour. It is affine in the base colour except for a clamp in the specular
/// share, so the colours for black and white give both.
template <bool kSpecular>
HALFLIT_INLINE void light_block(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::LightList lights,
                                shading::FragmentBlock& block, int count) {
    for (int lane = 0; lane < count; lane += kWidth) {
        TexelTaps taps;
        const IncidentLight light = incident_light<kSpecular>(frame, material, lights, block, lane, taps);
        const F none(0.0f), full(1.0f);
        const V3 offset = reflected<kSpecular>(material, light, {none, none, none});
        const V3 factor = reflected<kSpecular>(material, light, {full, full, full}) - offset;
        store(&block.lane[shading::kPosX][lane], factor.x);
        store(&block.lane[shading::kPosY][lane], factor.y);
        store(&block.lane[shading::kPosZ][lane], factor.z);
        store(&block.lane[shading::kNormalX][lane], offset.x);
        store(&block.lane[shading::kNormalY][lane], offset.y);
        store(&block.lane[shading::kNormalZ][lane], offset.z);
    }
}

static void shade(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::LightList lights,
                  shading::FragmentBlock& block, int count) {
    if (has(material, kStageSpecular) && !has(material, kStagePrelit))
        shade_block<true>(frame, material, lights, block, count);
    else
        shade_block<false>(frame, material, lights, block, count);
}

static void light(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::LightList lights,
                  shading::FragmentBlock& block, int count) {
    if (has(material, kStageSpecular))
        light_block<true>(frame, material, lights, block, count);
    else
        light_block<false>(frame, material, lights, block, count);
}

static void hidden(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, const shading::LightPlan& light,
                   const shading::FragmentBlock& block, int count, float* core, float* excess) {
    const ShadowFade fade{material.shadow_fade_scale, material.shadow_turn_scale};
    const bool soft = frame.shadow_mode == ShadowMode::soft_split && fade.scale > 0.0f;
    for (int lane = 0; lane < count; lane += kWidth) {
        TexelTaps taps;
        const V3 position = row3(block, shading::kPosX, lane), surface = normals(material, block, lane, taps).surface;
        const HiddenShares share = hidden_share(frame.shadow_maps[light.shadow_map], looked_up(frame, block, lane), surface,
                                                arrival(light, position).direction, fade, soft);
        store(core + lane, share.hard);
        store(excess + lane, share.soft);
    }
}

static void shade_alpha(const shading::MaterialPlan& material, shading::FragmentBlock& block, int count) {
    for (int lane = 0; lane < count; lane += kWidth) {
        TexelTaps taps;
        store(block.alpha + lane, clamp(base_color(material, block, lane, taps).a, F(0.0f), F(1.0f)));
    }
}

static void encode(const float* red, const float* green, const float* blue, const float* alpha, float exposure, std::uint32_t* rgba8,
                   int count) {
    encode_srgb8(red, green, blue, alpha, exposure, rgba8, count);
}

}  // namespace HALFLIT_ISA_NAMESPACE

namespace shading {
#define HALFLIT_SHADE_KERNELS HALFLIT_CONCAT(shade_kernels_, HALFLIT_ISA)
extern const ShadeKernels HALFLIT_SHADE_KERNELS;
const ShadeKernels HALFLIT_SHADE_KERNELS = {shade, light, hidden, measure_cell, fit_cells, shade_alpha, encode};
}  // namespace shading
}  // namespace halflit
