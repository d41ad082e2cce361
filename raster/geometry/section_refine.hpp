// Triangles of good shape. Long thin ones draw textures badly: their corners are rounded to parts of a pixel, and their points are
// interpolated at pixels' centres beside them.
#pragma once

#include "raster/geometry/section_grid.hpp"

#include <cstdint>
#include <vector>

namespace halflit::raster {

/// Changes a triangulation of triangulate(): first its diagonals, until they are Delaunay's. Then it adds corners inside of the region, the
/// centres of circles around triangles that are thin, until few are left or there are four times as many corners as before. Edges of the
/// border stay as they are. Takes about 40 steps for each corner.
void refine(std::vector<GridPoint>& corners, std::vector<std::uint32_t>& triangles);

}  // namespace halflit::raster
