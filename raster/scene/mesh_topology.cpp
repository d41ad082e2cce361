#include "raster/scene/mesh_topology.hpp"

#include "raster/scene/surface_edges.hpp"

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

private:
    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    std::vector<std::uint32_t> parent_;
};

}  // namespace

SurfaceTopology topology_of(const WeldedSurface& surface) {
    SurfaceTopology found;
    const std::vector<std::uint32_t>& corners = surface.corners();
    if (corners.empty()) return found;
    TriangleSets bodies(corners.size() / 3);
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
        found.balanced &= 2 * upwards == uses.size();
    });
    found.bodies = bodies.count();
    return found;
}

bool is_closed(const Mesh& mesh) {
    WeldedSurface surface;
    surface.add(mesh, Mat4::identity());
    return surface.not_finite() == 0 && topology_of(surface).balanced;
}

}  // namespace halflit::raster
