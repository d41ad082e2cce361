#include "raster/geometry/section_triangulate.hpp"

#include "raster/geometry/section_sweep.hpp"

#include <algorithm>
#include <deque>

namespace halflit::raster {
namespace {

constexpr std::int64_t kMostSteps = std::int64_t{1} << 28;

/// Fills the region while the line sweeps over it. Between an edge and the next one above, if the region lies there, is a gap. Its chain is
/// the border of what is filled already: from the last corner of the lower edge to that of the upper edge. No triangle of two neighbours of
/// the chain would lie in the gap, so the chain is convex towards the right.
class Triangulation {
public:
    Triangulation(const std::vector<GridEdge>& edges, std::vector<GridPoint>& corners, std::vector<std::uint32_t>& triangles)
        : gap_above_(edges.size(), kNone), gap_below_(edges.size(), kNone), corners_(corners), triangles_(triangles) {}

    bool visit(const SweepEvent& event) {
        const auto corner = static_cast<std::uint32_t>(corners_.size());
        corners_.push_back(event.at);
        const auto& ending = event.ending;
        const auto& beginning = event.beginning;
        const std::uint32_t under = event.below == kNoEdge ? kNone : gap_above_[event.below];
        // The region is in the gap `lower` just below the event, and in `upper` just above it.
        std::uint32_t lower = under, upper = kNone;
        std::size_t e = 0;
        if (lower != kNone && ending.empty()) {
            upper = split(lower, corner);
        } else {
            if (lower != kNone) {
                if (gap_below_[ending[0]] != lower) return false;
                add_above(lower, corner, false);
                e = 1;
            }
            for (; e + 1 < ending.size(); e += 2) {
                const std::uint32_t gap = gap_above_[ending[e]];
                if (gap == kNone || gap_below_[ending[e + 1]] != gap) return false;
                add_above(gap, corner, true);
                chains_[gap].clear();
                free_.push_back(gap);
            }
            if (e < ending.size()) {
                upper = gap_above_[ending[e]];
                if (upper == kNone) return false;
                add_below(upper, corner);
            }
        }
        return begin(beginning, lower, upper, corner, event.above) && steps_ < kMostSteps;
    }

private:
    static constexpr std::uint32_t kNone = 0xffffffffu;
    using Chain = std::deque<std::uint32_t>;

    /// The edges that begin at the corner, and the gaps between them.
    bool begin(std::span<const std::uint32_t> beginning, std::uint32_t lower, std::uint32_t upper, std::uint32_t corner,
               std::uint32_t above) {
        std::size_t b = 0;
        if (beginning.empty()) {
            if ((lower == kNone) != (upper == kNone)) return false;
            if (lower != kNone) merge(lower, upper, above);
            return true;
        }
        if (lower != kNone) gap_below_[beginning[b++]] = lower;
        for (; b + 1 < beginning.size(); b += 2) gap_above_[beginning[b]] = gap_below_[beginning[b + 1]] = new_gap(corner);
        if ((b < beginning.size()) != (upper != kNone)) return false;
        if (upper == kNone) return true;
        gap_above_[beginning[b]] = upper;
        if (above == kNoEdge) return false;
        gap_below_[above] = upper;
        return true;
    }

    std::uint32_t new_gap(std::uint32_t corner) {
        std::uint32_t gap = static_cast<std::uint32_t>(chains_.size());
        if (free_.empty()) {
            chains_.emplace_back();
        } else {
            gap = free_.back();
            free_.pop_back();
        }
        chains_[gap].assign(1, corner);
        return gap;
    }

    void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles_.insert(triangles_.end(), {a, b, c}); }

    [[nodiscard]] bool seen(std::uint32_t low, std::uint32_t corner, std::uint32_t high) const {
        return orientation(corners_[low], corners_[corner], corners_[high]) > 0;
    }

    /// The corner becomes the last of the upper edge. all: it ends the gap, and sees the whole chain.
    void add_above(std::uint32_t gap, std::uint32_t corner, bool all) {
        Chain& chain = chains_[gap];
        while (chain.size() >= 2 && (all || seen(chain[chain.size() - 2], corner, chain.back()))) {
            add_triangle(chain[chain.size() - 2], corner, chain.back());
            chain.pop_back();
        }
        chain.push_back(corner);
    }

    /// The corner becomes the last of the lower edge.
    void add_below(std::uint32_t gap, std::uint32_t corner) {
        Chain& chain = chains_[gap];
        while (chain.size() >= 2 && seen(chain[0], corner, chain[1])) {
            add_triangle(chain[0], corner, chain[1]);
            chain.pop_front();
        }
        chain.push_front(corner);
    }

    /// The corner lies inside of the gap. A diagonal from it to the rightmost corner of the chain makes two gaps. Returns the upper one.
    std::uint32_t split(std::uint32_t gap, std::uint32_t corner) {
        const std::uint32_t upper = new_gap(corner);
        Chain &low = chains_[gap], &high = chains_[upper];
        const auto rightmost =
            std::max_element(low.begin(), low.end(), [&](std::uint32_t i, std::uint32_t j) { return corners_[i] < corners_[j]; });
        steps_ += static_cast<std::int64_t>(low.size());
        high.assign(rightmost, low.end());
        low.erase(rightmost + 1, low.end());
        add_above(gap, corner, false);
        add_below(upper, corner);
        return upper;
    }

    /// The corner ends the upper edge of one gap and the lower edge of the other, which become one.
    void merge(std::uint32_t lower, std::uint32_t upper, std::uint32_t above) {
        Chain &low = chains_[lower], &high = chains_[upper];
        steps_ += static_cast<std::int64_t>(high.size());
        low.insert(low.end(), high.begin() + 1, high.end());  // both have the corner
        high.clear();
        free_.push_back(upper);
        if (above != kNoEdge) gap_below_[above] = lower;
    }

    std::vector<std::uint32_t> gap_above_, gap_below_;  // of each edge
    std::vector<Chain> chains_;
    std::vector<std::uint32_t> free_;
    std::vector<GridPoint>& corners_;
    std::vector<std::uint32_t>& triangles_;
    std::int64_t steps_ = 0;
};

}  // namespace

bool triangulate(const std::vector<GridEdge>& edges, std::vector<GridPoint>& corners, std::vector<std::uint32_t>& triangles) {
    corners.clear();
    triangles.clear();
    Triangulation state(edges, corners, triangles);
    return sweep(edges, [&](const SweepEvent& event) { return state.visit(event); });
}

}  // namespace halflit::raster
