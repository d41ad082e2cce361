#include "raster/geometry/section_fill.hpp"

#include "raster/geometry/section_grid.hpp"
#include "raster/geometry/section_refine.hpp"
#include "raster/geometry/section_sweep.hpp"
#include "raster/geometry/section_triangulate.hpp"

#include <algorithm>
#include <numeric>

namespace halflit::raster {
namespace {

/// The grid over a list of points, and the point of the list at each place that has one.
class PlaneGrid {
public:
    explicit PlaneGrid(const std::vector<Vec2<double>>& points) : points_(points), places_(points.size()) {
        Vec2<double> low = points[0], high = points[0];
        for (const Vec2<double>& p : points) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
        center_ = (low + high) * 0.5;
        const double half = std::max(high.x - low.x, high.y - low.y) * 0.5;
        scale_ = half > 0.0 ? static_cast<double>(kGridHalf) / half : 0.0;
        if (!(scale_ < 1e300)) scale_ = 0.0;
        for (std::size_t i = 0; i < points.size(); ++i) places_[i] = {nearest(points[i]), static_cast<std::uint32_t>(i)};
        sorted_ = places_;
        std::sort(sorted_.begin(), sorted_.end(),
                  timed_less([](const Place& a, const Place& b) { return a.at != b.at ? a.at < b.at : a.source < b.source; }));
        const auto same = [](const Place& a, const Place& b) { return a.at == b.at; };
        sorted_.erase(std::unique(sorted_.begin(), sorted_.end(), same), sorted_.end());
    }

    [[nodiscard]] GridPoint operator[](std::uint32_t point) const { return places_[point].at; }
    [[nodiscard]] std::size_t size() const { return sorted_.size(); }
    /// Number of a place that has a point.
    [[nodiscard]] std::size_t number(GridPoint p) const { return static_cast<std::size_t>(find(p) - sorted_.begin()); }
    [[nodiscard]] FillPoint point(GridPoint p) const {
        const auto found = find(p);
        if (found != sorted_.end() && found->at == p) return {points_[found->source], static_cast<std::int64_t>(found->source)};
        return {{center_.x + p.x / scale_, center_.y + p.y / scale_}, -1};
    }
    [[nodiscard]] Vec2<double> center() const { return center_; }

private:
    struct Place {
        GridPoint at;
        std::uint32_t source = 0;
    };

    [[nodiscard]] std::vector<Place>::const_iterator find(GridPoint p) const {
        return std::lower_bound(sorted_.begin(), sorted_.end(), p, [](const Place& place, GridPoint at) { return place.at < at; });
    }
    [[nodiscard]] GridPoint nearest(Vec2<double> p) const {
        const auto whole = [&](double x) {
            const double scaled = std::clamp(x * scale_, -static_cast<double>(kGridHalf), static_cast<double>(kGridHalf));
            return static_cast<std::int32_t>(scaled + (scaled < 0.0 ? -0.5 : 0.5));
        };
        return {whole(p.x - center_.x), whole(p.y - center_.y)};
    }

    const std::vector<Vec2<double>>& points_;
    std::vector<Place> places_, sorted_;
    Vec2<double> center_;
    double scale_ = 0.0;
};

/// Removes what hangs together with an open end, and counts the open ends.
std::size_t remove_open(std::vector<GridEdge>& edges, const PlaneGrid& grid) {
    std::vector<std::uint32_t> parent(grid.size());
    std::vector<std::int64_t> balance(grid.size(), 0);
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::size_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    for (const GridEdge& e : edges) {
        const std::size_t a = grid.number(e.a), b = grid.number(e.b);
        balance[a] += e.weight;
        balance[b] -= e.weight;
        parent[root(a)] = static_cast<std::uint32_t>(root(b));
    }
    std::size_t open = 0;
    std::vector<bool> is_open(grid.size(), false);
    for (std::size_t i = 0; i < balance.size(); ++i) {
        if (balance[i] == 0) continue;
        open += static_cast<std::size_t>(balance[i] < 0 ? -balance[i] : balance[i]);
        is_open[root(i)] = true;
    }
    if (open > 0) std::erase_if(edges, [&](const GridEdge& e) { return is_open[root(grid.number(e.a))]; });
    return open;
}

/// Leaves the edges that have winding number 0 on one side alone. Their weight becomes 1 where the region is above, -1 where it is below.
bool keep_border(std::vector<GridEdge>& edges) {
    std::vector<std::int64_t> winding(edges.size(), 0);  // above each edge
    const bool swept = sweep(edges, [&](const SweepEvent& event) {
        std::int64_t now = event.below == kNoEdge ? 0 : winding[event.below];
        for (const std::uint32_t i : event.beginning) winding[i] = now += edges[i].weight;
        return true;
    });
    if (!swept) return false;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const bool inside_above = winding[i] != 0, inside_below = winding[i] - edges[i].weight != 0;
        if (inside_above != inside_below) edges[kept++] = {edges[i].a, edges[i].b, inside_above ? 1 : -1};
    }
    edges.resize(kept);
    return true;
}

}  // namespace

PlaneFill fill_segments(const std::vector<Vec2<double>>& points, const std::vector<PlaneSegment>& segments) {
    PlaneFill fill;
    if (points.empty()) return fill;
    const PlaneGrid grid(points);
    std::vector<GridEdge> edges;
    edges.reserve(segments.size());
    for (const PlaneSegment& s : segments) {
        const GridPoint from = grid[s.from], to = grid[s.to];
        if (from != to) edges.push_back(from < to ? GridEdge{from, to, 1} : GridEdge{to, from, -1});
    }
    merge_equal(edges);
    fill.open_ends = remove_open(edges, grid);
    std::vector<GridPoint> corners;
    if (!split_at_crossings(edges) || !keep_border(edges) || !triangulate(edges, corners, fill.triangles)) {
        fill.triangles.clear();
        fill.too_complex = true;
        return fill;
    }
    refine(corners, fill.triangles);
    fill.points.reserve(corners.size());
    for (const GridPoint p : corners) fill.points.push_back(grid.point(p));
    double doubled = 0.0;
    for (const GridEdge& e : edges) {
        const Vec2<double> a = grid.point(e.a).at - grid.center(), b = grid.point(e.b).at - grid.center();
        doubled += (a.x * b.y - a.y * b.x) * e.weight;
    }
    fill.area = doubled * 0.5;
    return fill;
}

}  // namespace halflit::raster
