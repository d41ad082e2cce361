// Vertices that a mesh draws.
#pragma once

#include "halflit/mesh.hpp"

#include <cstdint>
#include <vector>

namespace halflit::raster {

/// True for each vertex that a triangle of the mesh uses. Files often share one vertex array between many meshes.
inline std::vector<bool> used_vertices(const Mesh& mesh) {
    std::vector<bool> used(mesh.positions.size(), false);
    for (const std::uint32_t index : mesh.indices)
        if (index < used.size()) used[index] = true;
    return used;
}

}  // namespace halflit::raster
