// The shading kernel: one source, compiled once for each instruction set.
#pragma once

#include "shading/kernels/color_kernel.hpp"
#include "shading/kernels/shade_stages.hpp"
#include "shading/kernels/texel_rows_kernel.hpp"
#include "shading/kernels/tone_kernel.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Adds the layers above the base to the block's colours.
[[gnu::noinline]] static void lay_layers(const ShadeRows& rows, shading::FragmentBlock& block, int count) {
    float* const colors[] = {block.red, block.green, block.blue};
    for (int c = 0; c < 3; ++c)
        for (int lane = 0; lane < count; lane += kWidth) store(colors[c] + lane, load(colors[c] + lane) + load(rows.layers[c] + lane));
}

template <bool kSpecular>
HALFLIT_INLINE void shade_block(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::LightList lights,
                                shading::FragmentBlock& block, int count) {
    ShadeRows rows;
    fetch_surfaces(material, block, count, true, rows);
    const bool prelit = has(material, kStagePrelit), lit = (material.stages & kSurfaceStages) != 0;
    if (lit && !prelit) add_light<kSpecular>(frame, material, lights, block, count, rows);
    const bool layered = !prelit && (material.stages & kLayerStages) != 0;
    if (layered && has(material, kStageClearcoat)) dim_emission(rows, count);
    for (int lane = 0; lane < count; lane += kWidth) {
        V3 color = load3(rows.base, lane);
        if (!has(material, kStageUnlit)) {
            if (prelit)
                color = color * row3(block, shading::kPosX, lane) + row3(block, shading::kNormalX, lane);
            else if (lit)
                color = reflected<kSpecular>(material, rows, lane, color);
            else
                color = {F(0.0f), F(0.0f), F(0.0f)};
            color = color + load3(rows.emitted, lane);
        }
        store(block.red + lane, color.x);
        store(block.green + lane, color.y);
        store(block.blue + lane, color.z);
        const bool blended = material.alpha_mode == AlphaMode::blend;
        store(block.alpha + lane, blended ? clamp(load(rows.alpha + lane), F(0.0f), F(1.0f)) : F(1.0f));
    }
    if (layered) lay_layers(rows, block, count);
    if (has(material, kStageShadowCatcher))
        catch_shadows(
            frame, material, lights, rows, block,
            count, [&](V3 normal) __attribute__((always_inline)) { return surroundings_at(frame, material, normal); });
    if (has(material, kStageTransmission)) {
        if (prelit) fetch_transmission(material, block, count, rows);
        keep_light_behind(frame, material, rows, block, count, !prelit);
    }
}

/// Writes the reflected colour as factor and offset of the base colour. It is affine in the base colour except for a clamp in the specular
/// share, so the colours for black and white give both.
template <bool kSpecular>
HALFLIT_INLINE void light_block(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::LightList lights,
                                shading::FragmentBlock& block, int count) {
    ShadeRows rows;
    fetch_surfaces(material, block, count, false, rows);
    add_light<kSpecular>(frame, material, lights, block, count, rows);
    for (int lane = 0; lane < count; lane += kWidth) {
        const F none(0.0f), full(1.0f);
        V3 offset = reflected<kSpecular>(material, rows, lane, {none, none, none});
        const V3 factor = reflected<kSpecular>(material, rows, lane, {full, full, full}) - offset;
        if ((material.stages & kLayerStages) != 0) offset = offset + load3(rows.layers, lane);
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
        const V3 looked_up_at = looked_up(frame, block, lane);
        const HiddenShares share = hidden_share(frame, light, looked_up_at, surface, arrival(light, position).direction, fade, soft);
        store(core + lane, share.hard);
        store(excess + lane, share.soft);
    }
}

static void hidden_sky(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, const shading::FragmentBlock& block,
                       int count, float (&terms)[shading::kGridTerms][shading::kBlockSize]) {
    for (int lane = 0; lane < count; lane += kWidth) {
        TexelTaps taps;
        const V3 surface = normals(material, block, lane, taps).surface;
        const GridLight light = grid_light(frame.sky_grid, looked_up(frame, block, lane), surface);
        const F values[shading::kGridTerms] = {light.one, light.x, light.y, light.z, light.xx, light.yy, light.xy, light.xz, light.yz};
        for (int k = 0; k < shading::kGridTerms; ++k) store(terms[k] + lane, values[k]);
    }
}

static void shade_alpha(const shading::MaterialPlan& material, shading::FragmentBlock& block, int count) {
    for (int lane = 0; lane < count; lane += kWidth) {
        TexelTaps taps;
        store(block.alpha + lane, clamp(base_color(material, block, lane, taps).a, F(0.0f), F(1.0f)));
    }
}

static void surface(const shading::MaterialPlan& material, shading::FragmentBlock& block, int count) {
    for (int lane = 0; lane < count; lane += kWidth) {
        TexelTaps taps;
        const Sample base = base_color(material, block, lane, taps);
        const V3 normal = normals(material, block, lane, taps).shading;
        store(block.red + lane, base.r);
        store(block.green + lane, base.g);
        store(block.blue + lane, base.b);
        store(block.alpha + lane, base.a);
        store(&block.lane[shading::kNormalX][lane], normal.x);
        store(&block.lane[shading::kNormalY][lane], normal.y);
        store(&block.lane[shading::kNormalZ][lane], normal.z);
    }
}

static void count_lights(shading::LightList lights, const shading::FragmentBlock& block, int count, std::uint32_t* number) {
    for (int lane = 0; lane < count; lane += kWidth) {
        const V3 position = row3(block, shading::kPosX, lane);
        F sum(0.0f);  // exact up to 2^24
        for (int i = 0; i < lights.count; ++i) sum = sum + sel(arrival(lights.lights[i], position).attenuation > F(0.0f), F(1.0f), F(0.0f));
        alignas(64) float sums[kWidth];
        store(sums, sum);
        for (int l = 0; l < kWidth && lane + l < count; ++l) number[lane + l] = static_cast<std::uint32_t>(sums[l]);
    }
}

static void tone(ToneCurve curve, const float* const light[3], float exposure, float* const display[3], int count) {
    if (curve == ToneCurve::reinhard)
        tone_block<ToneCurve::reinhard>(light, exposure, display, count);
    else if (curve == ToneCurve::aces)
        tone_block<ToneCurve::aces>(light, exposure, display, count);
    else
        tone_block<ToneCurve::neutral>(light, exposure, display, count);
}

static int tone_samples(ToneCurve curve, const shading::SampleRows& in, int count, float* const sums[4]) {
    if (curve == ToneCurve::reinhard) return toned_sums<ToneCurve::reinhard>(in, count, sums);
    if (curve == ToneCurve::aces) return toned_sums<ToneCurve::aces>(in, count, sums);
    return toned_sums<ToneCurve::neutral>(in, count, sums);
}

static void encode(const float* red, const float* green, const float* blue, const float* alpha, float exposure, std::uint32_t* rgba8,
                   int count) {
    encode_srgb8(red, green, blue, alpha, exposure, rgba8, count);
}

}  // namespace HALFLIT_ISA_NAMESPACE

namespace shading {
#define HALFLIT_SHADE_KERNELS HALFLIT_CONCAT(shade_kernels_, HALFLIT_ISA)
extern const ShadeKernels HALFLIT_SHADE_KERNELS;
const ShadeKernels HALFLIT_SHADE_KERNELS = {shade,        light,        hidden,       hidden_sky,  measure_cell, fit_cells,
                                            shade_alpha,  surface,      count_lights, tone,        tone_samples, encode,
                                            halve_texels, unit_normals, halve_means,  lost_lengths};
}  // namespace shading
}  // namespace halflit
