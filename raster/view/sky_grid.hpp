// What hides the surroundings, in a coarse grid over the scene (shading/plan/sky_grid_plan.hpp).
//
// The scene's opaque triangles mark the voxels that they pass through, a bit each. For each direction, layer after layer from its far end,
// a voxel is hidden if the next one towards it is filled or hidden: rows of 64 voxels are words, so a direction takes some thousand
// operations. It depends on the geometry alone, so pictures of a scene that stands still share it.
#pragma once

#include "raster/scene/prepared_data.hpp"
#include "shading/plan/sky_grid_plan.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace halflit::raster {

/// A grid, and the scene that it was made of.
struct SkyGrid {
    std::optional<SceneRevision> revision;  ///< without that of its lights; none: nothing is made yet
    std::vector<std::int32_t> masks;        ///< empty: nothing in the scene hides anything
    shading::SkyGridPlan place;             ///< size, origin and scale
};

/// Makes the grid unless it is this scene's already.
void make_sky_grid(const PreparedData& scene, SkyGrid& grid);

}  // namespace halflit::raster
