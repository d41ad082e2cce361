#include "raster/scene/mesh_topology.hpp"

#include "sh/time_limit.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

namespace halflit::raster {
namespace {

/// Disjoint sets of triangles. The lowest number stands for its set.
class TriangleSets {
public:
    explicit TriangleSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
    void join(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        if (a != b) parent_[std::max(a, b)] = std::min(a, b);
    }
    [[nodiscard]] std::uint64_t count() const {
        std::uint64_t sets = 0;
        for (std::size_t i = 0; i < parent_.size(); ++i) sets += parent_[i] == i ? 1 : 0;
        return sets;
    }

private:
    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    std::vector<std::uint32_t> parent_;
};

/// Edges, each by the lower number of its two places: those of place p lie from begin[p] to begin[p + 1]. An edge has the number of its
/// higher place in the upper 32 bits, and below it the corner at which a triangle runs along it.
struct EdgeLists {
    std::vector<std::uint32_t> begin;
    std::vector<std::uint64_t> edges;

    explicit EdgeLists(const WeldedSurface& surface) : begin(surface.places().size() + 1), edges(surface.corners().size()) {
        const std::vector<std::uint32_t>& corners = surface.corners();
        TimeCheck check;
        const auto each = [&](const auto& visit) {
            for (std::uint32_t first = 0; first < corners.size(); first += 3)
                for (std::uint32_t k = 0; k < 3; ++k) {
                    check();
                    const auto [low, high] = std::minmax(corners[first + k], corners[first + (k + 1) % 3]);
                    visit(low, high, first + k);
                }
        };
        each([&](std::uint32_t low, std::uint32_t, std::uint32_t) { ++begin[low]; });
        std::partial_sum(begin.begin(), begin.end(), begin.begin());  // the ends; filling from there leaves the beginnings
        each(
            [&](std::uint32_t low, std::uint32_t high, std::uint32_t corner) { edges[--begin[low]] = std::uint64_t{high} << 32 | corner; });
    }
};

}  // namespace

SurfaceTopology topology_of(const WeldedSurface& surface) {
    SurfaceTopology found;
    const std::vector<std::uint32_t>& corners = surface.corners();
    if (corners.empty()) return found;
    EdgeLists lists(surface);
    TriangleSets bodies(corners.size() / 3);
    found.balanced = true;
    TimeCheck check;
    for (std::uint32_t place = 0; place < surface.places().size(); ++place) {
        std::uint64_t* const begin = lists.edges.data() + lists.begin[place];
        std::uint64_t* const end = lists.edges.data() + lists.begin[place + 1];
        std::sort(begin, end, timed_less(std::less<>()));
        for (const std::uint64_t* edge = begin; edge != end;) {
            const std::uint64_t high = *edge >> 32;
            const auto first = static_cast<std::uint32_t>(*edge);
            std::uint64_t uses = 0, upwards = 0;  // upwards: from the lower place to the higher one
            for (; edge != end && *edge >> 32 == high; ++edge) {
                check();
                const auto corner = static_cast<std::uint32_t>(*edge);
                ++uses;
                upwards += corners[corner] == place ? 1 : 0;
                if (uses > 1) bodies.join(first / 3, corner / 3);
            }
            found.open_edges += uses == 1 ? 1 : 0;
            found.flipped_edges += uses == 2 && upwards != 1 ? 1 : 0;
            found.crowded_edges += uses > 2 ? 1 : 0;
            found.balanced &= 2 * upwards == uses;
        }
    }
    found.bodies = bodies.count();
    return found;
}

bool is_closed(const Mesh& mesh) {
    WeldedSurface surface;
    surface.add(mesh, Mat4::identity());
    return surface.not_finite() == 0 && topology_of(surface).balanced;
}

}  // namespace halflit::raster
