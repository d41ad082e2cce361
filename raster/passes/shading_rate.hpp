// Shading rates below one a pixel: light once a vertex (Gouraud) or once a visible triangle (flat), by the same kernels.
// Either way the light of a point is stored as six numbers, factor and offset of the base colour, in the place of its position and
// normal, which nobody needs any more.
#pragma once

#include "raster/passes/tile.hpp"

namespace halflit::raster {

/// Gouraud: replaces position and normal in the vertex records that are in use. Returns the work that was.
WorkCounts light_vertices(const ViewGeometry& geometry, VertexRecords& records, const shading::ShadingPlan& plan,
                          const shading::ShadeKernels& kernels, Executor& executor);

/// Flat: replaces the position and normal rows of a block by the light of each fragment's triangle.
void light_triangles(const TilePass& pass, const shading::ShadingPlan& plan, const FragmentList& list, shading::FragmentBlock& block,
                     WorkCounts& work);

}  // namespace halflit::raster
