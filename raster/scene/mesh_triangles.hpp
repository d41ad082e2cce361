// The triangles of a mesh that may be faulty.
#pragma once

#include "halflit/mesh.hpp"
#include "raster/detail/view_math.hpp"
#include "sh/time_limit.hpp"

#include <cstddef>
#include <cstdint>

namespace halflit::raster {

/// Calls visit(corners) for every stride-th triangle that is finite and whose vertices the mesh has; object space.
template <class Visit>
void each_triangle(const Mesh& mesh, std::size_t stride, const Visit& visit) {
    if (mesh.topology != Topology::triangles) return;
    TimeCheck check;
    const std::size_t count = mesh.positions.size();
    for (std::size_t i = 0; i + 3 <= mesh.indices.size(); i += 3 * stride) {
        check();
        const std::uint32_t* const index = &mesh.indices[i];
        if (index[0] >= count || index[1] >= count || index[2] >= count) continue;
        const Vec3f corners[3] = {mesh.positions[index[0]], mesh.positions[index[1]], mesh.positions[index[2]]};
        if (finite(corners[0]) && finite(corners[1]) && finite(corners[2])) visit(corners);
    }
}

}  // namespace halflit::raster
