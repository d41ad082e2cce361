// Environment light at a normal: spherical harmonics of 1 to 10 bands.
#pragma once

#include "shading/environment_plan.hpp"
#include "shading/kernels/vector.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// The recurrence of sh::evaluate_basis in float, as a table that every object keeps to itself.
struct BasisSteps {
    float diagonal[sh::kMaxBands]{}, up[sh::kMaxBands][sh::kMaxBands]{}, back[sh::kMaxBands][sh::kMaxBands]{};
};
constexpr BasisSteps make_basis_steps() {
    constexpr sh::detail::BasisTable table = sh::detail::make_basis_table();
    BasisSteps steps;
    for (int m = 0; m < sh::kMaxBands; ++m) {
        steps.diagonal[m] = static_cast<float>(table.diagonal[m]);
        for (int l = 0; l < sh::kMaxBands; ++l) {
            steps.up[l][m] = static_cast<float>(table.up[l][m]);
            steps.back[l][m] = static_cast<float>(table.back[l][m]);
        }
    }
    return steps;
}
static constexpr BasisSteps kBasisSteps = make_basis_steps();

/// The operations of sh::evaluate_basis<N> with N = plan.bands, in loops: an order pays for its own bands alone, and all ten share one
/// small piece of code (bench/README.md has the price of that).
/// The sum is in ascending order, products rounded before it. Below 0, where the series rings, is 0.
[[gnu::noinline]] static V3 environment_light(const shading::EnvironmentPlan& plan, V3 normal) {
    F y[sh::kMaxCoefficients];
    F c(1.0f), s(0.0f);  // the parts of (x + iy)^m
    for (int m = 0; m < plan.bands; ++m) {
        F before(0.0f), q(kBasisSteps.diagonal[m]);
        for (int l = m; l < plan.bands; ++l) {
            y[sh::coefficient_index(l, m)] = q * c;
            if (m > 0) y[sh::coefficient_index(l, -m)] = q * s;
            if (l + 1 == plan.bands) break;
            const F next = (normal.z * q) * F(kBasisSteps.up[l + 1][m]) - before * F(kBasisSteps.back[l + 1][m]);
            before = q;
            q = next;
        }
        const F turned = c * normal.x - s * normal.y;
        s = s * normal.x + c * normal.y;
        c = turned;
    }
    V3 sum{F(plan.red[0]) * y[0], F(plan.green[0]) * y[0], F(plan.blue[0]) * y[0]};
    for (int i = 1; i < sh::coefficient_count(plan.bands); ++i) {
        sum.x = mad(F(plan.red[i]), y[i], sum.x);
        sum.y = mad(F(plan.green[i]), y[i], sum.y);
        sum.z = mad(F(plan.blue[i]), y[i], sum.z);
    }
    const F none(0.0f);
    return {vmax(sum.x, none), vmax(sum.y, none), vmax(sum.z, none)};
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
