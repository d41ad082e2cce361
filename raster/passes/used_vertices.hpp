// Views of many vertices: what is left of a batch when its triangles are binned.
#pragma once

#include "raster/passes/view_geometry.hpp"

#include <span>

namespace halflit::raster {

/// Copies the vertices that a chunk's records and clip vertices use to chunk.used, and gives them the numbers that they have there.
/// screen: the batch's vertices. Lines and points keep whole quads.
void copy_used_vertices(Chunk& chunk, std::span<const Draw> draws, const ScreenVertex* screen);

/// Drops the vertices of chunk.used that no record and no clip vertex uses.
void drop_unused_vertices(Chunk& chunk, std::span<const Draw> draws);

}  // namespace halflit::raster
