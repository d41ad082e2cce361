// Edges of a scene's surfaces that drawings show as lines: where a surface ends, where it bends, and where it may turn away from a viewer.
#pragma once

#include "halflit/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace halflit::raster {

enum class EdgeKind : std::uint8_t {
    border,  ///< of one triangle
    crease,  ///< its triangles meet at an angle above the limit, or there are more than two that do not continue each other
    smooth   ///< the surface goes on; an outline where one side faces the viewer and the other does not
};

/// An edge between two places. Its triangles run along it from `from` to `to`, or back.
struct ModelEdge {
    std::uint32_t from, to;  ///< indices into ModelEdges::places()
    /// Triangles, by their numbers over all instances. For a border both are its one triangle; where a surface of more than two goes on,
    /// they continue each other.
    std::uint32_t face[2];
    EdgeKind kind;
    bool turned;  ///< the two triangles face opposite sides of one surface: one of them is wound the wrong way
};

/// Edges of all visible instances with triangles but shadow catchers. Instances that follow each other with equal transforms are one
/// surface, as the meshes of one part are; vertices at one place are one.
class ModelEdges {
public:
    /// Linear time, 0.15 s for a million triangles. Requires: a scene that was checked. crease_deg: in [0, 180].
    /// is_dark: of instances whose edges are; none: no edge is dark.
    void find(const Scene& scene, double crease_deg, const std::function<bool(const Instance&)>& is_dark = {});
    /// Upper bound on the bytes that find() takes at its peak: 400 a triangle where no vertex is shared, 210 in a closed surface.
    [[nodiscard]] static std::uint64_t most_bytes(const Scene& scene);
    /// Bytes that are held.
    [[nodiscard]] std::size_t bytes() const;

    [[nodiscard]] const std::vector<Vec3d>& places() const { return places_; }  ///< world space
    [[nodiscard]] const std::vector<ModelEdge>& edges() const { return edges_; }

    static constexpr std::uint32_t kNone = ~0u;
    /// The number of an instance's triangle over all instances; kNone for an instance without edges.
    [[nodiscard]] std::uint32_t face(std::uint32_t instance, std::uint32_t triangle) const {
        return first_face_[instance] == kNone ? kNone : first_face_[instance] + triangle;
    }
    /// Corners of a triangle that an edge has, indices into places(), counter-clockwise seen from outside.
    [[nodiscard]] const std::uint32_t* corners(std::uint32_t face) const { return &corners_[3 * std::size_t{face}]; }
    /// The triangle on the other side of the edge that begins at corner k; kNone where there is none, or more than one.
    [[nodiscard]] std::uint32_t neighbour(std::uint32_t face, int k) const {
        return neighbours_[3 * std::size_t{face} + static_cast<std::size_t>(k)];
    }
    /// The triangle is drawn from one side alone.
    [[nodiscard]] bool single_sided(std::uint32_t face) const { return single_sided_[face]; }
    /// Both surfaces that meet in the edge are dark.
    [[nodiscard]] bool is_dark(const ModelEdge& edge) const { return dark_[edge.face[0]] && dark_[edge.face[1]]; }

private:
    void add_surface(class WeldedSurface& surface, double least_cosine);

    std::vector<Vec3d> places_;
    std::vector<std::uint32_t> corners_;     ///< three for each triangle of all instances; those of no area have three zeros
    std::vector<std::uint32_t> neighbours_;  ///< three for each triangle
    std::vector<std::uint32_t> first_face_;  ///< of each instance
    std::vector<bool> single_sided_, dark_;  ///< of each triangle
    std::vector<ModelEdge> edges_;
};

}  // namespace halflit::raster
