// Shading rates below one per pixel: light once per vertex (Gouraud) or once per visible triangle (flat), by the same kernels. In both
// cases the light of a point is six numbers, an RGB factor for the base colour and an RGB offset. They replace its position and normal,
// which are no longer needed.
#pragma once

#include "raster/passes/tile.hpp"

namespace halflit::raster {

/// Gouraud: stores light in place of position and normal in the vertex records that are in use. Returns the work done.
WorkCounts light_vertices(const ViewGeometry& geometry, VertexRecords& records, const shading::ShadingPlan& plan,
                          const shading::ShadeKernels& kernels, Executor& executor);

/// Flat: replaces the position and normal rows of a block by the light of each fragment's triangle.
void light_triangles(const TilePass& pass, const shading::ShadingPlan& plan, const FragmentList& list, shading::FragmentBlock& block,
                     WorkCounts& work);

}  // namespace halflit::raster
