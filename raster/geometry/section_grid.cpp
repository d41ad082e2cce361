#include "raster/geometry/section_grid.hpp"

#include "sh/time_limit.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace halflit::raster {
namespace {

constexpr std::int64_t kMostComparisons = std::int64_t{1} << 28;
constexpr std::size_t kMostSplits = std::size_t{1} << 20;
constexpr int kMostRounds = 40;
constexpr std::uint32_t kLeafEdges = 8;

struct GridBox {
    GridPoint low, high;
    [[nodiscard]] bool meets(const GridBox& other) const {
        return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y && other.low.y <= high.y;
    }
    void include(const GridBox& other) {
        low = {std::min(low.x, other.low.x), std::min(low.y, other.low.y)};
        high = {std::max(high.x, other.high.x), std::max(high.y, other.high.y)};
    }
};

GridBox box_of(const GridEdge& e) {  // a.x <= b.x
    return {{e.a.x, std::min(e.a.y, e.b.y)}, {e.b.x, std::max(e.a.y, e.b.y)}};
}

/// A tree of boxes over edges, which finds pairs of edges whose boxes meet.
class EdgeTree {
public:
    explicit EdgeTree(const std::vector<GridEdge>& edges) : order_(edges.size()) {
        boxes_.reserve(edges.size());
        for (const GridEdge& edge : edges) boxes_.push_back(box_of(edge));
        std::iota(order_.begin(), order_.end(), 0u);
        if (!edges.empty()) build(0, static_cast<std::uint32_t>(edges.size()));
    }

    /// Calls pair(i, j) once for each pair, i < j. False if that takes too many comparisons.
    template <class Pair>
    [[nodiscard]] bool for_each_pair(const Pair& pair) const {
        std::int64_t left = kMostComparisons;
        std::vector<std::uint32_t> stack;
        TimeCheck check;
        for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
            stack.assign(1, 0u);
            while (!stack.empty()) {
                check();
                const Node& node = nodes_[stack.back()];
                const std::uint32_t left_child = stack.back() + 1;
                stack.pop_back();
                if (--left < 0) return false;
                if (!node.box.meets(boxes_[i])) continue;
                if (node.right_child != 0) {
                    stack.push_back(left_child);
                    stack.push_back(node.right_child);
                    continue;
                }
                for (std::uint32_t k = node.first; k < node.last; ++k)
                    if (const std::uint32_t j = order_[k]; i < j && boxes_[i].meets(boxes_[j])) pair(i, j);
                left -= node.last - node.first;
            }
        }
        return true;
    }

private:
    struct Node {
        GridBox box;
        std::uint32_t first = 0, last = 0;  // range of order_
        std::uint32_t right_child = 0;      // 0: a leaf. The left child follows its parent
    };

    void build(std::uint32_t first, std::uint32_t last) {
        const std::size_t at = nodes_.size();
        nodes_.push_back({boxes_[order_[first]], first, last});
        for (std::uint32_t k = first; k < last; ++k) nodes_[at].box.include(boxes_[order_[k]]);
        if (last - first <= kLeafEdges) return;
        const GridBox box = nodes_[at].box;
        const bool by_x = std::int64_t{box.high.x} - box.low.x >= std::int64_t{box.high.y} - box.low.y;
        const auto middle = [&](std::uint32_t i) {
            const GridBox& b = boxes_[i];
            return by_x ? std::int64_t{b.low.x} + b.high.x : std::int64_t{b.low.y} + b.high.y;
        };
        const std::uint32_t half = first + (last - first) / 2;
        std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + last,
                         [&](std::uint32_t i, std::uint32_t j) { return middle(i) != middle(j) ? middle(i) < middle(j) : i < j; });
        build(first, half);
        nodes_[at].right_child = static_cast<std::uint32_t>(nodes_.size());
        build(half, last);
    }

    std::vector<GridBox> boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

using Splits = std::vector<std::pair<std::uint32_t, GridPoint>>;

/// True if p lies on the edge, but is none of its ends.
bool is_inside(GridPoint p, const GridEdge& e) { return e.a < p && p < e.b && orientation(e.a, e.b, p) == 0; }

std::int32_t rounded(double x) {
    const auto down = static_cast<std::int32_t>(x);  // towards 0
    const double rest = x - down;
    return rest >= 0.5 ? down + 1 : rest < -0.5 ? down - 1 : down;
}

void add_splits(Splits& splits, const std::vector<GridEdge>& edges, std::uint32_t i, std::uint32_t j) {
    const GridEdge &e = edges[i], &f = edges[j];
    const std::int64_t ea = orientation(f.a, f.b, e.a), eb = orientation(f.a, f.b, e.b);
    const std::int64_t fa = orientation(e.a, e.b, f.a), fb = orientation(e.a, e.b, f.b);
    const bool crosses = ((ea > 0 && eb < 0) || (ea < 0 && eb > 0)) && ((fa > 0 && fb < 0) || (fa < 0 && fb > 0));
    if (crosses) {
        const double t = static_cast<double>(ea) / (static_cast<double>(ea) - static_cast<double>(eb));
        const GridPoint p{rounded(e.a.x + (static_cast<double>(e.b.x) - e.a.x) * t),
                          rounded(e.a.y + (static_cast<double>(e.b.y) - e.a.y) * t)};
        if (p != e.a && p != e.b) splits.emplace_back(i, p);
        if (p != f.a && p != f.b) splits.emplace_back(j, p);
        return;
    }
    for (const GridPoint p : {f.a, f.b})
        if (is_inside(p, e)) splits.emplace_back(i, p);
    for (const GridPoint p : {e.a, e.b})
        if (is_inside(p, f)) splits.emplace_back(j, p);
}

void add_part(std::vector<GridEdge>& edges, GridPoint from, GridPoint to, int weight) {
    if (from == to) return;
    edges.push_back(from < to ? GridEdge{from, to, weight} : GridEdge{to, from, -weight});
}

void apply(std::vector<GridEdge>& edges, Splits& splits) {
    const auto along = [&](const auto& s, const auto& t) {
        if (s.first != t.first) return s.first < t.first;
        const GridEdge& e = edges[s.first];
        const auto place = [&](GridPoint p) {
            return (std::int64_t{p.x} - e.a.x) * (std::int64_t{e.b.x} - e.a.x) +
                   (std::int64_t{p.y} - e.a.y) * (std::int64_t{e.b.y} - e.a.y);
        };
        const std::int64_t at_s = place(s.second), at_t = place(t.second);
        return at_s != at_t ? at_s < at_t : s.second < t.second;
    };
    std::sort(splits.begin(), splits.end(), along);
    for (std::size_t k = 0; k < splits.size();) {
        const std::uint32_t i = splits[k].first;
        const GridEdge whole = edges[i];
        GridPoint from = whole.a;
        for (; k < splits.size() && splits[k].first == i; ++k) {
            add_part(edges, from, splits[k].second, whole.weight);
            from = splits[k].second;
        }
        add_part(edges, from, whole.b, whole.weight);
        edges[i].weight = 0;
    }
}

}  // namespace

void merge_equal(std::vector<GridEdge>& edges) {
    std::sort(edges.begin(), edges.end(),
              timed_less([](const GridEdge& e, const GridEdge& f) { return e.a != f.a ? e.a < f.a : e.b < f.b; }));
    std::size_t kept = 0;
    for (std::size_t i = 0; i < edges.size();) {
        GridEdge sum = edges[i];
        for (++i; i < edges.size() && edges[i].a == sum.a && edges[i].b == sum.b; ++i) sum.weight += edges[i].weight;
        if (sum.weight != 0) edges[kept++] = sum;
    }
    edges.resize(kept);
}

bool split_at_crossings(std::vector<GridEdge>& edges) {
    for (int round = 0; round < kMostRounds; ++round) {
        merge_equal(edges);
        Splits splits;
        const EdgeTree tree(edges);
        const bool done = tree.for_each_pair([&](std::uint32_t i, std::uint32_t j) {
            if (splits.size() <= kMostSplits) add_splits(splits, edges, i, j);
        });
        if (!done || splits.size() > kMostSplits) return false;
        if (splits.empty()) return true;
        apply(edges, splits);
    }
    return false;
}

}  // namespace halflit::raster
