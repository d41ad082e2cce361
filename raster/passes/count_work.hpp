// Counting for WorkCounts: one call per block, next to the call of the kernel that does the work. What a file can ask for without limit,
// its lights and alpha tests, is charged too (charge_work).
#pragma once

#include "halflit/report.hpp"
#include "sh/time_limit.hpp"
#include "shading/kernels/shade_kernels.hpp"

namespace halflit::raster {

/// Stages that ShadeKernels::light runs if light is not evaluated at fragments: all but those of base colours, emission and alpha.
inline constexpr std::uint32_t kLightStages =
    ~std::uint32_t{kStageBaseColorTexture | kStageVertexColor | kStageEmissiveTexture | kStageUnlit | kStageGradients | kStagePrelit |
                   kStageTransmission | kStageShadowCatcher};
/// Stages that ShadeKernels::alpha runs.
inline constexpr std::uint32_t kAlphaStages = kStageBaseColorTexture | kStageVertexColor | kStageGradients;

inline void count_stages(WorkCounts& work, std::uint32_t stages, int lanes) {
    for (; stages != 0; stages &= stages - 1)
        work.stage_lanes[static_cast<std::size_t>(std::countr_zero(stages))] += static_cast<std::uint64_t>(lanes);
}

/// Counts a call of ShadeKernels::shade.
inline void count_shading(WorkCounts& work, const shading::MaterialPlan& plan, int lanes) {
    const bool prelit = (plan.stages & kStagePrelit) != 0;
    count_stages(work, prelit ? plan.stages & ~kLightStages : plan.stages, lanes);
}

/// Counts the lights that are passed to a kernel.
inline void count_lights(WorkCounts& work, const shading::MaterialPlan& plan, shading::LightList lights, int lanes) {
    if ((plan.stages & kStageLights) == 0) return;
    constexpr std::uint64_t kUnitsALight = 10, kUnitsALookup = 8;
    std::uint64_t lookups = 0;
    for (int i = 0; i < lights.count; ++i) {
        work.light_lanes[static_cast<std::size_t>(lights.lights[i].type)] += static_cast<std::uint64_t>(lanes);
        if (lights.lights[i].shadow_map >= 0) lookups += static_cast<std::uint64_t>(lights.lights[i].shadow_points);
    }
    work.shadow_lookup_lanes += static_cast<std::uint64_t>(lanes) * lookups;
    charge_work(static_cast<std::uint64_t>(lanes) * (kUnitsALight * static_cast<std::uint64_t>(lights.count) + kUnitsALookup * lookups));
}

/// Counts a call of ShadeKernels::light with all of the frame's lights.
inline void count_prelighting(WorkCounts& work, const shading::ShadingPlan& frame, const shading::MaterialPlan& plan, int lanes) {
    count_stages(work, plan.stages & kLightStages, lanes);
    count_lights(work, plan, shading::all_lights(frame), lanes);
}

/// Counts a call of ShadeKernels::alpha.
inline void count_alpha_test(WorkCounts& work, const shading::MaterialPlan& plan, int lanes) {
    count_stages(work, plan.stages & kAlphaStages, lanes);
    work.alpha_test_lanes += static_cast<std::uint64_t>(lanes);
    constexpr std::uint64_t kUnitsATest = 5;
    charge_work(kUnitsATest * static_cast<std::uint64_t>(lanes));
}

}  // namespace halflit::raster
