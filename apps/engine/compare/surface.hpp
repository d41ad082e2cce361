// The triangles of a scene, with the search for the one nearest to a point.
#pragma once

#include "halflit/math.hpp"
#include "halflit/scene.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace halflit::engine {

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
        std::uint64_t steps = 0;     ///< boxes and triangles that were looked at
    };
    /// The nearest triangle. The search begins at `guess`, an index into triangles(), and is faster the nearer that is. It ends at the
    /// first triangle that it finds within `enough`. Requires: there are triangles.
    [[nodiscard]] Nearest nearest(Vec3d point, std::uint32_t guess = 0, double enough = 0.0) const;

    /// In an order of their own.
    [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
    [[nodiscard]] bool empty() const { return triangles_.empty(); }

private:
    /// Two boxes of the hierarchy, in one line of the cache. A box has `count` triangles from `begin` on; 0: what is in the node `begin`.
    /// Boxes are rounded outwards.
    struct alignas(64) Node {
        float low[3][2], high[3][2];
        std::uint32_t begin[2];
        std::uint8_t count[2];
    };
    /// A triangle that is to be sorted, by three times its middle.
    struct Sorted {
        Vec3f middle;
        std::uint32_t triangle;
    };
    void sort();
    void split(std::uint32_t node, std::span<Sorted> sorted, std::uint32_t first);
    void enclose(std::uint32_t node, std::size_t side, std::span<const Sorted> sorted);

    std::vector<Triangle> triangles_;
    std::vector<Node> nodes_;
};

}  // namespace halflit::engine
