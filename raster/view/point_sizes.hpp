// Sizes at which the points of clouds close the surface that they lie on.
#pragma once

#include "halflit/scene.hpp"
#include "sh/mat4.hpp"

#include <cstdint>
#include <vector>

namespace halflit::raster {

/// Sizes of points by their place in the picture. A grid of cells; sizes between the middles of cells are interpolated.
struct PointSizes {
    int columns = 0, rows = 0;
    float cells_per_unit = 0.0f;  ///< a unit is 1/256 pixel
    int usual = 0;                ///< the median of the cells that have points, in 1/256 pixel
    std::vector<float> size;      ///< of each cell, in 1/256 pixel; empty: the scene has no points
    friend bool operator==(const PointSizes&, const PointSizes&) = default;

    [[nodiscard]] bool empty() const { return size.empty(); }
    /// x, y: as ScreenVertex has them.
    [[nodiscard]] int at(std::int32_t x, std::int32_t y) const {
        const auto place = [this](std::int32_t v, int count, int& first, float& share) {
            constexpr float kHalfPixel = 128.0f;
            const float along = (static_cast<float>(v) + kHalfPixel) * cells_per_unit - 0.5f, last = static_cast<float>(count - 1);
            const float inside = along > 0.0f ? along < last ? along : last : 0.0f;
            first = static_cast<int>(inside);
            first = first < count - 1 ? first : count > 1 ? count - 2 : 0;
            share = inside - static_cast<float>(first);
        };
        int column = 0, row = 0;
        float across = 0, down = 0;
        place(x, columns, column, across);
        place(y, rows, row, down);
        const float* const here =
            &size[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
        const float* const below = rows > 1 ? here + columns : here;
        const int next = columns > 1 ? 1 : 0;
        const float upper = here[0] + (here[next] - here[0]) * across, lower = below[0] + (below[next] - below[0]) * across;
        return static_cast<int>(upper + (lower - upper) * down);
    }
};

/// Sizes by the distances between points around each cell of the picture: 2 pixels at least, a 25th of the picture's shorter side at
/// most. A surface is taken to have points at random, and a body to have two sides.
[[nodiscard]] PointSizes closing_point_sizes(const Scene& scene, const Mat4& clip_from_world, int width, int height);

}  // namespace halflit::raster
