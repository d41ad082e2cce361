// Amount of shading work, in lanes. The counts show that stages which are not in the plan do not run.
#pragma once

#include "shading/plan/plan.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace halflit::raster {

/// Counts of one frame. They do not depend on threads or instruction set. Counts of light depend on the tile size, because it decides which
/// fragments share a block: a light is left out of a block that its range or cone does not reach, and ShadingRate::flat lights a triangle
/// once per block.
struct WorkCounts {
    /// Lanes that ran a stage, indexed by its bit in shading::Stage. A lane is a fragment, or a vertex or triangle for light at a lower
    /// rate.
    std::array<std::uint64_t, shading::kStageCount> stage_lanes{};
    std::uint64_t alpha_test_lanes = 0;          ///< fragments that had an alpha test; its stages count in stage_lanes too
    std::array<std::uint64_t, 3> light_lanes{};  ///< pairs of a light and a lane, by shading::LightType
    std::uint64_t shadow_lookup_lanes = 0;       ///< pairs whose light has a shadow map

    [[nodiscard]] std::uint64_t lanes(shading::Stage stage) const {
        return stage_lanes[static_cast<std::size_t>(std::countr_zero(static_cast<std::uint32_t>(stage)))];
    }
    WorkCounts& operator+=(const WorkCounts& other) {
        for (std::size_t i = 0; i < stage_lanes.size(); ++i) stage_lanes[i] += other.stage_lanes[i];
        for (std::size_t i = 0; i < light_lanes.size(); ++i) light_lanes[i] += other.light_lanes[i];
        alpha_test_lanes += other.alpha_test_lanes;
        shadow_lookup_lanes += other.shadow_lookup_lanes;
        return *this;
    }
    friend bool operator==(const WorkCounts&, const WorkCounts&) = default;
};

}  // namespace halflit::raster
