// Normals for meshes that have none.
#pragma once

#include "raster/scene/mesh.hpp"

namespace halflit::raster {

/// Gives each triangle three vertices of its own, with the triangle's normal; the counter-clockwise side is outside. No vertex is shared
/// afterwards, and index i is i. Other attributes are copied. Tangents are removed, because they belong to other normals. A triangle that
/// has no area or is not finite gets (0, 0, 1).
void generate_flat_normals(Mesh& mesh);

}  // namespace halflit::raster
