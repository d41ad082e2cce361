#include "raster/geometry/section_refine.hpp"

#include "sh/time_limit.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace halflit::raster {
namespace {

constexpr std::uint32_t kBorder = 0xffffffffu;
/// A triangle is thin if the radius of the circle around it is more than this times its shortest edge. Above 1, a new corner is farther
/// from all others than they were, so the work ends.
constexpr double kThin = 1.5;
constexpr std::int64_t kShortest = 64;  // edges below, in units of the grid, are left as they are: rounding would decide

double squared_distance(GridPoint a, GridPoint b) {
    const double x = static_cast<double>(b.x) - a.x, y = static_cast<double>(b.y) - a.y;
    return x * x + y * y;
}

/// Above 0: d is in the circle around a, b, c, counter-clockwise. In double: a wrong sign near 0 gives another triangulation, but a valid
/// one.
double in_circle(GridPoint a, GridPoint b, GridPoint c, GridPoint d) {
    const double ax = static_cast<double>(a.x) - d.x, ay = static_cast<double>(a.y) - d.y;
    const double bx = static_cast<double>(b.x) - d.x, by = static_cast<double>(b.y) - d.y;
    const double cx = static_cast<double>(c.x) - d.x, cy = static_cast<double>(c.y) - d.y;
    const double aa = ax * ax + ay * ay, bb = bx * bx + by * by, cc = cx * cx + cy * cy;
    const double size = (aa + bb) * cc + aa * bb;
    const double value = (ax * (by * cc - bb * cy) - ay * (bx * cc - bb * cx)) + aa * (bx * cy - by * cx);
    return value > 1e-12 * size ? value : 0.0;
}

/// Triangles that know their neighbours.
class Net {
public:
    Net(std::vector<GridPoint>& corners, const std::vector<std::uint32_t>& triangles) : corners_(corners) {
        struct Side {
            std::uint32_t low, high, triangle, side;
        };
        std::vector<Side> sides;
        for (std::uint32_t t = 0; 3 * t + 2 < triangles.size(); ++t) {
            net_.push_back({{triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]}, {kBorder, kBorder, kBorder}});
            for (std::uint32_t s = 0; s < 3; ++s) {
                const std::uint32_t a = net_[t].corner[s], b = net_[t].corner[(s + 1) % 3];
                sides.push_back({std::min(a, b), std::max(a, b), t, s});
            }
        }
        const auto before = [](const Side& a, const Side& b) {
            if (a.low != b.low) return a.low < b.low;
            if (a.high != b.high) return a.high < b.high;
            return a.triangle != b.triangle ? a.triangle < b.triangle : a.side < b.side;
        };
        std::sort(sides.begin(), sides.end(), timed_less(before));
        for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
            const Side &a = sides[i], &b = sides[i + 1];
            if (a.low != b.low || a.high != b.high) continue;
            net_[a.triangle].next[a.side] = b.triangle;
            net_[b.triangle].next[b.side] = a.triangle;
            ++i;
        }
    }

    void run() {
        const std::size_t most_corners = 4 * corners_.size() + 16;
        steps_left_ = static_cast<std::int64_t>(net_.size()) * 60 + 10000;
        for (std::uint32_t t = 0; t < net_.size(); ++t) suspects_.push_back(t);
        flip_all();
        thin_.clear();
        for (std::uint32_t t = 0; t < net_.size(); ++t) thin_.push_back(t);
        for (std::size_t i = 0; i < thin_.size() && corners_.size() < most_corners && steps_left_ > 0; ++i) add_center(thin_[i]);
    }

    [[nodiscard]] std::vector<std::uint32_t> triangles() const {
        std::vector<std::uint32_t> out;
        for (const Triangle& t : net_) out.insert(out.end(), t.corner.begin(), t.corner.end());
        return out;
    }

private:
    struct Triangle {
        std::array<std::uint32_t, 3> corner;  // counter-clockwise
        std::array<std::uint32_t, 3> next;    // across the side from corner i to i + 1
    };

    [[nodiscard]] GridPoint at(std::uint32_t t, std::uint32_t i) const { return corners_[net_[t].corner[i % 3]]; }

    /// Side of a triangle across which another one lies, by its corners.
    [[nodiscard]] std::uint32_t side_from(std::uint32_t t, std::uint32_t corner) const {
        std::uint32_t s = 0;
        while (s < 2 && net_[t].corner[s] != corner) ++s;
        return s;
    }

    void replace_next(std::uint32_t t, std::uint32_t from_corner, std::uint32_t with) {
        if (t != kBorder) net_[t].next[side_from(t, from_corner)] = with;
    }

    /// Turns the diagonal across a side if the other one is better. True if it did.
    bool flip(std::uint32_t t, std::uint32_t s) {
        const std::uint32_t u = net_[t].next[s];
        if (u == kBorder || u == t) return false;
        const std::uint32_t a = net_[t].corner[s], b = net_[t].corner[(s + 1) % 3], c = net_[t].corner[(s + 2) % 3];
        const std::uint32_t us = side_from(u, b);
        if (net_[u].corner[(us + 1) % 3] != a) return false;
        const std::uint32_t d = net_[u].corner[(us + 2) % 3];
        const GridPoint pa = corners_[a], pb = corners_[b], pc = corners_[c], pd = corners_[d];
        if (orientation(pa, pd, pc) <= 0 || orientation(pd, pb, pc) <= 0) return false;  // not convex
        const bool is_flat = orientation(pa, pb, pc) <= 0 || orientation(pb, pa, pd) <= 0;
        if (!is_flat && !(in_circle(pa, pb, pc, pd) > 0.0)) return false;
        const std::uint32_t bc = net_[t].next[(s + 1) % 3], ca = net_[t].next[(s + 2) % 3];
        const std::uint32_t ad = net_[u].next[(us + 1) % 3], db = net_[u].next[(us + 2) % 3];
        net_[t] = {{a, d, c}, {ad, u, ca}};
        net_[u] = {{d, b, c}, {db, bc, t}};
        replace_next(ad, d, t);
        replace_next(bc, c, u);
        suspects_.push_back(t);
        suspects_.push_back(u);
        return true;
    }

    void flip_all() {
        while (!suspects_.empty() && steps_left_ > 0) {
            check_();
            --steps_left_;
            const std::uint32_t t = suspects_.back();
            suspects_.pop_back();
            thin_.push_back(t);
            for (std::uint32_t s = 0; s < 3; ++s)
                if (flip(t, s)) break;
        }
        suspects_.clear();
    }

    /// Adds the centre of the circle around a thin triangle, if it is seen from there.
    void add_center(std::uint32_t t) {
        const GridPoint a = at(t, 0), b = at(t, 1), c = at(t, 2);
        const double doubled = static_cast<double>(orientation(a, b, c));
        if (!(doubled > 0.0)) return;
        const double ab = squared_distance(a, b), bc = squared_distance(b, c), ca = squared_distance(c, a);
        const double shortest = std::min({ab, bc, ca});
        // The radius is the product of the edges over twice `doubled`.
        if (ab * bc / doubled * (ca / doubled) * 0.25 <= kThin * kThin * shortest) return;
        if (shortest < static_cast<double>(kShortest * kShortest)) return;
        const double bx = static_cast<double>(b.x) - a.x, by = static_cast<double>(b.y) - a.y;
        const double cx = static_cast<double>(c.x) - a.x, cy = static_cast<double>(c.y) - a.y;
        const double x = a.x + (cy * ab - by * ca) / (2.0 * doubled), y = a.y + (bx * ca - cx * ab) / (2.0 * doubled);
        if (!(x > -kGridHalf && x < kGridHalf && y > -kGridHalf && y < kGridHalf)) return;
        const GridPoint center{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
        // Walks there from triangle to triangle. The border ends the walk.
        for (int step = 0; step < 1000; ++step) {
            --steps_left_;
            std::uint32_t s = 0;
            while (s < 3 && orientation(at(t, s), at(t, s + 1), center) >= 0) ++s;
            if (s == 3) break;
            t = net_[t].next[s];
            if (t == kBorder) return;
        }
        for (std::uint32_t s = 0; s < 3; ++s)
            if (orientation(at(t, s), at(t, s + 1), center) <= 0) return;  // on an edge, where it would make flat triangles
        split(t, center);
        flip_all();
    }

    void split(std::uint32_t t, GridPoint p) {
        const auto corner = static_cast<std::uint32_t>(corners_.size()), u = static_cast<std::uint32_t>(net_.size()), v = u + 1;
        corners_.push_back(p);
        const Triangle old = net_[t];
        const auto [a, b, c] = old.corner;
        net_[t] = {{a, b, corner}, {old.next[0], u, v}};
        net_.push_back({{b, c, corner}, {old.next[1], v, t}});
        net_.push_back({{c, a, corner}, {old.next[2], t, u}});
        replace_next(old.next[1], c, u);
        replace_next(old.next[2], a, v);
        for (const std::uint32_t one : {t, u, v}) suspects_.push_back(one);
    }

    std::vector<GridPoint>& corners_;
    std::vector<Triangle> net_;
    std::vector<std::uint32_t> suspects_;  // that may have a bad diagonal
    std::vector<std::uint32_t> thin_;      // that may be thin
    std::int64_t steps_left_ = 0;
    TimeCheck check_;
};

}  // namespace

void refine(std::vector<GridPoint>& corners, std::vector<std::uint32_t>& triangles) {
    Net net(corners, triangles);
    net.run();
    triangles = net.triangles();
}

}  // namespace halflit::raster
