// The vertices of a mesh that can be seen.
#pragma once

#include "halflit/scene.hpp"
#include "raster/scene/framed_part.hpp"

namespace halflit::raster {

/// Those of triangles that alpha does not hide, and points around the texels that are seen of large ones. material: null if all of the mesh
/// is seen. whole: set to false if some used vertices are not.
[[nodiscard]] FramedVertices seen_vertices(const Scene& scene, const Mesh& mesh, const Material* material, bool& whole);

}  // namespace halflit::raster
