// A mesh prepared for drawing: its box, and clusters of triangles that a view can leave out as a whole. Computed once.
#pragma once

#include "halflit/error.hpp"
#include "halflit/mesh.hpp"
#include "raster/scene/flat_faces.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace halflit::raster {

class Executor;

/// Triangles of a cluster: cluster c holds triangles [c * kClusterTriangles, (c + 1) * kClusterTriangles) of the mesh, in index order.
inline constexpr std::uint32_t kClusterTriangles = 128;

/// A line or point is two triangles. They count as triangles in all that follows, but for indices and vertices.
[[nodiscard]] inline std::size_t triangle_count(const Mesh& mesh) {
    const std::size_t primitives = mesh.indices.size() / corners_of(mesh.topology);
    return mesh.topology == Topology::triangles ? primitives : 2 * primitives;
}

/// Vertices are transformed in groups of this many; a group belongs to one instance of one mesh.
inline constexpr std::uint32_t kVertexGroup = 64;

struct Cluster {
    float min[3], max[3];  ///< object space: the box of its vertices
    /// Cone that contains the normals of all triangles: axis (object space, unit), sine and cosine of its half angle. sine > 1: no cone of
    /// less than 90 degrees is known, or a triangle is too thin for one.
    float cone_axis[3];
    float cone_sine, cone_cosine;
    /// Lower bound of the triangles' least altitudes, object units. A triangle's least altitude is twice its area over its longest edge.
    /// Triangles with two vertices at one position are left out: they cover nothing.
    float least_altitude;
    std::uint32_t first_group;  ///< index into PreparedMesh::vertex_groups; the next cluster's is the end
    bool finite;                ///< every vertex is finite
    bool flat;                  ///< a triangle lies across an axis (FlatFaces)
};

/// Clusters per supercluster: searches test the box of a supercluster before those of its clusters.
inline constexpr std::size_t kSuperclusterSize = 32;

struct PreparedMesh {
    Bounds bounds;                             ///< object space, of the finite vertices that some triangle uses
    std::vector<Cluster> clusters;             ///< one more at the end, for its first_group
    std::vector<Bounds> superclusters;         ///< object space: box of kSuperclusterSize clusters each, in order
    std::vector<std::uint32_t> vertex_groups;  ///< numbers of the groups that each cluster reads, cluster after cluster
    float largest_color = 1;                   ///< the largest red, green or blue of the vertex colours, at least 1
    double largest_splat_color = 1;            ///< bound of the splats' red, green and blue from all directions, at least 1
    bool finite = true;                        ///< every used vertex is finite
    bool few_vertices = false;                 ///< below 1.5 vertices a triangle: smooth meshes have about .5, flat ones 2 or 3
    FlatFaces faces;                           ///< floors and walls, object space
    /// Lines or points that share vertices, or have them in another order: the mesh with vertices of its own for each, whose index i is i.
    std::shared_ptr<const Mesh> unshared;

    [[nodiscard]] std::size_t cluster_count() const { return clusters.empty() ? 0 : clusters.size() - 1; }
    [[nodiscard]] std::span<const std::uint32_t> groups_of(std::size_t cluster) const {
        return std::span(vertex_groups)
            .subspan(clusters[cluster].first_group, clusters[cluster + 1].first_group - clusters[cluster].first_group);
    }
};

/// Entries [begin, end) of Mesh::indices.
struct IndexRange {
    std::size_t begin, end;
};
[[nodiscard]] inline IndexRange indices_of_cluster(const Mesh& mesh, std::size_t cluster) {
    const bool quads = mesh.topology != Topology::triangles;
    const std::size_t size = corners_of(mesh.topology) * (quads ? kClusterTriangles / 2 : kClusterTriangles), begin = cluster * size;
    return {begin, std::min(begin + size, mesh.indices.size())};
}

/// Triangles [begin, end) of a mesh.
[[nodiscard]] inline IndexRange triangles_of_cluster(const Mesh& mesh, std::size_t cluster) {
    const std::size_t begin = cluster * kClusterTriangles;
    return {begin, std::min(begin + kClusterTriangles, triangle_count(mesh))};
}

/// Checks a mesh and cuts it into clusters. Fails for an index out of range and for arrays of different lengths.
[[nodiscard]] Result<PreparedMesh> prepare_mesh(const Mesh& mesh, Executor& executor);

}  // namespace halflit::raster
