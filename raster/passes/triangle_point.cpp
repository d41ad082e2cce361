// The place of a pixel in the triangle that it shows, by the mesh's own corners.
#include "raster/passes/view_geometry.hpp"

#include <cstddef>

namespace halflit::raster {
namespace {

/// Weights of a drawn triangle's three corners at a pixel's centre: those of kernels/interpolate.hpp, in float64. Coordinates are below
/// 2^23, so each edge function is exact.
void weights_at(const ScreenVertex* const (&corner)[3], int x_px, int y_px, double (&weight)[3]) {
    double x[3], y[3];
    for (int k = 0; k < 3; ++k) {
        x[k] = corner[k]->x - 256 * x_px;
        y[k] = corner[k]->y - 256 * y_px;
    }
    const auto edge_of = [&](int k) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        return x[a] * y[b] - y[a] * x[b];
    };
    for (int k = 0; k < 3; ++k) {  // onto each edge that the centre is beyond
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        const double beyond = edge_of(k), across_x = x[b] - x[a], across_y = y[b] - y[a];
        if (!(beyond < 0.0)) continue;
        const double part = beyond / (across_x * across_x + across_y * across_y);
        for (double& along : x) along -= part * across_y;
        for (double& along : y) along += part * across_x;
    }
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
        const double edge = edge_of(k);
        weight[k] = edge > 0.0 ? edge * double{corner[k]->inv_w} : 0.0;
        sum += weight[k];
    }
    for (double& w : weight) w = sum > 0.0 ? w / sum : 0.0;
}

}  // namespace

TrianglePoint ViewGeometry::point_at(std::uint32_t id, int x_px, int y_px) const {
    const TriangleRecord& drawn = record(id);
    const Draw& draw = draw_of(drawn);
    const std::size_t chunk = chunk_of(id);
    const ScreenVertex* corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = &vertex_of(source(chunk), drawn.vertex[k]);
    double weight[3];
    weights_at(corner, x_px, y_px, weight);

    // The corners of the drawn triangle may be swapped, made by clipping, or those of a quad.
    const Mesh& mesh = scene_->source_mesh(draw.mesh);
    const std::size_t corners = corners_of(mesh.topology);
    const std::uint32_t* const index = mesh.indices.data() + corners * triangle_of(id);
    TrianglePoint point;
    const auto add = [&](std::uint32_t vertex, double share) {
        const std::uint32_t number = has_only_used_vertices()
                                         ? mesh_vertices_.data()[vertex]
                                         : (vertex - static_cast<std::uint32_t>(draw.vertex_base)) >> draw.vertex_shift();
        for (std::size_t j = 0; j < corners; ++j)
            if (index[j] == number) {
                point.weight[j] += share;
                return;
            }
    };
    for (int k = 0; k < 3; ++k) {
        if ((drawn.vertex[k] & kClipVertex) == 0) {
            add(drawn.vertex[k], weight[k]);
            continue;
        }
        const ClipVertex& made = chunks_[chunk]->clip_vertices[drawn.vertex[k] & ~kClipVertex];
        for (int i = 0; i < 3; ++i) add(made.parent[i], weight[k] * double{made.weight[i]});
    }
    if (mesh.uv0.empty()) return point;
    for (std::size_t j = 0; j < corners; ++j) {
        const Vec2f uv = mesh.uv0[index[j]];
        point.u += point.weight[j] * double{uv.x};
        point.v += point.weight[j] * double{uv.y};
    }
    return point;
}

}  // namespace halflit::raster
