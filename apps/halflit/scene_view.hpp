// Cameras that the flags place, and scenes whose vertical axis is not y.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/mesh.hpp"
#include "halflit/scene.hpp"

#include <cstdint>
#include <string_view>

namespace halflit::cli {

/// The axis of a model that points up.
enum class UpAxis : std::uint8_t { x, y, z, minus_x, minus_y, minus_z };

/// Indexed by UpAxis.
inline constexpr std::string_view kUpAxisNames[] = {"x", "y", "z", "-x", "-y", "-z"};

/// Turns instances, cameras and lights by quarter turns, so that `up` becomes +y.
void turn_upright(Scene& scene, UpAxis up);
/// The same turn of a point.
[[nodiscard]] Vec3d turned_upright(Vec3d point, UpAxis up);

/// Perspective camera at `eye` that looks at `target`, with +y up. Its near plane is half way to the nearest point of `bounds`, or a small
/// share of the scene's size if that is more.
[[nodiscard]] Camera placed_camera(Vec3f eye, Vec3f target, float fov_y_deg, const Bounds& bounds);

}  // namespace halflit::cli
