// Normals for meshes that bring none.
#pragma once

#include "raster/scene/mesh.hpp"

namespace halflit::raster {

/// Gives each triangle vertices of its own (no vertex is shared afterwards; vertex i of the result is index i) with the triangle's
/// normal, counter-clockwise side out. Other arrays are carried along; tangents are removed, since they belong to other normals.
/// A triangle without an area, or not finite, gets (0, 0, 1).
void generate_flat_normals(Mesh& mesh);

}  // namespace halflit::raster
