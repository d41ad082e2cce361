// Cameras that the flags place.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/mesh.hpp"

namespace halflit::cli {

/// Perspective camera at `eye` that looks at `target`, with +y up. Its near plane is half way to the nearest point of `bounds`, or a small
/// share of the scene's size if that is more.
[[nodiscard]] Camera placed_camera(Vec3f eye, Vec3f target, float fov_y_deg, const Bounds& bounds);

}  // namespace halflit::cli
