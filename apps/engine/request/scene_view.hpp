// Cameras that the flags place.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/mesh.hpp"

namespace halflit::engine {

/// Perspective camera at a place, whose near plane the box of the scene decides.
[[nodiscard]] Camera placed_camera(const Mat4& world_from_camera, float fov_y_deg, const Bounds& bounds);

/// Perspective camera at `eye` that looks at `target`, with +y up.
[[nodiscard]] Camera placed_camera(Vec3f eye, Vec3f target, float fov_y_deg, const Bounds& bounds);

}  // namespace halflit::engine
