// How a mesh's triangles hang together.
#pragma once

#include "raster/scene/mesh.hpp"

namespace halflit::raster {

/// Whether the surface has no border: every edge is run through as often in one direction as in the other. Vertices at one place count as
/// one (glTF parts them where normals or texture coordinates differ); triangles with two corners at one place do not count. A mesh without
/// triangles is not closed. Indices are in range. Sorts the edges: about 0.4 s for a million triangles.
[[nodiscard]] bool is_closed(const Mesh& mesh);

}  // namespace halflit::raster
