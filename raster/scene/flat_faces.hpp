// Floors and walls: the triangles of a mesh that lie in planes across an axis, at the ends of the box of all such triangles.
#pragma once

#include "halflit/mesh.hpp"

#include <span>

namespace halflit::raster {

struct Cluster;

/// Object space. A triangle is flat if it lies in a plane x, y or z = constant, but for 1e-6 of its size.
struct FlatFaces {
    Bounds flats;     ///< of all flat triangles
    Bounds faces[6];  ///< of the flat triangles in the planes flats.min.x, flats.max.x, flats.min.y, ..; empty: there are none
    Bounds rest;      ///< of all other triangles, flat ones in other planes among them; not computed if `flats` is empty
};

/// Which end of the box a face is: 0 for min.x, 1 for max.x, 2 for min.y, ..
[[nodiscard]] constexpr int face_of(int axis, bool high) { return 2 * axis + (high ? 1 : 0); }

[[nodiscard]] inline float component(const Vec3f& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// Distance that counts as none beside coordinates of this size, 0 for an empty box: above the rounding of positions, below any step of a
/// model.
[[nodiscard]] float face_slack(const Bounds& bounds);

/// Triangles with a vertex that is not finite are left out. Requires: indices in range. clusters: the mesh's.
[[nodiscard]] FlatFaces find_flat_faces(const Mesh& mesh, std::span<const Cluster> clusters);

}  // namespace halflit::raster
