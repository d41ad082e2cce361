// Highlights of lights by GGX [Walter07] with Smith's height-correlated masking [Heitz14] and Schlick's Fresnel factor.
//
// With h = L + V, which is not normalised, a = roughness^2 and q = |N x h|^2 + a^2 (N.h)^2, the highlight without its Fresnel factor is
//
//     pi D G (N.L) / (4 (N.L) (N.V)) = a^2 |h|^4 (N.L) / (2 q^2 ((N.L) v + (N.V) l))        v, l = sqrt((1 - a^2) (N.V or N.L)^2 + a^2)
//
// so a light takes two roots and one division. q has no difference that could cancel near the peak. V.H = |h| / 2 for unit vectors.
#pragma once

#include "shading/kernels/light_kernel.hpp"
#include "shading/kernels/reflection_kernel.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/kernels/shade_rows.hpp"
#include "shading/model/constants.hpp"
#include "shading/model/formulas.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Values that all lights of a fragment share.
struct GgxView {
    V3 normal, to_eye;
    F alpha_squared, rest;  ///< a^2, 1 - a^2
    F n_dot_v, v;           ///< N.V from 0; v of the formula
};
HALFLIT_INLINE GgxView ggx_view(V3 normal, V3 to_eye, F roughness) {
    const F alpha = roughness * roughness, alpha_squared = alpha * alpha, rest = F(1.0f) - alpha_squared;
    const F n_dot_v = clamp(dot(normal, to_eye), F(0.0f), F(1.0f));
    return {normal, to_eye, alpha_squared, rest, n_dot_v, vsqrt((n_dot_v * n_dot_v) * rest + alpha_squared)};
}

/// The highlight without its Fresnel factor, and Schlick's (1 - V.H)^5. False if no lane has one.
HALFLIT_INLINE bool ggx_highlight(const GgxView& view, V3 to_light, F n_dot_l, F& highlight, F& grazing) {
    const F none(0.0f), one(1.0f);
    const V3 half = to_light + view.to_eye, sine = cross(view.normal, half);
    const F cosine = dot(view.normal, half), squared = dot(half, half);
    const M shines = (n_dot_l > none) & (cosine > F(shading::kLeastHalfVector));
    highlight = grazing = none;
    if (!any(shines)) return false;
    const F l = vsqrt((n_dot_l * n_dot_l) * view.rest + view.alpha_squared);
    const F masking = n_dot_l * view.v + view.n_dot_v * l;
    const F q = dot(sine, sine) + view.alpha_squared * (cosine * cosine);
    const F value = vdiv((n_dot_l * view.alpha_squared) * (squared * squared), (masking + masking) * (q * q));
    highlight = sel(shines, value, none);
    grazing = fifth_power(one - vmin(F(0.5f) * vsqrt(squared), one));
    return true;
}

/// Sums over the lights: through the lobe; highlights times 1 - (1 - V.H)^5, which F0 multiplies; and times (1 - V.H)^5.
struct GgxSums {
    V3 diffuse{F(0.0f), F(0.0f), F(0.0f)}, straight{F(0.0f), F(0.0f), F(0.0f)}, grazing{F(0.0f), F(0.0f), F(0.0f)};
};

/// Lights between two stages, at kWidth fragments; see highlight_sums.hpp.
struct GgxBatch {
    static constexpr int kSize = 8;
    using Rows = float[kSize][kWidth];
    alignas(64) Rows x, y, z, attenuation, n_dot_l, lobe, highlight, grazing;
    bool shines[kSize];
};

template <bool kShadows>
HALFLIT_INLINE void sum_ggx(const shading::LightPlan* lights, int count, const shading::LobePlan& lobe, const ShadowReceiver& receiver,
                            V3 position, const GgxView& view, GgxSums& sums) {
    GgxBatch batch;
    for (; count > 0; lights += GgxBatch::kSize, count -= GgxBatch::kSize) {
        const int size = count < GgxBatch::kSize ? count : GgxBatch::kSize;
        for (int i = 0; i < size; ++i) {
            V3 direction = broadcast(lights[i].to_light);
            F attenuation(1.0f);
            if (lights[i].type != LightType::directional) local_light(lights[i], position, direction, attenuation);
            store(batch.x[i], direction.x);
            store(batch.y[i], direction.y);
            store(batch.z[i], direction.z);
            store(batch.attenuation[i], attenuation);
        }
        for (int i = 0; i < size; ++i) {
            const V3 direction{load(batch.x[i]), load(batch.y[i]), load(batch.z[i])};
            const F n_dot_l = dot(view.normal, direction);
            F highlight, grazing;
            batch.shines[i] = ggx_highlight(view, direction, n_dot_l, highlight, grazing);
            store(batch.lobe[i], lobe_value(lobe, n_dot_l));
            store(batch.n_dot_l[i], n_dot_l);
            store(batch.highlight[i], highlight);
            store(batch.grazing[i], grazing);
        }
        for (int i = 0; i < size; ++i) {
            const V3 color = broadcast(lights[i].color);
            const F attenuation = load(batch.attenuation[i]);
            F diffuse = load(batch.lobe[i]), highlight = load(batch.highlight[i]);
            if constexpr (kShadows)
                if (lights[i].shadow_map >= 0)
                    cast_shadow<true>(receiver, lights[i], {load(batch.x[i]), load(batch.y[i]), load(batch.z[i])}, attenuation,
                                      load(batch.n_dot_l[i]), diffuse, highlight);
            sums.diffuse = sums.diffuse + color * (diffuse * attenuation);
            if (!batch.shines[i]) continue;
            const F strength = highlight * attenuation, at_grazing = strength * load(batch.grazing[i]);
            sums.straight = sums.straight + color * (strength - at_grazing);
            sums.grazing = sums.grazing + color * at_grazing;
        }
    }
}

/// Sets the row `share_more`, if the surroundings do not.
HALFLIT_INLINE void store_bounced(const shading::MaterialPlan& material, ShadeRows& rows, int lane, F n_dot_v) {
    if ((material.stages & kStageEnvironment) != 0) return;
    const MirrorShape shape = mirror_shape(load(rows.roughness + lane), n_dot_v);
    store(rows.share_more + lane, vdiv(F(1.0f), shape.a + shape.b) - F(1.0f));
}

/// The stage of lights, for materials with GGX highlights. `shadow_point(lane)`: where shadows are looked up.
template <class ShadowPoint>
HALFLIT_INLINE void add_ggx_lights(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::LightList lights,
                                   const shading::FragmentBlock& block, int count, const ShadowPoint& shadow_point, ShadeRows& rows) {
    for (int lane = 0; lane < count; lane += kWidth) {
        const F roughness = load(rows.roughness + lane);
        const GgxView view = ggx_view(load3(rows.normal, lane), load3(rows.to_eye, lane), roughness);
        const ShadowReceiver receiver{
            frame, shadow_point(lane), load3(rows.surface, lane), {material.shadow_fade_scale, material.shadow_turn_scale}};
        const V3 position = row3(block, shading::kPosX, lane);
        GgxSums sums;
        if (frame.shadow_maps.empty())
            sum_ggx<false>(lights.lights, lights.count, material.lobe, receiver, position, view, sums);
        else
            sum_ggx<true>(lights.lights, lights.count, material.lobe, receiver, position, view, sums);
        store3(rows.diffuse, lane, sums.diffuse * F(material.lobe.scale));
        store3(rows.specular, lane, sums.straight);
        store3(rows.specular_grazing, lane, sums.grazing);
        store_bounced(material, rows, lane, view.n_dot_v);
    }
}

/// All highlights of a surface, with light that bounces between its facets [Turquin19]. `weight`: factor at grazing views.
HALFLIT_INLINE V3 ggx_reflected(const ShadeRows& rows, int lane, V3 f0, F weight) {
    const V3 once = f0 * load3(rows.specular, lane) + load3(rows.specular_grazing, lane) * weight;
    const F more = load(rows.share_more + lane), one(1.0f);
    return once * V3{mad(f0.x, more, one), mad(f0.y, more, one), mad(f0.z, more, one)};
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
