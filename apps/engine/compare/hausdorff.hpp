// The largest distance from one surface to another, with a proof of how far off it may be.
#pragma once

#include "apps/engine/compare/surface.hpp"

#include <cstdint>

namespace halflit::engine {

/// The one-sided Hausdorff distance from a surface: the largest distance of a point of it from the other surface. It is in
/// [at_least, at_most].
struct FarthestPoint {
    double at_least = 0;  ///< measured: the distance of `point`
    double at_most = 0;
    Vec3d point{};             ///< of the surface
    std::uint64_t points = 0;  ///< that were measured
};

/// Finds it by dividing triangles. The distance to a triangle is a convex function, so on a triangle `s` the distance to the other surface
/// is at most the largest of the distances of the corners of `s` to any one of its triangles. Triangles whose bound is below the largest
/// distance that was measured are left; others are measured at their middle. Those whose bound is still above that distance by more than
/// `accuracy` are cut into four, and so on. Ends at kMostDistancePoints points, or when searches took kMostDistanceSteps steps and
/// kStepsATriangle for each triangle (surfaces whose triangles cross take many), with a wider bound. So the result depends on the
/// surfaces alone, not on time or threads.
/// Requires: neither surface is empty.
[[nodiscard]] FarthestPoint farthest_point(const Surface& from, const Surface& to, double accuracy);

/// Boxes and triangles that farthest_point looks at: so many, and so many for each triangle of both surfaces.
inline constexpr std::uint64_t kMostDistanceSteps = std::uint64_t{1} << 26, kStepsATriangle = 256;
/// Most points that farthest_point measures, besides one for each triangle.
inline constexpr std::uint64_t kMostDistancePoints = std::uint64_t{1} << 21;

}  // namespace halflit::engine
