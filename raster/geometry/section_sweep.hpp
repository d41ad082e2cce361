// A line that sweeps over edges that have only ends in common, and keeps those that it meets in their order from below.
#pragma once

#include "raster/geometry/section_grid.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <set>
#include <span>
#include <vector>

namespace halflit::raster {

/// No edge.
inline constexpr std::uint32_t kNoEdge = 0xffffffffu;

/// One end of edges. Numbers of edges, each list from below.
struct SweepEvent {
    GridPoint at;
    std::span<const std::uint32_t> ending, beginning;
    std::uint32_t below, above;  ///< the edges that the line meets next; kNoEdge: none
};

/// Calls visit(SweepEvent) for all ends from left to right, those of one x from below; it returns false to stop. False if it was stopped,
/// or if the edges are not as required: sorted by merge_equal(), and with no points in common but their ends.
template <class Visit>
[[nodiscard]] bool sweep(std::span<const GridEdge> edges, const Visit& visit) {
    const auto is_below = [edges](std::uint32_t i, std::uint32_t j) {
        if (i == j) return false;
        const GridEdge &e = edges[i], &f = edges[j];
        if (e.a <= f.a) {
            const std::int64_t side = orientation(e.a, e.b, f.a);
            return (side != 0 ? side : orientation(e.a, e.b, f.b)) > 0;
        }
        const std::int64_t side = orientation(f.a, f.b, e.a);
        return (side != 0 ? side : orientation(f.a, f.b, e.b)) < 0;
    };
    using Line = std::set<std::uint32_t, decltype(is_below)>;
    Line line(is_below);
    std::vector<typename Line::iterator> place(edges.size(), line.end());
    std::vector<GridPoint> ends;
    std::vector<std::uint32_t> by_end(edges.size());
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
        by_end[i] = i;
        ends.push_back(edges[i].a);
        ends.push_back(edges[i].b);
    }
    std::sort(by_end.begin(), by_end.end(), [&](std::uint32_t i, std::uint32_t j) { return edges[i].b < edges[j].b; });
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    std::vector<std::uint32_t> ending, beginning;
    std::size_t next_ending = 0;
    std::uint32_t next_beginning = 0;
    TimeCheck check;
    for (const GridPoint at : ends) {
        check();
        ending.clear();
        beginning.clear();
        std::size_t count = 0;
        for (; next_ending < by_end.size() && edges[by_end[next_ending]].b == at; ++next_ending) ++count;
        for (; next_beginning < edges.size() && edges[next_beginning].a == at; ++next_beginning) beginning.push_back(next_beginning);
        std::sort(beginning.begin(), beginning.end(), is_below);
        auto next = line.end();
        if (count > 0) {
            next = place[by_end[next_ending - 1]];
            if (next == line.end()) return false;
            while (next != line.begin() && edges[*std::prev(next)].b == at) --next;
            while (next != line.end() && edges[*next].b == at) {
                ending.push_back(*next);
                next = line.erase(next);
            }
            if (ending.size() != count) return false;
        } else {
            next = line.lower_bound(beginning[0]);
        }
        const std::uint32_t below = next == line.begin() ? kNoEdge : *std::prev(next), above = next == line.end() ? kNoEdge : *next;
        if (!visit(SweepEvent{at, ending, beginning, below, above})) return false;
        const std::size_t before = line.size();
        for (const std::uint32_t i : beginning) place[i] = line.insert(next, i);
        if (line.size() != before + beginning.size()) return false;
    }
    return line.empty();
}

}  // namespace halflit::raster
