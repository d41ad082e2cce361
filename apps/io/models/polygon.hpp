// Polygons cut into triangles.
#pragma once

#include "halflit/math.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace halflit::io::detail {

/// Cuts polygons by fixed rules, so that the same corners give the same triangles everywhere. A convex polygon becomes a fan around its
/// first corner. From another one, ears are cut: the first corner after the last cut whose triangle is to the inside and has no other
/// corner in it. A polygon that crosses itself has no ear at some time; then the next corner is cut as it is.
class PolygonCutter {
public:
    /// Appends three numbers of corners for each triangle, in the polygon's direction of turning; n - 2 triangles. The polygon is looked at
    /// along the coordinate axis nearest to its normal. One with a corner that is not finite is a fan, too. Throws LoadFailure (limit) when
    /// all polygons together have too many corners.
    void cut(std::span<const Vec3d> corners, std::vector<std::uint32_t>& triangles);

private:
    struct Point {
        double x, y;
    };
    void flatten(std::span<const Vec3d> corners);
    [[nodiscard]] bool is_convex() const;
    void clip_ears(std::vector<std::uint32_t>& triangles);
    [[nodiscard]] bool is_ear(std::uint32_t before, std::uint32_t corner, std::uint32_t after);

    std::vector<Point> points_;
    /// A corner at which the polygon turns away.
    struct Reflex {
        Point at;
        std::uint32_t corner;
    };

    std::vector<std::uint32_t> next_, previous_;
    std::vector<Reflex> reflex_;  ///< by x
    std::vector<bool> cut_off_;
    std::uint64_t tests_ = 0, next_look_ = 0;  ///< points that were looked for in triangles, of all polygons
};

}  // namespace halflit::io::detail
