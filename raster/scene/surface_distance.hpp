// How close the surfaces of a scene come to points: what bounds the light that can fall on them.
#pragma once

#include "raster/scene/prepared_scene.hpp"

namespace halflit::raster {

/// Squared distance from a point to the nearest triangle of the scene, in double, world space. Looks at boxes of instances first, then at
/// those of clusters, and at triangles only in the few clusters that may hold the nearest one.
[[nodiscard]] double nearest_surface_squared(const PreparedScene& scene, Vec3d point);

/// Not less than the squared distance from a point to any point of the scene's surfaces: to the farthest corner of its box.
[[nodiscard]] double farthest_surface_squared(const PreparedScene& scene, Vec3d point);

}  // namespace halflit::raster
