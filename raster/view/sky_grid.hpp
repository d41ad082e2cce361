// Makes the coarse grid that tells where a scene hides its surroundings (shading/plan/sky_grid_plan.hpp).
//
// For each direction, layer after layer of the scene's voxels from its far end, a voxel is hidden if the next one towards it is filled or
// hidden: rows of 64 voxels are words, so a direction takes some thousand operations.
#pragma once

#include "raster/view/filled_voxels.hpp"
#include "shading/plan/sky_grid_plan.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace halflit::raster {

struct SkyGrid {
    std::optional<SceneRevision> revision;  ///< of the voxels that it was made of; none: nothing is made yet
    std::vector<std::int32_t> masks;        ///< empty: nothing in the scene hides anything
    shading::SkyGridPlan place;             ///< size, origin and scale
};

/// Makes the grid unless it is that of these voxels already.
void make_sky_grid(const FilledVoxels& voxels, SkyGrid& grid);

}  // namespace halflit::raster
