#include "raster/scene/surface_distance.hpp"

#include "raster/detail/view_math.hpp"
#include "raster/scene/placed_box.hpp"
#include "raster/scene/triangle_distance.hpp"
#include "sh/mat4.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

namespace halflit::raster {
namespace {

constexpr double kFar = std::numeric_limits<double>::max();

/// Squared distance from the origin to the box around a triangle: a tenth of the work of triangle_distance.
double corners_distance(Vec3d a, Vec3d b, Vec3d c) {
    return box_distance_squared({std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})},
                                {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})}, {0, 0, 0});
}

/// Boxes by their distance, the nearest on top.
using BoxHeap = std::vector<std::pair<double, std::size_t>>;

/// Visits the boxes that are nearer than `nearest`, the nearest one first. `visit` may lower `nearest`.
template <class Distance, class Visit>
void visit_nearest_first(std::size_t count, double& nearest, BoxHeap& heap, const Distance& distance, const Visit& visit) {
    heap.clear();
    for (std::size_t i = 0; i < count; ++i)
        if (const double d = distance(i); d < nearest) heap.emplace_back(d, i);
    std::make_heap(heap.begin(), heap.end(), std::greater<>());
    while (!heap.empty() && heap.front().first < nearest) {
        const std::size_t i = heap.front().second;
        std::pop_heap(heap.begin(), heap.end(), std::greater<>());
        heap.pop_back();
        visit(i);
    }
}

class NearestSurface {
public:
    NearestSurface(const PreparedData& scene, Vec3d point) : scene_(scene), point_(point) {}

    double find() {
        const auto bounds = scene_.instance_bounds();
        BoxHeap heap;
        visit_nearest_first(
            bounds.size(), nearest_, heap,
            [&](std::size_t i) {
                const Vec3f low = bounds[i].min, high = bounds[i].max;
                return bounds[i].empty ? kFar : box_distance_squared({low.x, low.y, low.z}, {high.x, high.y, high.z}, point_);
            },
            [&](std::size_t i) { look_into(scene_.scene().instances[i]); });
        return nearest_;
    }

private:
    void look_into(const Instance& instance) {
        const PreparedMesh& prepared = scene_.mesh(instance.mesh);
        const Mesh& mesh = scene_.source_mesh(instance.mesh);
        const Mat4& m = instance.world_from_object;
        BoxHeap superclusters, clusters;
        visit_nearest_first(
            prepared.superclusters.size(), nearest_, superclusters,
            [&](std::size_t i) {
                const Bounds& b = prepared.superclusters[i];
                return b.empty ? kFar : distance_to(PlacedBox({b.min.x, b.min.y, b.min.z}, {b.max.x, b.max.y, b.max.z}, m));
            },
            [&](std::size_t i) {
                const std::size_t first = i * kSuperclusterSize, count = std::min(kSuperclusterSize, prepared.cluster_count() - first);
                visit_nearest_first(
                    count, nearest_, clusters,
                    [&](std::size_t c) {
                        const Cluster& cluster = prepared.clusters[first + c];
                        return cluster.min[0] > cluster.max[0] ? kFar : distance_to(PlacedBox(cluster.min, cluster.max, m));
                    },
                    [&](std::size_t c) { look_into(mesh, first + c, m); });
            });
    }

    void look_into(const Mesh& mesh, std::size_t cluster, const Mat4& m) {
        const auto [begin, end] = indices_of_cluster(mesh, cluster);
        const auto vertex = [&](std::uint32_t index) {
            const Vec3f p = transform_point(m, mesh.positions[index]);  // in float32, as it is drawn
            return Vec3d{p.x - point_.x, p.y - point_.y, p.z - point_.z};
        };
        const std::size_t corners = corners_of(mesh.topology);
        for (std::size_t i = begin; i < end; i += corners) {
            // Lines and points are triangles with corners at one place.
            const Vec3d a = vertex(mesh.indices[i]), b = vertex(mesh.indices[i + (corners > 1 ? 1 : 0)]),
                        c = vertex(mesh.indices[i + corners - 1]);
            if (corners_distance(a, b, c) < nearest_) nearest_ = std::min(nearest_, triangle_distance_squared(a, b, c));
        }
    }

    [[nodiscard]] double distance_to(const PlacedBox& box) const { return box_distance_squared(box.low, box.high, point_); }

    const PreparedData& scene_;
    Vec3d point_;
    double nearest_ = kFar;
};

}  // namespace

double nearest_surface_squared(const PreparedData& scene, Vec3d point) { return NearestSurface(scene, point).find(); }

double farthest_surface_squared(const PreparedData& scene, Vec3d point) {
    const Bounds& box = scene.bounds();
    if (box.empty) return 0.0;
    const double low[3] = {box.min.x, box.min.y, box.min.z}, high[3] = {box.max.x, box.max.y, box.max.z},
                 at[3] = {point.x, point.y, point.z};
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = larger(magnitude(at[axis] - low[axis]), magnitude(high[axis] - at[axis]));
        sum += d * d;
    }
    return sum;
}

}  // namespace halflit::raster
