// Light from behind that passes through a surface, or is scattered by it. These stages run only for materials that let it.
#pragma once

#include "shading/kernels/behind_kernel.hpp"
#include "shading/kernels/pow.hpp"
#include "shading/kernels/reflection_kernel.hpp"
#include "shading/kernels/shade_rows.hpp"
#include "shading/kernels/sky_shadow_kernel.hpp"
#include "shading/kernels/specular_color_kernel.hpp"
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

/// KHR_materials_diffuse_transmission: a share of what is scattered is light of the far side, which is lit as this one is, by the same
/// lobe. Takes it from the light of this side. What the far side gives is a layer of its own, as it does not have the base colour.
/// around(normal): light of the surroundings.
template <bool kSpecular, class Around>
[[gnu::noinline]] static void scatter_through(const shading::ShadingPlan& frame, const shading::MaterialPlan& material,
                                              shading::LightList lights, const shading::FragmentBlock& block, int count, ShadeRows& rows,
                                              const Around& around) {
    const F none(0.0f), one(1.0f);
    const auto behind = [](V3 v) __attribute__((always_inline)) { return V3{vneg(v.x), vneg(v.y), vneg(v.z)}; };
    for (int lane = 0; lane < count; lane += kWidth) {
        TexelTaps taps;
        F share(material.diffuse_transmission.share);
        V3 color = broadcast(material.diffuse_transmission.color);
        if (const auto& texture = material.textures[TextureSlot::diffuse_transmission]; texture.data != nullptr)
            share = share * sample_texture(texture, block, lane, taps).a;
        if (const auto& texture = material.textures[TextureSlot::diffuse_transmission_color]; texture.data != nullptr) {
            const Sample texel = sample_texture(texture, block, lane, taps);
            color = color * V3{texel.r, texel.g, texel.b};
        }
        // Shares of lights and surroundings that enter the surface.
        F enters = one, sky_enters = one;
        if constexpr (kSpecular) {
            F f0(material.dielectric), weight = one;
            if (has(material, kStageSpecularColor)) {
                const V3 dielectric = load3(rows.dielectric, lane);
                f0 = vmax(dielectric.x, vmax(dielectric.y, dielectric.z)), weight = load(rows.specular_weight + lane);
            }
            const F plastic = one - load(rows.metallic + lane);
            enters = plastic * (one - f0);
            sky_enters = has(material, kStageEnvironment) ? plastic * (one - SkyShare(material, rows, lane)(f0, weight)) : enters;
        }
        const F stays = one - share;
        if (has(material, kStageTransmission)) share = share * (one - load(rows.transmitted + lane));
        const V3 position = row3(block, shading::kPosX, lane), normal = behind(load3(rows.normal, lane));
        const ShadowReceiver receiver{
            frame, position, behind(load3(rows.surface, lane)), {material.shadow_fade_scale, material.shadow_turn_scale}};
        V3 light{none, none, none};
        if (has(material, kStageLights)) {
            store3(rows.diffuse, lane, load3(rows.diffuse, lane) * stays);
            light = sum_lobes(lights.lights, lights.count, material.lobe, receiver, position, normal).diffuse *
                    (F(material.lobe.scale) * enters);
        }
        if (has(material, kStageAmbient)) {
            store3(rows.ambient, lane, load3(rows.ambient, lane) * stays);
            const F occlusion = load(rows.occlusion + lane);
            V3 seen{occlusion, occlusion, occlusion};
            if (!frame.sky.empty()) {
                const V3 sky = sky_visibility<false>(receiver, material.lobe, normal, normal, one).diffuse;
                seen = {vmin(sky.x, occlusion), vmin(sky.y, occlusion), vmin(sky.z, occlusion)};
            }
            light = light + around(normal) * seen * sky_enters;
        }
        lay<kStageDiffuseTransmission>(material, rows, lane, light * color * share, one);
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
