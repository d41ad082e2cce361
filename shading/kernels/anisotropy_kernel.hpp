// KHR_materials_anisotropy: brushed surfaces, rougher along a direction than across it. These stages run only for materials that are.
//
// Across the direction the width of facets is alpha = roughness^2, along it alpha + (1 - alpha) strength^2. Other stages see the roughness
// whose alpha is the geometric mean of both: with it highlights have the right brightness, and a uniform sky is reflected as much.
#pragma once

#include "shading/kernels/ggx_kernel.hpp"
#include "shading/kernels/light_kernel.hpp"
#include "shading/kernels/pow.hpp"
#include "shading/kernels/reflection_kernel.hpp"
#include "shading/kernels/shade_rows.hpp"
#include "shading/kernels/surface_kernel.hpp"
#include "shading/model/constants.hpp"
#include "shading/model/formulas.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Sets the rows `along`, `alpha_along` and `alpha_across`, and those that follow from the roughness.
[[gnu::noinline]] static void fetch_anisotropy(const shading::ShadingPlan& frame, const shading::MaterialPlan& material,
                                               const shading::FragmentBlock& block, int count, ShadeRows& rows) {
    const shading::AnisotropyPlan& plan = material.anisotropy;
    const F none(0.0f), one(1.0f), two(2.0f);
    for (int lane = 0; lane < count; lane += kWidth) {
        TexelTaps taps;
        F strength(plan.strength), x = one, y = none;
        if (material.textures[TextureSlot::anisotropy].data != nullptr) {
            const Sample texel = sample_texture(material.textures[TextureSlot::anisotropy], block, lane, taps);
            x = mad(two, texel.r, F(-1.0f)), y = mad(two, texel.g, F(-1.0f));
            strength = strength * texel.b;
        }
        const V3 mesh_normal = normalize_any(row3(block, shading::kNormalX, lane)),
                 tangent = normalize_any(row3(block, shading::kTangentX, lane));
        const V3 bitangent = cross(mesh_normal, tangent) * row(block, shading::kTangentW, lane);
        const V3 normal = load3(rows.normal, lane);
        const V3 turned = tangent * (F(plan.cosine) * x - F(plan.sine) * y) + bitangent * (F(plan.sine) * x + F(plan.cosine) * y);
        const V3 flat = turned - normal * dot(normal, turned);
        // Where the direction is short, because opposite ones were averaged or the normal leans along it, it counts less.
        const F squared = dot(flat, flat);
        strength = strength * vmin(F(shading::kShortDirection) * squared, one);
        const M lost = squared < F(1e-12f), x_axis = vabs(normal.x) < F(0.7f);
        const V3 side{sel(x_axis, none, vneg(normal.z)), sel(x_axis, normal.z, none), sel(x_axis, vneg(normal.y), normal.x)};
        const F roughness = load(rows.roughness + lane), across = roughness * roughness;
        const F along = mad(strength * strength, one - across, across), mean = vsqrt(vsqrt(along * across));
        store3(rows.along, lane, normalize({sel(lost, side.x, flat.x), sel(lost, side.y, flat.y), sel(lost, side.z, flat.z)}));
        store(rows.alpha_along + lane, along);
        store(rows.alpha_across + lane, across);
        store(rows.roughness + lane, mean);
        const F half_exponent = half_specular_exponent(mean);
        store(rows.half_exponent + lane, half_exponent);
        if (frame.normalize_specular) store(rows.normalization + lane, specular_normalization(half_exponent, false));
    }
}

/// Values that all lights of a fragment share.
struct StretchedView {
    V3 normal, to_eye, along, beside;
    F alpha_along, alpha_across, n_dot_v, v;
    F half_exponent_along, half_exponent_across;
};
HALFLIT_INLINE StretchedView stretched_view(const ShadeRows& rows, int lane, bool ggx) {
    StretchedView out{load3(rows.normal, lane),
                      load3(rows.to_eye, lane),
                      load3(rows.along, lane),
                      {},
                      load(rows.alpha_along + lane),
                      load(rows.alpha_across + lane),
                      F(0.0f),
                      F(0.0f),
                      F(0.0f),
                      F(0.0f)};
    const F one(1.0f);
    out.beside = cross(out.normal, out.along);
    if (ggx) {
        const F along = out.alpha_along * dot(out.along, out.to_eye), beside = out.alpha_across * dot(out.beside, out.to_eye);
        out.n_dot_v = clamp(dot(out.normal, out.to_eye), F(0.0f), one);
        out.v = vsqrt(along * along + beside * beside + out.n_dot_v * out.n_dot_v);
    } else {
        out.half_exponent_along = vdiv(one, out.alpha_along * out.alpha_along) - one;
        out.half_exponent_across = vdiv(one, out.alpha_across * out.alpha_across) - one;
    }
    return out;
}

/// (N.H)^s N.L with an exponent between those along and across, by the side to which H leans.
HALFLIT_INLINE F stretched_blinn(const StretchedView& view, V3 to_light, F n_dot_l) {
    const F none(0.0f);
    const V3 half = to_light + view.to_eye;
    const F cosine = dot(view.normal, half);
    const M shines = (n_dot_l > none) & (cosine > none);
    if (!any(shines)) return none;
    const F inv_squared = vdiv(F(1.0f), vmax(dot(half, half), F(1e-30f)));
    const F x = dot(view.along, half), y = dot(view.beside, half), xx = (x * x) * inv_squared, yy = (y * y) * inv_squared;
    const F sine_squared = xx + yy;
    const F half_exponent = vdiv(xx * view.half_exponent_along + yy * view.half_exponent_across, vmax(sine_squared, F(1e-30f)));
    const F power = power_of_cosine(shading::PowTier::exact, (cosine * cosine) * inv_squared, sine_squared, half_exponent);
    return sel(shines, n_dot_l * power, none);
}

/// As ggx_highlight: pi D V (N.L) of [Heitz14] with two widths.
HALFLIT_INLINE F stretched_ggx(const StretchedView& view, V3 to_light, F n_dot_l, F& grazing) {
    const F none(0.0f), one(1.0f), half_of(0.5f);
    const V3 half = to_light + view.to_eye;
    const F cosine = dot(view.normal, half), squared = dot(half, half);
    const M shines = (n_dot_l > none) & (cosine > F(shading::kLeastHalfVector));
    grazing = none;
    if (!any(shines)) return none;
    const F both = view.alpha_along * view.alpha_across;
    const F x = view.alpha_across * dot(view.along, half), y = view.alpha_along * dot(view.beside, half), z = both * cosine;
    const F facets = vdiv(both * squared, (x * x + y * y) + z * z);
    const F l_x = view.alpha_along * dot(view.along, to_light), l_y = view.alpha_across * dot(view.beside, to_light);
    const F l = vsqrt((l_x * l_x + l_y * l_y) + n_dot_l * n_dot_l);
    const F masking = n_dot_l * view.v + view.n_dot_v * l;
    grazing = fifth_power(one - vmin(half_of * vsqrt(squared), one));
    return sel(shines, vdiv((half_of * n_dot_l) * (both * (facets * facets)), masking), none);
}

/// The stage of lights. Phong's highlights are Blinn's.
[[gnu::noinline]] static void add_stretched_lights(const shading::ShadingPlan& frame, const shading::MaterialPlan& material,
                                                   shading::LightList lights, const shading::FragmentBlock& block, int count,
                                                   ShadeRows& rows) {
    for (int lane = 0; lane < count; lane += kWidth) {
        const StretchedView view = stretched_view(rows, lane, material.ggx);
        const ShadowReceiver receiver{
            frame, looked_up(frame, block, lane), load3(rows.surface, lane), {material.shadow_fade_scale, material.shadow_turn_scale}};
        const V3 position = row3(block, shading::kPosX, lane);
        GgxSums sums;
        for (int i = 0; i < lights.count; ++i) {
            const shading::LightPlan& light = lights.lights[i];
            const LocalLight from = arrival(light, position);
            const F n_dot_l = dot(view.normal, from.direction);
            F diffuse = lobe_value(material.lobe, n_dot_l), grazing(0.0f);
            F highlight =
                material.ggx ? stretched_ggx(view, from.direction, n_dot_l, grazing) : stretched_blinn(view, from.direction, n_dot_l);
            if (light.shadow_map >= 0) cast_shadow<true>(receiver, light, from.direction, from.attenuation, n_dot_l, diffuse, highlight);
            const V3 color = broadcast(light.color);
            const F strength = highlight * from.attenuation, at_grazing = strength * grazing;
            sums.diffuse = sums.diffuse + color * (diffuse * from.attenuation);
            sums.straight = sums.straight + color * (strength - at_grazing);
            sums.grazing = sums.grazing + color * at_grazing;
        }
        store3(rows.diffuse, lane, sums.diffuse * F(material.lobe.scale));
        if (!material.ggx) {
            store3(rows.specular, lane, sums.straight * load(rows.normalization + lane));
            continue;
        }
        store3(rows.specular, lane, sums.straight);
        store3(rows.specular_grazing, lane, sums.grazing);
        store_bounced(material, rows, lane, view.n_dot_v);
    }
}

/// Mean radiance of an environment over four mirrors, whose normals lean to either side along the direction.
[[gnu::noinline]] static V3 stretched_radiance(const shading::ShadingPlan& frame, const ShadeRows& rows, int lane) {
    const F none(0.0f), one(1.0f), along = load(rows.alpha_along + lane), across = load(rows.alpha_across + lane);
    const V3 normal = load3(rows.normal, lane), side = load3(rows.along, lane), to_eye = load3(rows.to_eye, lane);
    const F squared = vmax(along * along - across * across, none), spread = vsqrt(squared), width(shading::kStretchWidth);
    const F alpha = vmin(vsqrt(across * across + (width * width) * squared), one), roughness = vsqrt(alpha);
    V3 sum{none, none, none};
    for (const shading::StretchTap& tap : shading::kStretchTaps) {
        V3 leaning = normalize(normal + side * (spread * F(tap.place)));
        // A mirror that is turned away from the viewer is turned back to the edge.
        const F turned = vmax(F(shading::kStretchEdge) - dot(leaning, to_eye), none);
        leaning = normalize(leaning + to_eye * (turned + turned));
        const F n_dot_v = dot(leaning, to_eye);
        const V3 reflection = leaning * (n_dot_v + n_dot_v) - to_eye;
        const MirrorShape shape = mirror_shape(roughness, clamp(n_dot_v, none, one));
        sum = sum + mirrored_radiance(frame.reflections, 1, shape, leaning, n_dot_v, reflection) * F(tap.weight);
    }
    return sum;
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
