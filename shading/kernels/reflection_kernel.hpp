// Reflections of an environment: where a rough mirror looks, and how wide, from a table; what it sees there, from blurred maps.
#pragma once

#include "shading/kernels/globe_kernel.hpp"
#include "shading/model/reflection_tables.hpp"
#include "shading/plan/material_plan.hpp"
#include "shading/plan/reflection_plan.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// kReflectionShapes at a roughness in [kMinRoughness, 1] and a cosine N.V in [0, 1].
struct MirrorShape {
    F a, b, turn0, level0, turn1, level1, spread;
};
HALFLIT_INLINE MirrorShape mirror_shape(F roughness, F n_dot_v) {
    constexpr int kLast = shading::kReflectionNodes - 1;
    const F x = roughness * F(kLast), y = vdiv(n_dot_v * F(1.2f * kLast), n_dot_v + F(0.2f));
    const F x_low = clamp(vfloor(x), F(0.0f), F(kLast - 1)), y_low = clamp(vfloor(y), F(0.0f), F(kLast - 1));
    alignas(64) std::int32_t index[kWidth];
    alignas(64) float down[kWidth], right[kWidth];
    store(index, round_to_int(x_low) * I(shading::kReflectionNodes) + round_to_int(y_low));
    store(down, x - x_low);
    store(right, y - y_low);
    Q first[kWidth], second[kWidth];
    for (int l = 0; l < kWidth; ++l) {
        const float* const upper = &shading::kReflectionShapes[index[l]].a;
        const float* const lower = upper + 8 * shading::kReflectionNodes;
        const QQ left = qq_lerp(qq_load(upper), qq_load(lower), down[l]), next = qq_lerp(qq_load(upper + 8), qq_load(lower + 8), down[l]);
        const QQ shape = qq_lerp(left, next, right[l]);
        first[l] = qq_low(shape), second[l] = qq_high(shape);
    }
    MirrorShape out;
    F unused;
    lanes_of_records(first, out.a, out.b, out.turn0, out.level0);
    lanes_of_records(second, out.turn1, out.level1, out.spread, unused);
    return out;
}

/// The same at a material's one roughness.
HALFLIT_INLINE MirrorShape mirror_shape(const shading::MirrorRow& row, F n_dot_v) {
    constexpr int kLast = shading::kReflectionNodes - 1;
    const F y = vdiv(n_dot_v * F(1.2f * kLast), n_dot_v + F(0.2f)), y_low = clamp(vfloor(y), F(0.0f), F(kLast - 1)), right = y - y_low;
    const I left = round_to_int(y_low), next = left + I(1);
    const auto value = [&](int number) __attribute__((always_inline)) {
        const F a = look_up16(row.values[number], left), b = look_up16(row.values[number], next);
        return mad(right, b - a, a);
    };
    return {value(0), value(1), value(2), value(3), value(4), value(5), value(6)};
}
HALFLIT_INLINE MirrorShape mirror_shape(const shading::MaterialPlan& material, F roughness, F n_dot_v) {
    return material.mirror.at_one_roughness ? mirror_shape(material.mirror, n_dot_v) : mirror_shape(roughness, n_dot_v);
}

/// Radiance from a direction of any length, blurred by the lobe of a level in [0, kReflectionLevels - 1].
[[gnu::noinline]] static V3 blurred_radiance(const shading::ReflectionPlan& map, F x, F y, F z, F level) {
    const GlobePoint at = globe_point({x, y, z}, F(map.turned));
    const F low = clamp(vfloor(level), F(0.0f), F(shading::kReflectionLevels - 2));
    alignas(64) float between[kWidth];
    store(between, level - low);
    MapTaps fine, coarse;
    const I level_below = round_to_int(low), level_above = level_below + I(1);
    map_taps(at, look_up8(map.rows, level_below), look_up8(map.first, level_below), fine);
    map_taps(at, look_up8(map.rows, level_above), look_up8(map.first, level_above), coarse);
    Q records[kWidth];
    for (int l = 0; l < kWidth; ++l)
        records[l] =
            trilinear(rows_of(map.rgba, fine, l), rows_of(map.rgba, coarse, l), weights_of(fine, l), weights_of(coarse, l), between[l]);
    V3 out;
    F unused;
    lanes_of_records(records, out.x, out.y, out.z, unused);
    return out;
}

/// Mean radiance over the lobes of a material with one or two of them, about the mirrored direction of a view.
HALFLIT_INLINE V3 mirrored_radiance(const shading::ReflectionPlan& map, int lobes, const MirrorShape& shape, V3 normal, F n_dot_v,
                                    V3 reflection) {
    const V3 towards_normal = normal - reflection * n_dot_v;
    const auto radiance = [&](F turn, F level) __attribute__((always_inline)) {
        const V3 d = reflection + towards_normal * turn;
        return blurred_radiance(map, d.x, d.y, d.z, level);
    };
    if (lobes == 1) return radiance(shape.turn0, shape.level0);
    return (radiance(shape.turn1 - shape.spread, shape.level1) + radiance(shape.turn1 + shape.spread, shape.level1)) * F(0.5f);
}

/// Share of a uniform sky that a surface with this F0 reflects, light that bounces between its facets included: (A F0 + B) (1 + F0 (1 / (A
/// + B) - 1)), which is 1 for F0 = 1 [Turquin19]. `more`: 1 / (A + B) - 1.
HALFLIT_INLINE F sky_share(F a, F b, F more, F f0) { return mad(a, f0, b) * mad(f0, more, F(1.0f)); }

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
