// Points of meshes in the world, in double.
#pragma once

#include "sh/mat4.hpp"

namespace halflit::raster {

/// @{
/// The image of a point. Vertices at one place of one mesh, or of meshes that are placed alike, get the same bits.
[[nodiscard]] inline Vec3d placed_in_double(const Mat4& m, Vec3d p) {
    return ((axis(m, 0) * p.x + axis(m, 1) * p.y) + axis(m, 2) * p.z) + axis(m, 3);
}
[[nodiscard]] inline Vec3d placed_in_double(const Mat4& m, Vec3f p) { return placed_in_double(m, Vec3d{p.x, p.y, p.z}); }
/// @}

}  // namespace halflit::raster
