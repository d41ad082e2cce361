// Cameras that the flags place.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/mesh.hpp"

namespace halflit::cli {

/// Distance of a near plane: half way to the nearest point of `bounds`, or a small share of the scene's size if that is more; the default
/// for empty bounds.
[[nodiscard]] float near_plane(const Mat4& world_from_camera, const Bounds& bounds);

/// Perspective camera at a place, with that near plane.
[[nodiscard]] Camera placed_camera(const Mat4& world_from_camera, float fov_y_deg, const Bounds& bounds);

/// Perspective camera at `eye` that looks at `target`, with +y up.
[[nodiscard]] Camera placed_camera(Vec3f eye, Vec3f target, float fov_y_deg, const Bounds& bounds);

}  // namespace halflit::cli
