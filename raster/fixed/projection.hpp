// Matrices of cameras and lights of fixed-function pictures, with reversed depth.
#pragma once

#include "halflit/math.hpp"
#include "sh/mat4.hpp"

namespace halflit::raster {

/// A view's axes and place: x to the right, y up, looking along -z. up: not along `forward`.
[[nodiscard]] Mat4 view_from_world(Vec3f position, Vec3f forward, Vec3f up);

/// What a view sees at the distance near_z, or everywhere if it is parallel.
struct Frustum {
    double left, right, bottom, top, near_z, far_z;
    bool parallel;
};
/// clip_from_world of a view; clip z is w at near_z and 0 at far_z.
[[nodiscard]] Mat4 clip_from_view(const Frustum& frustum);

}  // namespace halflit::raster
