// Edges of a welded surface, with the triangles that run along each.
#pragma once

#include "raster/geometry/welded_surface.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <vector>

namespace halflit::raster {

/// A triangle's run along an edge.
class EdgeUse {
public:
    EdgeUse(std::uint32_t high, std::uint32_t corner) : bits_(std::uint64_t{high} << 32 | corner) {}
    [[nodiscard]] std::uint32_t high() const { return static_cast<std::uint32_t>(bits_ >> 32); }  ///< the edge's place of higher number
    /// Index into WeldedSurface::corners() of the corner from which the triangle runs along the edge.
    [[nodiscard]] std::uint32_t corner() const { return static_cast<std::uint32_t>(bits_); }
    [[nodiscard]] std::uint32_t triangle() const { return corner() / 3; }  ///< of WeldedSurface::corners()
    friend auto operator<=>(const EdgeUse&, const EdgeUse&) = default;

private:
    std::uint64_t bits_;
};

/// Calls body(low, uses) for each edge, by its place of lower number, with the uses of its triangles in their order. Linear time but for
/// sorting the edges of each place.
template <class Body>
void for_each_edge(const WeldedSurface& surface, const Body& body) {
    const std::vector<std::uint32_t>& corners = surface.corners();
    std::vector<std::uint32_t> begin(surface.places().size() + 1);  // of each place's uses
    std::vector<EdgeUse> uses(corners.size(), EdgeUse{0, 0});
    TimeCheck check;
    const auto each = [&](const auto& visit) {
        for (std::uint32_t first = 0; first < corners.size(); first += 3)
            for (std::uint32_t k = 0; k < 3; ++k) {
                check();
                const auto ends = std::minmax(corners[first + k], corners[first + (k + 1) % 3]);
                visit(ends.first, EdgeUse{ends.second, first + k});
            }
    };
    each([&](std::uint32_t low, EdgeUse) { ++begin[low]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());  // the ends; filling from there leaves the beginnings
    each([&](std::uint32_t low, EdgeUse use) { uses[--begin[low]] = use; });
    for (std::uint32_t low = 0; low + 1 < begin.size(); ++low) {
        const std::span<EdgeUse> of_place(uses.data() + begin[low], uses.data() + begin[low + 1]);
        std::sort(of_place.begin(), of_place.end(), timed_less(std::less<>()));
        for (std::size_t i = 0; i < of_place.size();) {
            std::size_t end = i + 1;
            for (; end < of_place.size() && of_place[end].high() == of_place[i].high(); ++end) check();
            check();
            body(low, std::span<const EdgeUse>(of_place.subspan(i, end - i)));
            i = end;
        }
    }
}

}  // namespace halflit::raster
