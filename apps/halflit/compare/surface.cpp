#include "apps/halflit/compare/surface.hpp"

#include "raster/scene/instance_material.hpp"
#include "raster/scene/placed_point.hpp"
#include "raster/scene/triangle_distance.hpp"
#include "sh/mat4.hpp"
#include "sh/time_limit.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace halflit::cli {
namespace {

constexpr std::uint32_t kLeafTriangles = 4;
/// The hierarchy halves the triangles, so 2^32 of them have 32 levels.
constexpr std::size_t kMostLevels = 40;

double coordinate(Vec3d p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

Vec3d lower(Vec3d a, Vec3d b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3d upper(Vec3d a, Vec3d b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

/// Three times the centre.
Vec3d middle(const Triangle& t) { return (t.a + t.b) + t.c; }

double box_distance_squared(Vec3d low, Vec3d high, Vec3d p) {
    const Vec3d outside = upper(upper(low - p, p - high), Vec3d{});
    return dot(outside, outside);
}

bool is_finite(Vec3d p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace

double distance_to(const Triangle& triangle, Vec3d point) {
    return std::sqrt(raster::triangle_distance_squared(triangle.a - point, triangle.b - point, triangle.c - point));
}

Surface::Surface(const Scene& scene) {
    TimeCheck check;
    for (const Instance& instance : scene.instances) {
        if (!raster::counts_for_views(scene, instance)) continue;
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const auto vertex = [&](std::uint32_t index) {
            return raster::placed_in_double(instance.world_from_object, mesh.positions[index]);
        };
        for (std::size_t t = 0; t < triangles_of(mesh); ++t) {
            check();
            const Triangle placed{vertex(mesh.indices[3 * t]), vertex(mesh.indices[3 * t + 1]), vertex(mesh.indices[3 * t + 2])};
            if (is_finite(placed.a) && is_finite(placed.b) && is_finite(placed.c)) triangles_.push_back(placed);
        }
    }
    if (!triangles_.empty()) split(0, static_cast<std::uint32_t>(triangles_.size()));
}

void Surface::split(std::uint32_t first, std::uint32_t count) {
    check_time();
    const std::size_t at = nodes_.size();
    nodes_.push_back({triangles_[first].a, triangles_[first].a, first, count, 0});
    Vec3d low = middle(triangles_[first]), high = low;
    for (std::uint32_t i = first; i < first + count; ++i) {
        const Triangle& t = triangles_[i];
        nodes_[at].low = lower(nodes_[at].low, lower(t.a, lower(t.b, t.c)));
        nodes_[at].high = upper(nodes_[at].high, upper(t.a, upper(t.b, t.c)));
        low = lower(low, middle(t)), high = upper(high, middle(t));
    }
    if (count <= kLeafTriangles) return;
    const Vec3d size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto begin = triangles_.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count,
                     [axis](const Triangle& s, const Triangle& t) { return coordinate(middle(s), axis) < coordinate(middle(t), axis); });
    nodes_[at].count = 0;
    split(first, count / 2);
    nodes_[at].second = static_cast<std::uint32_t>(nodes_.size());
    split(first + count / 2, count - count / 2);
}

Surface::Nearest Surface::nearest(Vec3d point) const {
    double best = std::numeric_limits<double>::infinity();
    std::uint32_t found = 0;
    struct Waiting {
        std::uint32_t node;
        double squared;
    };
    Waiting stack[2 * kMostLevels];
    std::size_t waiting = 0;
    stack[waiting++] = {0, 0.0};
    const auto to_box = [&](std::uint32_t node) { return box_distance_squared(nodes_[node].low, nodes_[node].high, point); };
    while (waiting > 0) {
        const Waiting next = stack[--waiting];
        if (!(next.squared < best)) continue;
        const Node& node = nodes_[next.node];
        if (node.count > 0) {
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
                const Triangle& t = triangles_[i];
                const double squared = raster::triangle_distance_squared(t.a - point, t.b - point, t.c - point);
                if (squared < best) best = squared, found = i;
            }
            continue;
        }
        const Waiting one{next.node + 1, to_box(next.node + 1)}, other{node.second, to_box(node.second)};
        const bool one_first = one.squared <= other.squared;
        stack[waiting++] = one_first ? other : one;
        stack[waiting++] = one_first ? one : other;
    }
    return {std::sqrt(best), found};
}

}  // namespace halflit::cli
