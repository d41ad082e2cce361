// Makes the coarse grid that tells where a scene hides its surroundings (shading/plan/sky_grid_plan.hpp).
//
// For each direction, layer after layer of the lattice from its far end, the share that is hidden at a point is that of the place in the
// next layer that the direction leads to, interpolated, and what is covered there. Covers add up to 1: the two halves of a wall between two
// layers hide all.
#pragma once

#include "raster/view/cover_grid.hpp"
#include "shading/plan/light_plan.hpp"
#include "shading/plan/sky_grid_plan.hpp"
#include "shading/reflection_map.hpp"

#include <optional>
#include <span>
#include <vector>

namespace halflit::raster {

struct SkyGrid {
    std::optional<SceneRevision> revision;  ///< of the covers that it was made of; none: nothing is made yet
    std::vector<float> lights;              ///< of each direction, that the terms were made of
    std::vector<float> terms;               ///< of what is hidden at each point; empty: nothing in the scene hides anything
};

/// Makes the grid unless it is that of these covers and of this light already. lights: plan_lights(sky_lights(kGridDirections, ..)).
[[nodiscard]] shading::SkyGridPlan make_sky_grid(const CoverGrid& covers, std::span<const shading::LightPlan> lights,
                                                 const RasterKernels& kernels, const shading::ForEachRow& for_each, SkyGrid& grid);

}  // namespace halflit::raster
