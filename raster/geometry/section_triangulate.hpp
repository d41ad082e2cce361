// Triangles that fill the region between edges.
#pragma once

#include "raster/geometry/section_grid.hpp"

#include <cstdint>
#include <vector>

namespace halflit::raster {

/// Fills the region: the points below which the number of edges is odd. Edges as sweep() requires them. corners: all ends of edges, and no
/// other points, so triangles that are neighbours share their corners. triangles: three indices of corners each, counter-clockwise; a few
/// may have no area. A sweep from left to right makes them.
/// False if the edges are not as required, or after 2^28 steps.
[[nodiscard]] bool triangulate(const std::vector<GridEdge>& edges, std::vector<GridPoint>& corners, std::vector<std::uint32_t>& triangles);

}  // namespace halflit::raster
