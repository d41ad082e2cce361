#include "raster/geometry/mesh_topology.hpp"

#include "raster/geometry/surface_edges.hpp"

#include <algorithm>
#include <numeric>
#include <span>
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

    /// The number of each triangle's set, by the first triangles of the sets.
    [[nodiscard]] std::vector<std::uint32_t> numbers() {
        std::vector<std::uint32_t> number(parent_.size());
        std::uint32_t sets = 0;
        // A set's lowest triangle, which stands for it, comes before its others.
        for (std::uint32_t i = 0; i < parent_.size(); ++i) number[i] = parent_[i] == i ? sets++ : number[root(i)];
        return number;
    }

private:
    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    std::vector<std::uint32_t> parent_;
};

/// An edge that is open, flipped, crowded or not balanced, by one of its triangles.
struct FaultyEdge {
    std::uint32_t triangle;
    std::uint32_t uses;
    bool balanced;
};

/// Calls fault(FaultyEdge) for each of them.
template <class Fault>
SurfaceTopology find_topology(const WeldedSurface& surface, TriangleSets& bodies, const Fault& fault) {
    SurfaceTopology found;
    const std::vector<std::uint32_t>& corners = surface.corners();
    if (corners.empty()) return found;
    found.balanced = true;
    for_each_edge(surface, [&](std::uint32_t low, std::span<const EdgeUse> uses) {
        std::size_t upwards = 0;  // from the lower place to the higher one
        for (const EdgeUse& use : uses) {
            upwards += corners[use.corner()] == low ? 1 : 0;
            bodies.join(uses[0].triangle(), use.triangle());
        }
        found.open_edges += uses.size() == 1 ? 1 : 0;
        found.flipped_edges += uses.size() == 2 && upwards != 1 ? 1 : 0;
        found.crowded_edges += uses.size() > 2 ? 1 : 0;
        const bool balanced = 2 * upwards == uses.size();
        found.balanced &= balanced;
        if (uses.size() != 2 || !balanced) fault(FaultyEdge{uses[0].triangle(), static_cast<std::uint32_t>(uses.size()), balanced});
    });
    found.bodies = bodies.count();
    return found;
}

}  // namespace

SurfaceTopology topology_of(const WeldedSurface& surface) {
    TriangleSets sets(surface.corners().size() / 3);
    return find_topology(surface, sets, [](const FaultyEdge&) {});
}

SurfaceTopology topology_of(const WeldedSurface& surface, std::size_t most_bodies, SurfaceBodies& bodies) {
    TriangleSets sets(surface.corners().size() / 3);
    std::vector<FaultyEdge> faulty;
    const SurfaceTopology found = find_topology(surface, sets, [&](const FaultyEdge& edge) { faulty.push_back(edge); });
    bodies.of_triangle = sets.numbers();
    bodies.edges.assign(static_cast<std::size_t>(std::min<std::uint64_t>(found.bodies, most_bodies)), {});
    for (const FaultyEdge& edge : faulty) {
        const std::size_t body = bodies.of_triangle[edge.triangle];
        if (body >= bodies.edges.size()) continue;
        BodyEdges& edges = bodies.edges[body];
        edges.open += edge.uses == 1 ? 1 : 0;
        edges.flipped += edge.uses == 2 ? 1 : 0;
        edges.crowded += edge.uses > 2 ? 1 : 0;
        edges.balanced &= edge.balanced;
    }
    return found;
}

bool is_closed(const Mesh& mesh) {
    WeldedSurface surface;
    surface.add(mesh, Mat4::identity());
    return surface.not_finite() == 0 && topology_of(surface).balanced;
}

}  // namespace halflit::raster
