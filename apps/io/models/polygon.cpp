#include "apps/io/models/polygon.hpp"

#include "apps/io/files/load_failure.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"
#include "shading/model/numbers.hpp"

#include <algorithm>

namespace halflit::io::detail {

namespace {

/// Some four seconds. A concave polygon of n corners takes at most n^2 tests, and few in common ones, whose ears are narrow.
constexpr std::uint64_t kMostTests = std::uint64_t{1} << 30;

}  // namespace

void PolygonCutter::flatten(std::span<const Vec3d> corners) {
    Vec3d normal;  // Newell's sum, from the first corner on, so that a far polygon keeps its digits
    const Vec3d origin = corners[0];
    for (std::size_t i = 0; i < corners.size(); ++i)
        normal = normal + cross(corners[i] - origin, corners[(i + 1) % corners.size()] - origin);
    const Vec3d size = absolute(normal);
    points_.clear();
    for (const Vec3d& corner : corners) {
        const Vec3d p = corner - origin;
        if (size.z >= size.x && size.z >= size.y)
            points_.push_back({normal.z < 0 ? -p.x : p.x, p.y});
        else if (size.x >= size.y)
            points_.push_back({normal.x < 0 ? -p.y : p.y, p.z});
        else
            points_.push_back({normal.y < 0 ? -p.z : p.z, p.x});
    }
}

namespace {

/// Twice the signed area of a triangle, > 0 where it turns left.
template <class Point>
double area(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace

bool PolygonCutter::is_convex() const {
    const std::size_t n = points_.size();
    int turns_down = 0;  // of the x direction; more than 2 in a polygon that winds around twice
    for (std::size_t i = 0; i < n; ++i) {
        const Point &a = points_[i], &b = points_[(i + 1) % n], &c = points_[(i + 2) % n];
        if (!(area(a, b, c) > 0)) return false;  // with corners on an edge, a fan would have triangles without area
        if ((b.x > a.x) != (c.x > b.x)) ++turns_down;
    }
    return turns_down <= 2;
}

bool PolygonCutter::is_ear(std::uint32_t before, std::uint32_t corner, std::uint32_t after) {
    const Point &a = points_[before], &b = points_[corner], &c = points_[after];
    ++tests_;
    if (!(area(a, b, c) > 0)) return false;
    const auto is = [](const Point& p, const Point& q) { return p.x == q.x && p.y == q.y; };
    const double left = std::min({a.x, b.x, c.x}), right = std::max({a.x, b.x, c.x});
    const double low = std::min({a.y, b.y, c.y}), high = std::max({a.y, b.y, c.y});
    const auto first = std::lower_bound(reflex_.begin(), reflex_.end(), left, [](const Reflex& r, double x) { return r.at.x < x; });
    for (auto r = first; r != reflex_.end() && r->at.x <= right; ++r) {
        ++tests_;
        const Point& p = r->at;
        if (p.y < low || p.y > high || cut_off_[r->corner] || is(p, a) || is(p, b) || is(p, c)) continue;
        if (area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0) return false;
    }
    return true;
}

void PolygonCutter::clip_ears(std::vector<std::uint32_t>& triangles) {
    const auto n = static_cast<std::uint32_t>(points_.size());
    next_.resize(n);
    previous_.resize(n);
    cut_off_.assign(n, false);
    reflex_.clear();
    for (std::uint32_t i = 0; i < n; ++i) {
        next_[i] = (i + 1) % n;
        previous_[i] = (i + n - 1) % n;
        if (area(points_[previous_[i]], points_[i], points_[next_[i]]) <= 0) reflex_.push_back({points_[i], i});  // the others stay convex
    }
    std::sort(reflex_.begin(), reflex_.end(), [](const Reflex& a, const Reflex& b) { return a.at.x < b.at.x; });
    std::uint32_t corner = 1, without_ear = 0;
    for (std::uint32_t left = n; left > 3;) {
        if (tests_ >= next_look_) {
            check_time();
            next_look_ = tests_ + (std::uint64_t{1} << 22);
        }
        if (tests_ > kMostTests) refuse("", "its concave polygons have too many corners to be cut into triangles", ErrorCode::limit);
        const std::uint32_t before = previous_[corner], after = next_[corner];
        if (without_ear < left && !is_ear(before, corner, after)) {
            corner = after;
            ++without_ear;
            continue;
        }
        triangles.insert(triangles.end(), {before, corner, after});
        cut_off_[corner] = true;
        next_[before] = after;
        previous_[after] = before;
        corner = after;
        without_ear = 0;
        if (--left % 64 == 0) std::erase_if(reflex_, [&](const Reflex& r) { return cut_off_[r.corner]; });
    }
    triangles.insert(triangles.end(), {previous_[corner], corner, next_[corner]});
}

void PolygonCutter::cut(std::span<const Vec3d> corners, std::vector<std::uint32_t>& triangles) {
    const auto n = static_cast<std::uint32_t>(corners.size());
    if (n < 3) return;
    if (n > 3) {
        flatten(corners);
        const bool finite = std::all_of(corners.begin(), corners.end(), [](const Vec3d& p) { return shading::finite(p); });
        if (finite && !is_convex()) return clip_ears(triangles);
    }
    for (std::uint32_t i = 1; i + 1 < n; ++i) triangles.insert(triangles.end(), {0u, i, i + 1});
}

}  // namespace halflit::io::detail
