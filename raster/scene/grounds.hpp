// Grounds: flat instances that are much larger than all that stands on them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace halflit::raster {

/// An instance's box in world space, and the number of its triangles.
struct PlacedTriangles {
    double low[3], high[3];
    std::uint64_t triangles;
};

/// Indices of the boxes that are grounds, the largest first. One is flat (its height at most a hundredth of its width), no higher than the
/// middle of the rest, has fewer triangles than the rest, and the radius of the rest is below 1/16 of that of the whole.
[[nodiscard]] std::vector<std::size_t> grounds_of(const std::vector<PlacedTriangles>& all);

}  // namespace halflit::raster
