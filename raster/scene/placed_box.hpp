// Boxes of meshes and clusters in world space, without a look at every vertex.
#pragma once

#include "raster/detail/view_math.hpp"
#include "raster/scene/prepared_mesh.hpp"
#include "sh/mat4.hpp"

namespace halflit::raster {

/// World-space box around a transformed box, in double. A margin covers float32's rounding of the points inside.
struct PlacedBox {
    double low[3], high[3];
    PlacedBox(const float (&min)[3], const float (&max)[3], const Mat4& world_from_object);
};

/// World-space box of the finite vertices that some triangle uses, each transformed in float32 as the renderer does it. Reads only the
/// vertices of clusters that may extend the box.
[[nodiscard]] Bounds placed_bounds(const Mesh& mesh, const PreparedMesh& prepared, const Mat4& world_from_object);

/// A box around the transformed box: larger than placed_bounds, and found without a look at vertices.
[[nodiscard]] Bounds rough_bounds(const Bounds& object, const Mat4& world_from_object);

/// Squared distance from a point to the box [low, high]; 0 inside.
[[nodiscard]] inline double box_distance_squared(const double (&low)[3], const double (&high)[3], Vec3d p) {
    const double at[3] = {p.x, p.y, p.z};
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = larger(0.0, larger(low[axis] - at[axis], at[axis] - high[axis]));
        sum += d * d;
    }
    return sum;
}

}  // namespace halflit::raster
