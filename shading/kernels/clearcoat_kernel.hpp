// KHR_materials_clearcoat: a coat of F0 = 0.04 above all else that a surface reflects and emits. These stages run only for materials that
// have one.
//
//     light = (base + emission) (1 - c F) + coat        F = F0 + (1 - F0) (1 - N.V)^5, c: share that is coated, N: the coat's normal
//
// The coat has highlights of the frame's model, and reflections of the surroundings by one lobe. Blinn's and Phong's highlights, which have
// no Fresnel factor, are multiplied by c F.
#pragma once

#include "shading/kernels/environment_kernel.hpp"
#include "shading/kernels/ggx_kernel.hpp"
#include "shading/kernels/highlight_sums.hpp"
#include "shading/kernels/reflection_kernel.hpp"
#include "shading/kernels/shade_rows.hpp"
#include "shading/kernels/sky_shadow_kernel.hpp"
#include "shading/kernels/surface_kernel.hpp"
#include "shading/model/constants.hpp"
#include "shading/model/formulas.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// A coat at kWidth fragments.
struct Coat {
    F share;      ///< of the surface that is coated
    F roughness;  ///< at least kMinRoughness
    V3 normal;    ///< unit, turned to the visible side
};

HALFLIT_INLINE Coat fetch_coat(const shading::MaterialPlan& material, const shading::FragmentBlock& block, int lane,
                               const ShadeRows& rows) {
    const shading::ClearcoatPlan& plan = material.clearcoat;
    const BySlot<shading::TexturePlan>& textures = material.textures;
    TexelTaps taps;
    Coat coat{F(plan.factor), F(plan.roughness), load3(rows.surface, lane)};
    if (textures[TextureSlot::clearcoat].data != nullptr)
        coat.share = coat.share * sample_texture(textures[TextureSlot::clearcoat], block, lane, taps).r;
    if (textures[TextureSlot::clearcoat_roughness].data != nullptr)
        coat.roughness = coat.roughness * sample_texture(textures[TextureSlot::clearcoat_roughness], block, lane, taps).g;
    coat.roughness = vmax(coat.roughness, F(shading::kMinRoughness));
    if (textures[TextureSlot::clearcoat_normal].data != nullptr) {
        const Sample texel = sample_texture(textures[TextureSlot::clearcoat_normal], block, lane, taps);
        coat.normal =
            mapped_normal(block, lane, normalize_any(row3(block, shading::kNormalX, lane)), {texel.r, texel.g, texel.b}, plan.normal_scale);
        if (material.double_sided) coat.normal = coat.normal * row(block, shading::kFacing, lane);
        if (plan.normal_roughness) coat.roughness = rougher(coat.roughness, texel.a * F(plan.normal_scale));
    }
    return coat;
}

/// Highlights of the lights on a coat, its Fresnel factor included.
HALFLIT_INLINE V3 coat_highlights(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::LightList lights,
                                  const ShadowReceiver& receiver, V3 position, const Coat& coat, V3 to_eye, F fresnel, F more) {
    const F f0(shading::kCoatReflectance);
    const bool shadows = !frame.shadow_maps.empty();
    if (material.ggx) {
        const GgxView view = ggx_view(coat.normal, to_eye, coat.roughness);
        GgxSums sums;
        if (shadows)
            sum_ggx<true>(lights.lights, lights.count, shading::LobePlan{}, receiver, position, view, sums);
        else
            sum_ggx<false>(lights.lights, lights.count, shading::LobePlan{}, receiver, position, view, sums);
        return (sums.straight * f0 + sums.grazing) * mad(f0, more, F(1.0f));
    }
    const F half_exponent = half_specular_exponent(coat.roughness);
    F factor = fresnel;
    if (frame.normalize_specular) factor = factor * specular_normalization(half_exponent, frame.specular == SpecularModel::phong);
    const shading::SpecularCurve no_curve;
    const SpecularShape shape{frame.specular, shading::PowTier::exact, 0.0f, no_curve, half_exponent, F(1.0f)};
    const auto no_lobe = [](F) __attribute__((always_inline)) { return F(0.0f); };
    const PowerHighlight highlight{shape};
    const LightSums sums =
        shadows ? sum_highlights<true>(no_lobe, highlight, lights.lights, lights.count, receiver, position, coat.normal, to_eye)
                : sum_highlights<false>(no_lobe, highlight, lights.lights, lights.count, receiver, position, coat.normal, to_eye);
    return sums.specular * factor;
}

[[gnu::noinline]] static void dim_emission(ShadeRows& rows, int count) {
    for (int lane = 0; lane < count; lane += kWidth) store3(rows.emitted, lane, load3(rows.emitted, lane) * load(rows.passed_coat + lane));
}

/// Takes what the coat mirrors from all light of the surface below. Sets the rows `layers`, `passed_layers` and
/// `passed_coat`.
[[gnu::noinline]] static void add_clearcoat(const shading::ShadingPlan& frame, const shading::MaterialPlan& material,
                                            shading::LightList lights, const shading::FragmentBlock& block, int count, ShadeRows& rows) {
    const F none(0.0f), one(1.0f), f0(shading::kCoatReflectance);
    for (int lane = 0; lane < count; lane += kWidth) {
        const Coat coat = fetch_coat(material, block, lane, rows);
        const V3 to_eye = load3(rows.to_eye, lane);
        const F n_dot_v = dot(coat.normal, to_eye), held = clamp(n_dot_v, none, one);
        const F grazing = fifth_power(one - held), fresnel = mad(one - f0, grazing, f0);
        const bool environment = has(material, kStageEnvironment);
        MirrorShape shape{};
        F more(0.0f);
        if (environment || material.ggx) {
            shape = mirror_shape(coat.roughness, held);
            more = vdiv(one, shape.a + shape.b) - one;
        }
        const ShadowReceiver receiver{
            frame, looked_up(frame, block, lane), load3(rows.surface, lane), {material.shadow_fade_scale, material.shadow_turn_scale}};
        V3 light{none, none, none};
        if (has(material, kStageLights))
            light = coat_highlights(frame, material, lights, receiver, row3(block, shading::kPosX, lane), coat, to_eye, fresnel, more);
        if (has(material, kStageAmbient)) {
            const V3 reflection = coat.normal * (n_dot_v + n_dot_v) - to_eye;
            F seen = load(rows.occlusion + lane);
            if (!frame.sky.empty())
                seen = vmin(sky_visibility<true>(receiver, material.lobe, coat.normal, reflection, coat.roughness).mirrored, seen);
            V3 mirrored;
            if (environment)
                mirrored = mirrored_radiance(frame.reflections, 1, shape, coat.normal, n_dot_v, reflection) *
                           sky_share(shape.a, shape.b, more, f0);
            else
                mirrored = hemisphere(frame.ambient, reflection.y) * environment_reflectance(f0, coat.roughness, grazing);
            light = light + mirrored * seen;
        }
        const F passed = one - coat.share * fresnel;
        dim_base(material, rows, lane, passed);
        lay<kStageClearcoat>(material, rows, lane, light * coat.share, passed);
        store(rows.passed_layers + lane, has(material, kStageSheen) ? load(rows.passed_layers + lane) * passed : passed);
        store(rows.passed_coat + lane, passed);
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
