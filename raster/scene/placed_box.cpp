#include "raster/scene/placed_box.hpp"

#include "raster/detail/view_math.hpp"
#include "sh/mat4.hpp"

#include <vector>

namespace halflit::raster {
namespace {

/// False if nothing in the box can extend the bounds.
bool may_grow(const Bounds& b, const PlacedBox& box) {
    return b.empty || !(box.low[0] > b.min.x && box.low[1] > b.min.y && box.low[2] > b.min.z && box.high[0] < b.max.x &&
                        box.high[1] < b.max.y && box.high[2] < b.max.z);
}

}  // namespace

PlacedBox::PlacedBox(const float (&min)[3], const float (&max)[3], const Mat4& m) {
    const Vec4f* c = m.c;
    const double rows[3][4] = {{c[0].x, c[1].x, c[2].x, c[3].x}, {c[0].y, c[1].y, c[2].y, c[3].y}, {c[0].z, c[1].z, c[2].z, c[3].z}};
    for (int axis = 0; axis < 3; ++axis) {
        double middle = rows[axis][3], half = 0.0, size = magnitude(rows[axis][3]);
        for (int k = 0; k < 3; ++k) {
            const double a = min[k], b = max[k];
            middle += rows[axis][k] * (0.5 * (a + b));
            half += magnitude(rows[axis][k]) * (0.5 * (b - a));
            size += magnitude(rows[axis][k]) * larger(magnitude(a), magnitude(b));
        }
        const double margin = half + (1e-6 * size + 1e-44);  // below 1e-38 float32 rounds to multiples of 1.4e-45
        low[axis] = middle - margin;
        high[axis] = middle + margin;
    }
}

Bounds placed_bounds(const Mesh& mesh, const PreparedMesh& prepared, const Mat4& world_from_object) {
    Bounds bounds;
    const auto look_into = [&](std::size_t cluster) {
        const auto [begin, end] = indices_of_cluster(mesh, cluster);
        for (std::size_t i = begin; i < end; ++i) bounds.add(transform_point(world_from_object, mesh.positions[mesh.indices[i]]));
    };
    const std::size_t count = prepared.cluster_count();
    if (count <= 8) {
        for (std::size_t c = 0; c < count; ++c) look_into(c);
        return bounds;
    }
    // The clusters that reach farthest in each direction come first: their vertices rule out most other clusters.
    std::vector<PlacedBox> boxes;
    boxes.reserve(count);
    std::size_t farthest[6] = {};
    for (std::size_t c = 0; c < count; ++c) {
        boxes.emplace_back(prepared.clusters[c].min, prepared.clusters[c].max, world_from_object);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (boxes[c].low[axis] < boxes[farthest[axis]].low[axis]) farthest[axis] = c;
            if (boxes[c].high[axis] > boxes[farthest[axis + 3]].high[axis]) farthest[axis + 3] = c;
        }
    }
    for (const std::size_t c : farthest) look_into(c);
    for (std::size_t c = 0; c < count; ++c)
        if (may_grow(bounds, boxes[c])) look_into(c);
    return bounds;
}

Bounds rough_bounds(const Bounds& object, const Mat4& world_from_object) {
    Bounds bounds;
    if (object.empty) return bounds;
    const PlacedBox box({object.min.x, object.min.y, object.min.z}, {object.max.x, object.max.y, object.max.z}, world_from_object);
    bounds.add({static_cast<float>(box.low[0]), static_cast<float>(box.low[1]), static_cast<float>(box.low[2])});
    bounds.add({static_cast<float>(box.high[0]), static_cast<float>(box.high[1]), static_cast<float>(box.high[2])});
    return bounds;
}

}  // namespace halflit::raster
