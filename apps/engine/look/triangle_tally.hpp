// Counts the pixels that show each triangle of a model.
#pragma once

#include "apps/engine/look/view_shot.hpp"
#include "halflit/scene.hpp"

#include <cstdint>
#include <vector>

namespace halflit::engine {

/// Numbers of triangles over all instances: an instance's triangles follow those of the instance before it.
struct TriangleNumbers {
    explicit TriangleNumbers(const Scene& scene);
    std::vector<std::size_t> first;   ///< of each instance
    std::vector<bool> has_triangles;  ///< of each instance; false: lines or points, which have no number
    std::size_t count = 0;            ///< of all
};

/// Pixels that show a triangle.
struct SeenTriangle {
    std::uint32_t triangle;  ///< number over all instances
    std::int32_t pixels;     ///< at least 1
};

/// Counts one shot at a time. Keeps four bytes a triangle between shots.
class TriangleTally {
public:
    explicit TriangleTally(const TriangleNumbers& numbers) : numbers_(numbers), pixels_(numbers.count, 0) {}
    /// In the order in which rows of pixels show them.
    [[nodiscard]] std::vector<SeenTriangle> count(const ViewShot& shot);

private:
    const TriangleNumbers& numbers_;
    std::vector<std::int32_t> pixels_;  ///< of the shot that is counted; else 0
};

}  // namespace halflit::engine
