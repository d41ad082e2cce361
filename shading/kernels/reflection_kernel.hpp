// Reflections of an environment: where a rough mirror looks, and how wide, from a table; what it sees there, from blurred maps.
#pragma once

#include "shading/kernels/simd_texels.hpp"
#include "shading/kernels/vector.hpp"
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

/// Angle of (x, y) from the x axis, in [-pi, pi], within 3e-7; (0, 0) gives 0.
HALFLIT_INLINE F angle_of(F y, F x) {
    constexpr float kCoefficients[] = {1.0f,
                                       -0.3333309292793274f,
                                       0.19993053376674652f,
                                       -0.14207127690315247f,
                                       0.10654652863740921f,
                                       -0.07533621788024902f,
                                       0.04303872212767601f,
                                       -0.01628260686993599f,
                                       0.0029034512117505074f};
    const F ax = vabs(x), ay = vabs(y), zero(0.0f);
    const F t = vdiv(vmin(ax, ay), vmax(vmax(ax, ay), F(1e-30f))), s = t * t;
    F p(kCoefficients[8]);
    for (int i = 7; i >= 0; --i) p = mad(p, s, F(kCoefficients[i]));
    const F octant = p * t, quadrant = sel(ay > ax, F(1.57079633f) - octant, octant);
    const F half = sel(x < zero, F(3.14159265f) - quadrant, quadrant);
    return sel(y < zero, vneg(half), half);
}

/// A direction as a point of a map (ReflectionMap), both coordinates in [0, 1]. turned: ReflectionPlan's.
struct GlobePoint {
    F u, v;
};
HALFLIT_INLINE GlobePoint globe_point(V3 direction, F turned) {
    const F turn(0.159154943f), one(1.0f), none(0.0f);
    const F across = vsqrt(direction.x * direction.x + direction.z * direction.z);
    const F u = mad(angle_of(direction.x, vneg(direction.z)), turn, F(0.5f)) + turned;
    return {clamp(u - vfloor(u), none, one), clamp(angle_of(across, direction.y) * (turn + turn), none, one)};
}

/// The upper left of the four values about a point in a level, as a number of floats from the map's first one; from a row to the next; and
/// weights.
struct MapTaps {
    alignas(64) std::int32_t index[kWidth], below[kWidth];
    alignas(64) float right[kWidth], down[kWidth];
};
HALFLIT_INLINE void map_taps(const shading::ReflectionPlan& map, GlobePoint at, I level, MapTaps& out) {
    const F rows = look_up8(map.rows, level), columns = rows + rows;
    const F x = at.u * columns, y = at.v * rows;
    const F x_low = vmin(vfloor(x), columns - F(1.0f)), y_low = vmin(vfloor(y), rows - F(1.0f));
    store(out.right, x - x_low);
    store(out.down, y - y_low);
    const I row = round_to_int(columns) + I(1);
    store(out.index, shl<2>(look_up8(map.first, level) + round_to_int(y_low) * row + round_to_int(x_low)));
    store(out.below, shl<2>(row));
}
HALFLIT_INLINE TapRows<float> rows_of(const float* rgba, const MapTaps& taps, int lane) {
    const float* const upper = rgba + taps.index[lane];
    return {upper, upper + taps.below[lane]};
}
HALFLIT_INLINE TapWeights weights_of(const MapTaps& taps, int lane) { return {taps.right[lane], taps.down[lane]}; }

/// Radiance from a direction of any length, blurred by the lobe of a level in [0, kReflectionLevels - 1].
[[gnu::noinline]] static V3 blurred_radiance(const shading::ReflectionPlan& map, F x, F y, F z, F level) {
    const GlobePoint at = globe_point({x, y, z}, F(map.turned));
    const F low = clamp(vfloor(level), F(0.0f), F(shading::kReflectionLevels - 2));
    alignas(64) float between[kWidth];
    store(between, level - low);
    MapTaps fine, coarse;
    map_taps(map, at, round_to_int(low), fine);
    map_taps(map, at, round_to_int(low) + I(1), coarse);
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
