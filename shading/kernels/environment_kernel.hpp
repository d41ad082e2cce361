// Environment light at a normal: spherical harmonics of 1 to 10 bands, each order its own code, so that an order pays for its own
// bands alone.
#pragma once

#include "shading/environment_plan.hpp"
#include "shading/kernels/vector.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Ascending order, products rounded before the sum. Below 0, where the series rings, is 0.
template <int N>
HALFLIT_INLINE V3 environment_sum(const shading::EnvironmentPlan& plan, V3 normal) {
    F y[N * N];
    sh::evaluate_basis<N>(normal, y);
    V3 sum{F(plan.red[0]) * y[0], F(plan.green[0]) * y[0], F(plan.blue[0]) * y[0]};
    for (int i = 1; i < N * N; ++i) {
        sum.x = mad(F(plan.red[i]), y[i], sum.x);
        sum.y = mad(F(plan.green[i]), y[i], sum.y);
        sum.z = mad(F(plan.blue[i]), y[i], sum.z);
    }
    const F none(0.0f);
    return {vmax(sum.x, none), vmax(sum.y, none), vmax(sum.z, none)};
}

/// One function a set, not inlined: the ten orders together are large, and each fragment runs one or two of them.
[[gnu::noinline]] static V3 environment_light(const shading::EnvironmentPlan& plan, V3 normal) {
    switch (plan.bands) {
        case 1: return environment_sum<1>(plan, normal);
        case 2: return environment_sum<2>(plan, normal);
        case 3: return environment_sum<3>(plan, normal);
        case 4: return environment_sum<4>(plan, normal);
        case 5: return environment_sum<5>(plan, normal);
        case 6: return environment_sum<6>(plan, normal);
        case 7: return environment_sum<7>(plan, normal);
        case 8: return environment_sum<8>(plan, normal);
        case 9: return environment_sum<9>(plan, normal);
        default: return environment_sum<10>(plan, normal);
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
