// Distances from a point to the surfaces of a scene. They bound what a surface can get from a light at that point.
#pragma once

#include "raster/scene/prepared_data.hpp"

namespace halflit::raster {

/// Squared distance from a point to the nearest triangle of the scene, in double, world space. Tests the boxes of instances first, then
/// those of clusters, and then only the triangles of the few clusters that may hold the nearest one.
[[nodiscard]] double nearest_surface_squared(const PreparedData& scene, Vec3d point);

/// Upper bound on the squared distance from a point to the scene's surfaces: that to the farthest corner of the scene's box.
[[nodiscard]] double farthest_surface_squared(const PreparedData& scene, Vec3d point);

}  // namespace halflit::raster
