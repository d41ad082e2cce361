// Segments in a plane on a grid of whole numbers, where tests of orientation are exact.
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

namespace halflit::raster {

/// Coordinates are within +-2^29, so products of differences fit into 62 bits.
struct GridPoint {
    std::int32_t x = 0, y = 0;
    friend auto operator<=>(const GridPoint&, const GridPoint&) = default;
};

/// Largest absolute coordinate.
inline constexpr std::int32_t kGridHalf = 1 << 29;

/// Twice the signed area of the triangle a b c: above 0 where it is counter-clockwise.
[[nodiscard]] constexpr std::int64_t orientation(GridPoint a, GridPoint b, GridPoint c) {
    return (std::int64_t{b.x} - a.x) * (std::int64_t{c.y} - a.y) - (std::int64_t{b.y} - a.y) * (std::int64_t{c.x} - a.x);
}

/// A segment from the lesser end to the greater one, x before y. weight: how many run from a to b, less those that run from b to a. The
/// winding number above the segment is that below it plus the weight. Above is the side of greater y, or of lesser x if it is vertical.
struct GridEdge {
    GridPoint a, b;  // a < b
    int weight = 0;
};

/// Sorts edges and adds the weights of equal ones. Those of weight 0 are removed.
void merge_equal(std::vector<GridEdge>& edges);

/// Splits edges where they meet until they have no points in common but their ends. Crossings are rounded to the grid. False, with edges
/// that still cross, if that takes more than 2^28 comparisons, 2^20 splits in a round, or 40 rounds. Adds the weights of equal edges.
[[nodiscard]] bool split_at_crossings(std::vector<GridEdge>& edges);

}  // namespace halflit::raster
