// Distances from the origin to segments and triangles, in double.
#pragma once

#include "halflit/math.hpp"

#include <algorithm>

namespace halflit::raster {

/// Squared distance from the origin to the segment from a to b.
[[nodiscard]] inline double segment_distance_squared(Vec3d a, Vec3d b) {
    const Vec3d along = b - a;
    const double length = dot(along, along);
    const double t = length > 0.0 ? std::clamp(-dot(a, along) / length, 0.0, 1.0) : 0.0;
    const Vec3d nearest = a + along * t;
    return dot(nearest, nearest);
}

/// Squared distance from the origin to a triangle: to its plane if the foot of the perpendicular lies inside, otherwise to an edge.
[[nodiscard]] inline double triangle_distance_squared(Vec3d a, Vec3d b, Vec3d c) {
    const Vec3d normal = cross(b - a, c - a);
    const double area = dot(normal, normal);
    if (area > 0.0) {
        const double sides[3] = {dot(cross(b - a, Vec3d{} - a), normal), dot(cross(c - b, Vec3d{} - b), normal),
                                 dot(cross(a - c, Vec3d{} - c), normal)};
        if (sides[0] >= 0.0 && sides[1] >= 0.0 && sides[2] >= 0.0) {
            const double height = dot(a, normal);
            return height * height / area;
        }
    }
    return std::min({segment_distance_squared(a, b), segment_distance_squared(b, c), segment_distance_squared(c, a)});
}

}  // namespace halflit::raster
