// Shadow maps that are read without a filter, at the texels alone that are read: which of them show a triangle nearer than a given depth.
// Coverage and depths are those of rasterize(), so that the answer is the whole map's.
#pragma once

#include "raster/kernels/fixed_function_args.hpp"
#include "raster/kernels/rasterize.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

/// The box of the places in a tile, pixels of the view, and the depth of the farthest: nothing behind it hides another.
struct OcclusionBox {
    std::int32_t x0 = 1 << 30, y0 = 1 << 30, x1 = -1, y1 = -1;
    float farthest = 2.0f;
};

HALFLIT_INLINE OcclusionBox box_of(const TileRect& tile, const OcclusionPoints& points) {
    OcclusionBox box;
    for (int i = 0; i < points.count; ++i) {
        if (points.z[i] > 1.0f) continue;  // of the padding
        box.x0 = vmin(box.x0, points.x[i]), box.x1 = vmax(box.x1, points.x[i]);
        box.y0 = vmin(box.y0, points.y[i]), box.y1 = vmax(box.y1, points.y[i]);
        box.farthest = vmin(points.z[i], box.farthest);
    }
    box.x0 += tile.x, box.x1 += tile.x, box.y0 += tile.y, box.y1 += tile.y;
    return box;
}

/// Tests one triangle against the places in a tile.
HALFLIT_INLINE void occlude_by(const TileRect& tile, const TriangleSource& source, const TriangleRecord& record,
                               const OcclusionPoints& points, const OcclusionBox& box) {
    const ScreenVertex& v0 = vertex_of(source, record.vertex[0]);
    const ScreenVertex& v1 = vertex_of(source, record.vertex[1]);
    const ScreenVertex& v2 = vertex_of(source, record.vertex[2]);
    const int x0 = (min3(v0.x, v1.x, v2.x) + 255) >> 8, x1 = max3(v0.x, v1.x, v2.x) >> 8;
    const int y0 = (min3(v0.y, v1.y, v2.y) + 255) >> 8, y1 = max3(v0.y, v1.y, v2.y) >> 8;
    if ((x0 > box.x1) | (x1 < box.x0) | (y0 > box.y1) | (y1 < box.y0)) return;
    if (points.offset_factor == 0.0f && !(vmax(vmax(v0.z, v1.z), v2.z) - points.offset_units > box.farthest)) return;
    const Edge edges[3] = {make_edge(v0, v1), make_edge(v1, v2), make_edge(v2, v0)};
    BoxEdge crossing[3];
    int n = 0;
    for (const Edge& edge : edges) {
        const BoxTest test = test_edge(edge, edge.c, box.x0, box.y0, box.x1 - box.x0 + 1, box.y1 - box.y0 + 1, crossing[n]);
        if (test == BoxTest::outside) return;
        if (test == BoxTest::crossing) ++n;
    }
    const I left(tile.x - box.x0), top(tile.y - box.y0);
    DepthPlane plane{};
    float offset = 0.0f;
    bool has_plane = false;
    for (int i = 0; i < points.count; i += kWidth) {
        const I x = load(points.x + i), y = load(points.y + i), over = x + left, down = y + top;
        I outside(0);
        for (int k = 0; k < n; ++k) outside = outside | ((I(crossing[k].e0) + I(crossing[k].a) * over) + I(crossing[k].b) * down);
        if (sign_bits(outside) == (1u << kWidth) - 1u) continue;
        if (!has_plane) {
            plane = make_depth_plane(make_depth_slope(v0, v1, v2), v0, v1, v2, 0, 0);
            offset = points.offset_factor * vmax(vabs(plane.zx), vabs(plane.zy)) + points.offset_units;
            has_plane = true;
        }
        const F row = mad(to_float(y + I(tile.y - plane.anchor_y)), F(plane.zy), F(plane.za));
        const F z = vmin(vmax(mad(to_float(x + I(tile.x - plane.anchor_x)), F(plane.zx), row), F(plane.lo)), F(plane.hi));
        const M hides = less(I(-1), outside) & (z - F(offset) > load(points.z + i));
        store(points.hidden + i, sel(hides, I(-1), load(points.hidden + i)));
    }
}

inline void occlude(const TileRect& tile, const TriangleTable& triangles, const std::uint32_t* ids, int count,
                    const OcclusionPoints& points) {
    const OcclusionBox box = box_of(tile, points);
    for (int i = 0; i < count; ++i) occlude_by(tile, source_of(triangles, ids[i]), record_of(triangles, ids[i]), points, box);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
