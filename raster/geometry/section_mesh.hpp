// Meshes cut by a plane.
#pragma once

#include "halflit/mesh.hpp"
#include "halflit/section.hpp"

#include <cstdint>
#include <vector>

namespace halflit::raster {

/// A plane of unit normal. Points up to `tolerance` beyond it count as on it.
struct UnitPlane {
    Vec3d normal;
    double offset = 0.0, tolerance = 0.0;  // world units
    [[nodiscard]] double distance(Vec3d p) const { return dot(normal, p) - offset; }
};

/// Where the plane cuts an edge. It depends on the places of the edge's ends alone: triangles that share the edge get the same bits.
struct CutPoint {
    Vec3d world;
    Vec3f object;  // space of the mesh
};

/// A directed piece of a section's border. Seen against the plane's normal, material is on the left.
struct CutSegment {
    CutPoint from, to;
};

/// The part of a mesh that a plane leaves.
enum class Left : std::uint8_t { all, some, nothing };

/// A placed mesh and its vertices' distances to a plane. Requires: indices in range. Primitives with a vertex that is not finite are
/// removed where a mesh is cut.
class MeshCut {
public:
    MeshCut(const Mesh& mesh, const Mat4& world_from_object, const UnitPlane& plane);

    [[nodiscard]] Left left() const;
    /// The kept side.
    [[nodiscard]] Mesh kept() const;
    /// Adds the border of the section. It is closed if the mesh is.
    void add_section(std::vector<CutSegment>& segments) const;

private:
    enum class Side : std::uint8_t { kept, on, removed, none };  // none: not finite

    [[nodiscard]] Mesh kept_splats() const;
    [[nodiscard]] bool is_kept(std::uint32_t vertex) const { return sides_[vertex] == Side::kept || sides_[vertex] == Side::on; }
    [[nodiscard]] bool is_finite(const std::uint32_t* corners, std::size_t count) const;
    [[nodiscard]] bool is_dropped_face(const std::uint32_t* corners) const;
    [[nodiscard]] double share(std::uint32_t kept, std::uint32_t removed) const;
    [[nodiscard]] CutPoint cut_point(std::uint32_t kept, std::uint32_t removed) const;
    [[nodiscard]] CutPoint vertex(std::uint32_t v) const;

    const Mesh& mesh_;
    const Mat4& place_;
    const UnitPlane& plane_;
    bool mirrors_;
    std::vector<double> distances_;
    std::vector<Side> sides_;
};

}  // namespace halflit::raster
