// The view of a camera of parallel rays, by rays against all triangles in double. Independent of the renderer: it shares no matrix with it.
#pragma once

#include "halflit/scene.hpp"

#include <cstdint>
#include <vector>

namespace halflit::test {

/// A triangle that rays can hit.
struct RayTriangle {
    Vec3d corners[3];  ///< world space, counter-clockwise seen from the front
    bool two_sided = false;
    bool drawn = true;  ///< false: it hides nothing and is not seen
};
/// Triangles of all instances in order, as Certificate::triangles has them.
[[nodiscard]] std::vector<RayTriangle> ray_triangles(const Scene& scene);

/// Pixels that show a triangle. A ray that passes an edge or another surface closer than the tolerance may see either.
struct RayCount {
    std::int64_t sure = 0, possible = 0;
};
/// The tolerances of the renderer: vertices are rounded to 1/256 of a pixel, and depth to float32.
struct RayTolerance {
    double edge_px = 1.0 / 64, depth_share = 1e-5;  ///< of the extent of the scene along the rays
};
/// Where a pixel's ray passes, pixels from the pixel's upper left corner.
struct RayPlace {
    double x = 0.5, y = 0.5;
};
inline constexpr RayPlace kPixelCentre{};
inline constexpr RayPlace kFirstOfFour{0.5 - 2.0 / 16, 0.5 - 6.0 / 16};  ///< the first of 4 samples, as graphics hardware has them
[[nodiscard]] std::vector<RayCount> count_by_rays(const std::vector<RayTriangle>& triangles, const Camera& camera, int width, int height,
                                                  RayPlace place, RayTolerance tolerance = {});

/// True if a ray from the point towards the direction meets a drawn triangle's front, or either side of a two-sided one. `without`: the
/// triangle that the point lies on.
[[nodiscard]] bool is_blocked(const std::vector<RayTriangle>& triangles, Vec3d point, Vec3d direction, std::size_t without,
                              double least_distance);

}  // namespace halflit::test
