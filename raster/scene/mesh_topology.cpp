#include "raster/scene/mesh_topology.hpp"

#include "shading/model/numbers.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace halflit::raster {

namespace {

/// Number of each vertex's position: the same for vertices with equal positions.
std::vector<std::uint32_t> places_of(const std::vector<Vec3f>& positions) {
    std::vector<std::uint32_t> order(positions.size()), place(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
        const Vec3f &p = positions[a], &q = positions[b];
        return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
    };
    std::sort(order.begin(), order.end(), before);
    for (std::size_t i = 0; i < order.size(); ++i)
        place[order[i]] = i > 0 && !before(order[i - 1], order[i]) ? place[order[i - 1]] : static_cast<std::uint32_t>(i);
    return place;
}

}  // namespace

bool is_closed(const Mesh& mesh) {
    if (mesh.topology != Topology::triangles) return false;
    for (const Vec3f& p : mesh.positions)
        if (!shading::finite(p)) return false;  // NaN cannot be sorted
    const std::vector<std::uint32_t> place = places_of(mesh.positions);
    struct Edge {
        std::uint64_t ends;  // lower position number in the upper 32 bits, higher one below
        int direction;
    };
    std::vector<Edge> edges;
    edges.reserve(mesh.indices.size());
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::uint32_t corner[3] = {place[mesh.indices[i]], place[mesh.indices[i + 1]], place[mesh.indices[i + 2]]};
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
        for (int c = 0; c < 3; ++c) {
            const std::uint64_t from = corner[c], to = corner[(c + 1) % 3];
            edges.push_back({from < to ? from << 32 | to : to << 32 | from, from < to ? 1 : -1});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.ends < b.ends; });
    for (std::size_t i = 0; i < edges.size();) {
        int balance = 0;
        const std::uint64_t ends = edges[i].ends;
        for (; i < edges.size() && edges[i].ends == ends; ++i) balance += edges[i].direction;
        if (balance != 0) return false;
    }
    return !edges.empty();
}

}  // namespace halflit::raster
