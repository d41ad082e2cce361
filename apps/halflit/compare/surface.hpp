// The triangles of a scene, with the search for the one nearest to a point.
#pragma once

#include "halflit/math.hpp"
#include "halflit/scene.hpp"

#include <cstdint>
#include <vector>

namespace halflit::cli {

struct Triangle {
    Vec3d a, b, c;
};

/// Distance from a point to a triangle.
[[nodiscard]] double distance_to(const Triangle& triangle, Vec3d point);

/// All triangles of the instances that views count, in the scene's world, in double. Those with a corner that is not finite are left out.
/// Takes no more time than the thread's limit allows (OutOfTime). Time to build: n log n.
class Surface {
public:
    explicit Surface(const Scene& scene);

    struct Nearest {
        double distance = 0;
        std::uint32_t triangle = 0;  ///< index into triangles()
    };
    /// Requires: there are triangles.
    [[nodiscard]] Nearest nearest(Vec3d point) const;

    /// In an order of their own.
    [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
    [[nodiscard]] bool empty() const { return triangles_.empty(); }

private:
    /// A box of the hierarchy. Its children are the next node and `second`; a leaf has `count` triangles from `first` on.
    struct Node {
        Vec3d low, high;
        std::uint32_t first = 0, count = 0, second = 0;
    };
    void split(std::uint32_t first, std::uint32_t count);

    std::vector<Triangle> triangles_;
    std::vector<Node> nodes_;
};

}  // namespace halflit::cli
