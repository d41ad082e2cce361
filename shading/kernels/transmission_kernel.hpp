// Light from behind that passes through a surface. These stages run only for materials that transmit.
#pragma once

#include "shading/kernels/behind_kernel.hpp"
#include "shading/kernels/pow.hpp"
#include "shading/kernels/reflection_kernel.hpp"
#include "shading/kernels/shade_rows.hpp"
#include "shading/kernels/surface_kernel.hpp"
#include "shading/model/formulas.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Reads the textures: sets the rows `transmitted`, `passed` and `thickness`. A body counts once, where light enters it at a front face.
[[gnu::noinline]] static void fetch_transmission(const shading::MaterialPlan& material, const shading::FragmentBlock& block, int count,
                                                 ShadeRows& rows) {
    const shading::TransmissionPlan& plan = material.transmission;
    for (int lane = 0; lane < count; lane += kWidth) {
        TexelTaps taps;
        F share(plan.share);
        if (material.textures[TextureSlot::transmission].data != nullptr)
            share = share * sample_texture(material.textures[TextureSlot::transmission], block, lane, taps).r;
        V3 passed = broadcast(plan.passed);
        F thickness(plan.thickness);
        if (material.textures[TextureSlot::thickness].data != nullptr) {
            const F depth = sample_texture(material.textures[TextureSlot::thickness], block, lane, taps).g, negative = vneg(depth);
            passed = {exp2_floored(kExp2Degree6, negative * F(plan.absorbed[0])),
                      exp2_floored(kExp2Degree6, negative * F(plan.absorbed[1])),
                      exp2_floored(kExp2Degree6, negative * F(plan.absorbed[2]))};
            thickness = thickness * depth;
        }
        if (material.double_sided) {
            const M front = row(block, shading::kFacing, lane) > F(0.0f);
            const F all(1.0f);
            passed = {sel(front, passed.x, all), sel(front, passed.y, all), sel(front, passed.z, all)};
            thickness = sel(front, thickness, F(0.0f));
        }
        store(rows.transmitted + lane, share);
        store3(rows.passed, lane, passed);
        store(rows.thickness + lane, thickness);
    }
}

/// Takes the light that passes through from the light that the surface scatters.
[[gnu::noinline]] static void dim_matt_light(const shading::MaterialPlan& material, int count, ShadeRows& rows) {
    for (int lane = 0; lane < count; lane += kWidth) {
        const F left = F(1.0f) - load(rows.transmitted + lane);
        if (has(material, kStageLights)) store3(rows.diffuse, lane, load3(rows.diffuse, lane) * left);
        if (has(material, kStageAmbient)) store3(rows.ambient, lane, load3(rows.ambient, lane) * left);
    }
}

/// Share of the light from behind that the surface mirrors back, which is also what it mirrors of the surroundings. `seen`: the rows of
/// directions are set; without them it is F0.
HALFLIT_INLINE F mirrored_back(const shading::MaterialPlan& material, const ShadeRows& rows, int lane, bool seen) {
    F f0(material.dielectric), weight(1.0f);
    if (!seen) return f0;
    if (has(material, kStageSpecularColor)) {
        const V3 dielectric = load3(rows.dielectric, lane);
        f0 = vmax(dielectric.x, vmax(dielectric.y, dielectric.z)), weight = load(rows.specular_weight + lane);
    }
    if (has(material, kStageEnvironment))
        return sky_share(load(rows.share_a + lane), load(rows.share_b + lane) * weight, load(rows.share_more + lane), f0);
    const F away = F(1.0f) - clamp(dot(load3(rows.normal, lane), load3(rows.to_eye, lane)), F(0.0f), F(1.0f));
    return mad(vmax((F(1.0f) - load(rows.roughness + lane)) * weight, f0) - f0, fifth_power(away), f0);
}

/// Sets the block's alpha and what it keeps of the light behind it: 1 - a + a t (1 - S) (1 - metallic) base passed. Where the material
/// blurs or bends that light, most of it is added to the block's colours instead.
[[gnu::noinline]] static void keep_light_behind(const shading::ShadingPlan& frame, const shading::MaterialPlan& material,
                                                const ShadeRows& rows, shading::FragmentBlock& block, int count, bool seen) {
    const bool through = seen && material.transmission.looked_through && frame.behind.rgba != nullptr;
    const F none(0.0f), full(1.0f);
    for (int lane = 0; lane < count; lane += kWidth) {
        F alpha = full, share = load(rows.transmitted + lane);
        if (material.alpha_mode != AlphaMode::opaque) alpha = clamp(load(rows.alpha + lane), none, full);
        if (material.alpha_mode == AlphaMode::mask) alpha = sel(alpha >= F(material.alpha_cutoff), full, none);
        if (has(material, kStageSpecular)) {
            TexelTaps taps;
            const F metallic = seen ? load(rows.metallic + lane) : reflectance(material, block, lane, taps).metallic;
            share = share * ((full - mirrored_back(material, rows, lane, seen)) * (full - metallic));
        }
        if (seen && (has(material, kStageClearcoat) || has(material, kStageSheen))) share = share * load(rows.passed_layers + lane);
        V3 keep = (load3(rows.base, lane) * load3(rows.passed, lane)) * (alpha * share);
        if (through) {
            const LookedThrough behind = look_through(frame, material, rows, block, lane);
            const V3 light = (load3(rows.base, lane) * load3(rows.passed, lane)) * share * behind.light;
            store(block.red + lane, load(block.red + lane) + light.x);
            store(block.green + lane, load(block.green + lane) + light.y);
            store(block.blue + lane, load(block.blue + lane) + light.z);
            keep = keep * behind.clear;
        }
        const F beside = full - alpha;
        store(block.keep[0] + lane, clamp(beside + keep.x, none, full));
        store(block.keep[1] + lane, clamp(beside + keep.y, none, full));
        store(block.keep[2] + lane, clamp(beside + keep.z, none, full));
        store(block.alpha + lane, alpha);
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
