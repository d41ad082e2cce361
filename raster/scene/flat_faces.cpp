#include "raster/scene/flat_faces.hpp"

#include "raster/detail/view_math.hpp"
#include "raster/scene/prepared_mesh.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>

namespace halflit::raster {
namespace {

struct Triangle {
    Vec3f low, high;  // its box

    explicit Triangle(const Mesh& mesh, std::size_t i) {
        const Vec3f &a = mesh.positions[mesh.indices[i]], &b = mesh.positions[mesh.indices[i + 1]],
                    &c = mesh.positions[mesh.indices[i + 2]];
        low = {std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})};
        high = {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})};
        is_finite = finite(a) && finite(b) && finite(c);
    }
    void add_to(Bounds& bounds) const {
        bounds.add(low);
        bounds.add(high);
    }
    /// The axis that its plane lies across; -1: none.
    [[nodiscard]] int flat_axis() const {
        const Vec3f extent = high - low;
        const float size = std::max({extent.x, extent.y, extent.z});
        if (extent.y <= 1e-6f * size) return 1;  // floors are what there is most of
        return extent.x <= 1e-6f * size ? 0 : extent.z <= 1e-6f * size ? 2 : -1;
    }

    bool is_finite;
};

}  // namespace

float face_slack(const Bounds& bounds) { return 4e-6f * static_cast<float>(largest_coordinate(bounds)); }

FlatFaces find_flat_faces(const Mesh& mesh, std::span<const Cluster> clusters) {
    FlatFaces out;
    TimeCheck check;
    const auto for_each = [&](std::size_t cluster, const auto& visit) {
        const auto [begin, end] = indices_of_cluster(mesh, cluster);
        for (std::size_t i = begin; i < end; i += 3) {
            check();
            if (const Triangle triangle(mesh, i); triangle.is_finite) visit(triangle);
        }
    };
    const auto may_be_flat = [&](std::size_t cluster) { return clusters[cluster].flat || !clusters[cluster].finite; };
    for (std::size_t c = 0; c < clusters.size(); ++c)
        if (may_be_flat(c))
            for_each(c, [&](const Triangle& triangle) {
                if (triangle.flat_axis() >= 0) triangle.add_to(out.flats);
            });
    if (out.flats.empty) return out;
    const float slack = face_slack(out.flats);
    for (std::size_t c = 0; c < clusters.size(); ++c) {
        if (!may_be_flat(c)) {
            const Cluster& cluster = clusters[c];
            out.rest.add({cluster.min[0], cluster.min[1], cluster.min[2]});
            out.rest.add({cluster.max[0], cluster.max[1], cluster.max[2]});
            continue;
        }
        for_each(c, [&](const Triangle& triangle) {
            const int axis = triangle.flat_axis();
            Bounds* group = &out.rest;
            if (axis >= 0) {
                if (component(triangle.low, axis) <= component(out.flats.min, axis) + slack)
                    group = &out.faces[face_of(axis, false)];
                else if (component(triangle.high, axis) >= component(out.flats.max, axis) - slack)
                    group = &out.faces[face_of(axis, true)];
            }
            triangle.add_to(*group);
        });
    }
    return out;
}

}  // namespace halflit::raster
