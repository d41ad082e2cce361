// KHR_materials_sheen: fibres above the surface, which glow at grazing views. These stages run only for materials that have them.
//
//     light = base (1 - m E) + color sheen        m: the largest channel of the colour, E: albedo of white sheen, at most 1
//
// The sheen of a light is D V2 (N.L), by Charlie's distribution (model/sheen_table.hpp), divided by its albedo where that is above 1. The
// sheen of the surroundings is E times their mean radiance over three lobes.
#pragma once

#include "shading/kernels/environment_kernel.hpp"
#include "shading/kernels/light_kernel.hpp"
#include "shading/kernels/reflection_kernel.hpp"
#include "shading/kernels/shade_rows.hpp"
#include "shading/kernels/sky_shadow_kernel.hpp"
#include "shading/kernels/surface_kernel.hpp"
#include "shading/model/constants.hpp"
#include "shading/model/sheen_table.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// kSheenShapes at a roughness in [kMinRoughness, 1] and a cosine N.V in [0, 1].
struct SheenAt {
    F albedo, height, level, turn;
};
HALFLIT_INLINE SheenAt sheen_at(F roughness, F n_dot_v) {
    constexpr int kLast = shading::kReflectionNodes - 1;
    const F x = roughness * F(kLast), y = vdiv(n_dot_v * F(1.2f * kLast), n_dot_v + F(0.2f));
    const F x_low = clamp(vfloor(x), F(0.0f), F(kLast - 1)), y_low = clamp(vfloor(y), F(0.0f), F(kLast - 1));
    alignas(64) std::int32_t index[kWidth];
    alignas(64) float down[kWidth], right[kWidth];
    store(index, round_to_int(x_low) * I(shading::kReflectionNodes) + round_to_int(y_low));
    store(down, x - x_low);
    store(right, y - y_low);
    Q shapes[kWidth];
    for (int l = 0; l < kWidth; ++l) {
        const float* const upper = &shading::kSheenShapes[index[l]].albedo;
        const float* const lower = upper + 4 * shading::kReflectionNodes;
        const QQ column = qq_lerp(qq_load(upper), qq_load(lower), down[l]);
        shapes[l] = q_lerp(qq_low(column), qq_high(column), q_set(right[l]));
    }
    SheenAt out;
    lanes_of_records(shapes, out.albedo, out.height, out.level, out.turn);
    return out;
}

/// Values that all lights of a fragment share.
struct SheenView {
    V3 normal, to_eye;
    F n_dot_v;        ///< from 0
    F half_exponent;  ///< 1 / (2 a)
};

/// pi D V2 (N.L) of a light.
HALFLIT_INLINE F sheen_value(const SheenView& view, V3 to_light, F n_dot_l) {
    const F none(0.0f), one(1.0f);
    const V3 half = to_light + view.to_eye, sine = cross(view.normal, half);
    const F cosine = dot(view.normal, half), inv_squared = vdiv(one, vmax(dot(half, half), F(1e-30f)));
    const M shines = (n_dot_l > none) & (cosine > F(shading::kLeastHalfVector));
    if (!any(shines)) return none;
    const F power =
        power_of_cosine(shading::PowTier::exact, dot(sine, sine) * inv_squared, (cosine * cosine) * inv_squared, view.half_exponent);
    const F spread = F(4.0f) * ((n_dot_l + view.n_dot_v) - n_dot_l * view.n_dot_v);
    return sel(shines, vdiv(((one + view.half_exponent) * power) * n_dot_l, vmax(spread, F(1e-30f))), none);
}

/// Mean radiance of the surroundings over the three lobes. `side`: towards the viewer, along the surface.
HALFLIT_INLINE V3 sheen_radiance(const shading::ShadingPlan& frame, bool environment, const SheenAt& at, V3 normal, V3 side) {
    const F none(0.0f), one(1.0f), third(0.333333333f);
    const F flat = vsqrt(vmax(one - at.height * at.height, none)), across = vsqrt(vmax(one - at.turn * at.turn, none));
    const V3 up = normal * at.height, along = side * flat;
    if (!environment) {  // linear in the direction: light from the mean of the three
        const F mean = (one + (at.turn + at.turn)) * third;
        return hemisphere(frame.ambient, up.y + along.y * mean);
    }
    const V3 turned = up + along * at.turn, other = cross(normal, along) * across, near = up + along, left = turned + other,
             right = turned - other;
    return (blurred_radiance(frame.reflections, near.x, near.y, near.z, at.level) +
            (blurred_radiance(frame.reflections, left.x, left.y, left.z, at.level) +
             blurred_radiance(frame.reflections, right.x, right.y, right.z, at.level))) *
           third;
}

/// Takes what sheen scatters from what the base reflects. Sets the rows `layers` and `passed_layers`.
[[gnu::noinline]] static void add_sheen(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::LightList lights,
                                        const shading::FragmentBlock& block, int count, ShadeRows& rows) {
    const F none(0.0f), one(1.0f);
    const shading::SheenPlan& plan = material.sheen;
    for (int lane = 0; lane < count; lane += kWidth) {
        TexelTaps taps;
        V3 color = broadcast(plan.color);
        F roughness(plan.roughness);
        if (material.textures[TextureSlot::sheen_color].data != nullptr) {
            const Sample texture = sample_texture(material.textures[TextureSlot::sheen_color], block, lane, taps);
            color = color * V3{texture.r, texture.g, texture.b};
        }
        if (material.textures[TextureSlot::sheen_roughness].data != nullptr)
            roughness = roughness * sample_texture(material.textures[TextureSlot::sheen_roughness], block, lane, taps).a;
        roughness = vmax(roughness, F(shading::kMinRoughness));
        const V3 normal = load3(rows.normal, lane), to_eye = load3(rows.to_eye, lane);
        const F n_dot_v = dot(normal, to_eye), held = clamp(n_dot_v, none, one);
        const SheenAt at = sheen_at(roughness, held);
        const F albedo = vmin(at.albedo, one);
        const ShadowReceiver receiver{
            frame, looked_up(frame, block, lane), load3(rows.surface, lane), {material.shadow_fade_scale, material.shadow_turn_scale}};
        V3 light{none, none, none};
        if (has(material, kStageLights)) {
            const SheenView view{normal, to_eye, held, vdiv(F(0.5f), roughness * roughness)};
            const V3 position = row3(block, shading::kPosX, lane);
            for (int i = 0; i < lights.count; ++i) {
                const shading::LightPlan& one_light = lights.lights[i];
                const LocalLight from = arrival(one_light, position);
                const F n_dot_l = dot(normal, from.direction);
                F diffuse(0.0f), value = sheen_value(view, from.direction, n_dot_l);
                if (one_light.shadow_map >= 0)
                    cast_shadow<true>(receiver, one_light, from.direction, from.attenuation, n_dot_l, diffuse, value);
                light = light + broadcast(one_light.color) * (value * from.attenuation);
            }
            light = light * vdiv(one, vmax(at.albedo, one));
        }
        if (has(material, kStageAmbient)) {
            const V3 along = to_eye - normal * n_dot_v;
            const V3 side = along * vdiv(one, vsqrt(dot(along, along) + F(shading::kSheenSoftSide)));
            const F occlusion = load(rows.occlusion + lane);
            V3 seen{occlusion, occlusion, occlusion};
            if (!frame.sky.empty()) {
                const V3 sky = sky_visibility<false>(receiver, material.lobe, normal, normal, roughness).diffuse;
                seen = {vmin(sky.x, occlusion), vmin(sky.y, occlusion), vmin(sky.z, occlusion)};
            }
            light = light + sheen_radiance(frame, has(material, kStageEnvironment), at, normal, side) * seen * albedo;
        }
        const F passed = one - vmax(color.x, vmax(color.y, color.z)) * albedo;
        dim_base(material, rows, lane, passed);
        lay<kStageSheen>(material, rows, lane, light * color, passed);
        store(rows.passed_layers + lane, passed);
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
