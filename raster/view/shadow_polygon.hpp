// Convex polygons in space, and cuts through them.
#pragma once

#include "sh/vec3d.hpp"

#include <cstddef>
#include <vector>

namespace halflit::raster {

using Polygon = std::vector<Vec3d>;

/// Points with dot(normal, p) + offset >= 0.
struct HalfSpace {
    Vec3d normal;
    double offset = 0;
    [[nodiscard]] double at(Vec3d p) const { return dot(normal, p) + offset; }
};

/// Clips a convex polygon [Sutherland & Hodgman 1974]. Cut points lie on its edges, so no rounding moves them farther than that.
inline void clip(Polygon& polygon, const HalfSpace& keep, Polygon& scratch) {
    scratch.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3d a = polygon[i], b = polygon[i + 1 < polygon.size() ? i + 1 : 0];
        const double at_a = keep.at(a), at_b = keep.at(b);
        if (at_a >= 0.0) scratch.push_back(a);
        if ((at_a >= 0.0) != (at_b >= 0.0)) scratch.push_back(a + (b - a) * (at_a / (at_a - at_b)));
    }
    polygon.swap(scratch);
}

}  // namespace halflit::raster
