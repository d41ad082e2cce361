// Axis-aligned boxes.
#pragma once

#include "sh/vec3.hpp"

namespace halflit::raster {

/// Smallest box around a set of points, in the points' space.
struct Bounds {
    Vec3f min{0, 0, 0}, max{0, 0, 0};
    bool empty = true;
    /// Adds a point; ignores it if it is not finite.
    void add(Vec3f p);
    /// Adds a box.
    void include(const Bounds& other);
    [[nodiscard]] Vec3f center() const;
    [[nodiscard]] float radius() const;  ///< half the diagonal
};

}  // namespace halflit::raster
