// Axis-aligned boxes.
#pragma once

#include "sh/vec3.hpp"

namespace halflit::raster {

/// The smallest box around points; coordinates of whatever space the points are in.
struct Bounds {
    Vec3f min{0, 0, 0}, max{0, 0, 0};
    bool empty = true;
    /// A point that is not finite is left out.
    void add(Vec3f p);
    /// A box, whole.
    void include(const Bounds& other);
    [[nodiscard]] Vec3f center() const;
    [[nodiscard]] float radius() const;  ///< half the diagonal
};

}  // namespace halflit::raster
