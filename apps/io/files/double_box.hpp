// A box in double.
#pragma once

#include "halflit/math.hpp"

#include <algorithm>

namespace halflit::io::detail {

struct DoubleBox {
    Vec3d min{1e300, 1e300, 1e300}, max{-1e300, -1e300, -1e300};

    void include(Vec3d p) {
        min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
        max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
    }
    [[nodiscard]] bool empty() const { return !(min.x <= max.x); }
    [[nodiscard]] Vec3d center() const { return (min + max) * 0.5; }
    [[nodiscard]] double radius() const { return length(max - min) * 0.5; }
    /// Farther from the origin than 1024 times its radius: float32 would lose more than 2^-14 of its size.
    [[nodiscard]] bool is_far() const { return !empty() && radius() > 0.0 && length(center()) > 1024.0 * radius(); }
};

}  // namespace halflit::io::detail
