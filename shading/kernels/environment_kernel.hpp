// Light from all around at a normal: two colours, or an environment as spherical harmonics of 1 to 10 bands, as polynomials in the normal's
// components, or as a map.
#pragma once

#include "halflit/light.hpp"
#include "shading/kernels/globe_kernel.hpp"
#include "shading/plan/environment_plan.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

HALFLIT_INLINE V3 mad(V3 a, F b, V3 c) { return {mad(a.x, b, c.x), mad(a.y, b, c.y), mad(a.z, b, c.z)}; }
HALFLIT_INLINE V3 lerp(V3 a, V3 b, F weight) { return a + (b - a) * weight; }

/// Sky and ground light that reaches a surface; `up` is the y component of the surface's direction.
HALFLIT_INLINE V3 hemisphere(const Ambient& ambient, F up) {
    const V3 ground = broadcast(ambient.ground_linear);
    return lerp(ground, broadcast(ambient.sky_linear), F(0.5f) * (F(1.0f) + up));
}

HALFLIT_INLINE V3 three(const float* v) { return {F(v[0]), F(v[1]), F(v[2])}; }

/// Evaluates EnvironmentPlan::newton. Values below 0, where the series rings, become 0.
HALFLIT_INLINE V3 newton_environment(const shading::EnvironmentPlan& plan, int bands, V3 normal) {
    F from_node[sh::kMaxBands];
#pragma GCC unroll 16
    for (int k = 0; k + 1 < bands; ++k) from_node[k] = normal.z - F(shading::kNodes[k]);
    const float* a = plan.newton;
    V3 sum = three(a);
    a += 3;
#pragma GCC unroll 16
    for (int k = bands - 2; k >= 0; --k, a += 3) sum = mad(sum, from_node[k], three(a));
    F c = normal.x, s = normal.y;  // real and imaginary part of (x + iy)^m
#pragma GCC unroll 16
    for (int m = 1; m < bands; ++m) {
        V3 real = three(a), imaginary = three(a + 3);
        a += 6;
#pragma GCC unroll 16
        for (int k = bands - 2 - m; k >= 0; --k, a += 6) {
            real = mad(real, from_node[k], three(a));
            imaginary = mad(imaginary, from_node[k], three(a + 3));
        }
        sum = mad(imaginary, s, mad(real, c, sum));
        const F turned = c * normal.x - s * normal.y;
        s = s * normal.x + c * normal.y;
        c = turned;
    }
    const F none(0.0f);
    return {vmax(sum.x, none), vmax(sum.y, none), vmax(sum.z, none)};
}

/// EnvironmentPlan::map at a normal of any length but 0.
HALFLIT_INLINE V3 mapped_environment(const shading::EnvironmentPlan& plan, V3 normal) {
    MapTaps taps;
    map_taps(globe_point(normal, F(plan.map_turned)), F(plan.map_rows), I(0), taps);
    Q records[kWidth];
    for (int l = 0; l < kWidth; ++l) records[l] = bilinear(rows_of(plan.map, taps, l), weights_of(taps, l));
    V3 out;
    F unused;
    lanes_of_records(records, out.x, out.y, out.z, unused);
    return out;
}

/// Not inlined: six calls times ten orders are too much code. The components are separate arguments, because those are passed in registers.
/// GCC 12 copies a vector of them to the stack in halves, for which the next load has to wait.
[[gnu::noinline]] static V3 environment_light(const shading::EnvironmentPlan& plan, F x, F y, F z) {
    const V3 normal{x, y, z};
    switch (plan.bands) {
        case 0:
            return mapped_environment(plan, normal);
        case 1:
            return newton_environment(plan, 1, normal);
        case 2:
            return newton_environment(plan, 2, normal);
        case 3:
            return newton_environment(plan, 3, normal);
        case 4:
            return newton_environment(plan, 4, normal);
        case 5:
            return newton_environment(plan, 5, normal);
        case 6:
            return newton_environment(plan, 6, normal);
        default:
            return newton_environment(plan, plan.bands, normal);
    }
}
HALFLIT_INLINE V3 environment_light(const shading::EnvironmentPlan& plan, V3 normal) {
    return environment_light(plan, normal.x, normal.y, normal.z);
}

/// Light through the lobe at a surface's normal, which may be zero.
HALFLIT_INLINE V3 surrounding_light(const shading::EnvironmentPlan& plan, V3 normal) {
    const V3 light = environment_light(plan, normal);
    const M zero = dot(normal, normal) <= F(0.0f);
    if (!any(zero)) return light;
    const V3 flat = three(plan.at_zero_normal);
    return {sel(zero, flat.x, light.x), sel(zero, flat.y, light.y), sel(zero, flat.z, light.z)};
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
