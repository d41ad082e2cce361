// The part of a scene that a view of the whole is fitted to. A ground that is much larger than all that stands on it, and a few vertices
// far away from all others, are left out: what the scene is about would be some pixels in a wide plane. The rule depends on the geometry
// alone, but for marks that code sets:
//
// - Of a mesh, vertices outside of a box are left out if they have at most max(1, n / 1000) different positions of n, at least 8, or at
//   most 3 of n, at least 24, and the box's radius is below 1/16 of the mesh's. Of points, up to n / 50 are left out, below 1/4.
// - Instances are left out likewise, by the number of their vertices: at most max(3, n / 1000) of n, at least 24.
// - Grounds are left out (scene/grounds.hpp).
// - Instances that are marked as backdrops are left out.
//
// All else is framed as a whole.
#pragma once

#include "halflit/scene.hpp"

#include <cstdint>
#include <vector>

namespace halflit::raster {

/// Vertices of a mesh that are framed.
struct FramedVertices {
    std::vector<std::uint32_t> vertices;
    Bounds bounds;  ///< object space
};

struct FramedPart {
    std::vector<FramedVertices> meshes;  ///< of each mesh that is framed; empty for others
    std::vector<int> instances;          ///< instances that are framed, in order
    bool whole = true;                   ///< nothing was left out
    Bounds bounds;                       ///< world space, of the part; unset if whole
};

/// Instances whose mesh is out of range, and shadow catchers, belong to no part.
[[nodiscard]] FramedPart framed_part(const Scene& scene);

}  // namespace halflit::raster
