// Filling of oriented segments in a plane by the nonzero rule.
#pragma once

#include "halflit/math.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace halflit::raster {

/// A directed segment between two points of a list; its left side is inside.
struct PlaneSegment {
    std::uint32_t from = 0, to = 0;
};

/// A corner of a filled region. source: index of the point of the list that lies there; -1: a crossing of segments, or a point inside.
struct FillPoint {
    Vec2<double> at;
    std::int64_t source = -1;
};

/// The region whose winding number is not 0.
struct PlaneFill {
    std::vector<FillPoint> points;
    std::vector<std::uint32_t> triangles;  ///< three indices of points each, counter-clockwise; neighbours share their corners
    double area = 0.0;                     ///< of the region
    std::size_t open_ends = 0;             ///< ends of segments that no other segment continues
    bool too_complex = false;              ///< the region was not found within the limits on work; no triangles
};

/// Fills the segments. They may cross, overlap and lie on each other. Points that are nearer to each other than 2^-29 of the half extent
/// are one. Segments that hang together, some end of which is open, are left out. Takes n log n steps for n segments that seldom meet.
[[nodiscard]] PlaneFill fill_segments(const std::vector<Vec2<double>>& points, const std::vector<PlaneSegment>& segments);

}  // namespace halflit::raster
