// Triangles of placed meshes, with vertices at one place made one: glTF splits vertices where normals or texture coordinates differ.
#pragma once

#include "halflit/mesh.hpp"
#include "sh/place_table.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace halflit::raster {

class WeldedSurface {
public:
    /// Adds a mesh's triangles. Vertices are one if their world positions, computed in double, are equal. Triangles of a mirrored
    /// instance are turned, as they are for drawing: their outside stays outside. Lines and points are ignored. Linear time, and none for
    /// vertices that no triangle uses. Requires: indices in range, and fewer than 2^32 of them over all calls.
    void add(const Mesh& mesh, const Mat4& world_from_object);

    /// Frees the memory that only add() needs, which may not be called any more.
    void end() { table_ = {}; }
    /// The places, which the surface has no longer.
    [[nodiscard]] std::vector<Vec3d> take_places() { return std::move(places_); }

    /// Different positions, world space, finite in float32.
    [[nodiscard]] const std::vector<Vec3d>& places() const { return places_; }
    /// Three indices into places() for each triangle that has three different ones.
    [[nodiscard]] const std::vector<std::uint32_t>& corners() const { return corners_; }
    /// For each triangle of corners(), its number among all that were added.
    [[nodiscard]] const std::vector<std::uint32_t>& numbers() const { return numbers_; }
    /// Triangles that were added, kept or not.
    [[nodiscard]] std::uint32_t triangles() const { return triangles_; }
    /// Triangles with two corners at one place.
    [[nodiscard]] std::uint64_t collapsed() const { return collapsed_; }
    /// Triangles with a corner that is not finite in float32.
    [[nodiscard]] std::uint64_t not_finite() const { return not_finite_; }

private:
    PlaceTable<Vec3d> table_;
    std::vector<Vec3d> places_;
    std::vector<std::uint32_t> corners_, numbers_;
    std::uint32_t triangles_ = 0;
    std::uint64_t collapsed_ = 0, not_finite_ = 0;
};

}  // namespace halflit::raster
