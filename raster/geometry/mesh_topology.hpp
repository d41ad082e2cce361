// Connectivity of triangles: edges, bodies, and whether a surface is closed.
#pragma once

#include "raster/geometry/welded_surface.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace halflit::raster {

/// Edges of a surface by the triangles that run along them, and its bodies.
struct SurfaceTopology {
    std::uint64_t open_edges = 0;     ///< one triangle
    std::uint64_t flipped_edges = 0;  ///< two, in the same direction
    std::uint64_t crowded_edges = 0;  ///< more than two
    std::uint64_t bodies = 0;         ///< triangles that share an edge belong to one body
    bool balanced = false;            ///< triangles run along every edge as often in one direction as in the other, and there are some
};

/// Edges of one body, counted as those of a surface.
struct BodyEdges {
    std::uint64_t open = 0, flipped = 0, crowded = 0;
    bool balanced = true;
};

/// The bodies of a surface, numbered by their first triangles.
struct SurfaceBodies {
    std::vector<std::uint32_t> of_triangle;  ///< of each triangle of corners(), its body
    std::vector<BodyEdges> edges;            ///< of the first bodies
};

/// Linear time, but for places where many edges meet: those are sorted.
[[nodiscard]] SurfaceTopology topology_of(const WeldedSurface& surface);

/// The same, with the bodies, and the edges of at most so many of them.
[[nodiscard]] SurfaceTopology topology_of(const WeldedSurface& surface, std::size_t most_bodies, SurfaceBodies& bodies);

/// True if the surface has no border: the triangles run along every edge as often in one direction as in the other. Vertices with equal
/// positions count as one. Triangles with two corners at one position are ignored. A mesh without triangles is not closed, nor is one with
/// a triangle that is not finite. Requires: fewer than 2^32 indices, all in range.
[[nodiscard]] bool is_closed(const Mesh& mesh);

}  // namespace halflit::raster
