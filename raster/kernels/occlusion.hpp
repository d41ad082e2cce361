// Shadow maps that are read without a filter, at the texels alone that are read: which of them show a triangle nearer than a given depth.
// Coverage and depths are those of rasterize(), so that the answer is the whole map's.
#pragma once

#include "raster/kernels/fixed_function_args.hpp"
#include "raster/kernels/rasterize.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Tests one triangle against the places in a tile.
HALFLIT_INLINE void occlude_by(const TileRect& tile, const TriangleSource& source, const TriangleRecord& record,
                               const OcclusionPoints& points, float nearest) {
    const ScreenVertex& v0 = vertex_of(source, record.vertex[0]);
    const ScreenVertex& v1 = vertex_of(source, record.vertex[1]);
    const ScreenVertex& v2 = vertex_of(source, record.vertex[2]);
    const Edge edges[3] = {make_edge(v0, v1), make_edge(v1, v2), make_edge(v2, v0)};
    const DepthSlope slope = make_depth_slope(v0, v1, v2);
    const DepthPlane plane = make_depth_plane(slope, v0, v1, v2, 0, 0);
    const float steepest = vmax(vabs(plane.zx), vabs(plane.zy));
    const float offset = points.offset_factor * steepest + points.offset_units;
    if (!(plane.hi - offset > nearest)) return;
    BoxEdge crossing[3];
    int n = 0;
    for (int k = 0; k < 3; ++k) {
        const BoxTest test = test_edge(edges[k], edges[k].c, tile.x, tile.y, tile.width, tile.height, crossing[n]);
        if (test == BoxTest::outside) return;
        if (test == BoxTest::crossing) ++n;
    }
    const F zx(plane.zx), lo(plane.lo), hi(plane.hi), back(offset);
    for (int i = 0; i < points.count; i += kWidth) {
        const I x = load(points.x + i), y = load(points.y + i);
        I outside(0);
        for (int k = 0; k < n; ++k) outside = outside | ((I(crossing[k].e0) + I(crossing[k].a) * x) + I(crossing[k].b) * y);
        if (sign_bits(outside) == (1u << kWidth) - 1u) continue;
        const F row = mad(to_float(y + I(tile.y - plane.anchor_y)), F(plane.zy), F(plane.za));
        const F z = vmin(vmax(mad(to_float(x + I(tile.x - plane.anchor_x)), zx, row), lo), hi);
        const M hides = less(I(-1), outside) & (z - back > load(points.z + i));
        store(points.hidden + i, sel(hides, I(-1), load(points.hidden + i)));
    }
}

inline void occlude(const TileRect& tile, const TriangleTable& triangles, const std::uint32_t* ids, int count,
                    const OcclusionPoints& points) {
    float nearest = 2.0f;  // the farthest place: nothing behind it hides another
    for (int i = 0; i < points.count; ++i) nearest = vmin(points.z[i], nearest);
    for (int i = 0; i < count; ++i) occlude_by(tile, source_of(triangles, ids[i]), record_of(triangles, ids[i]), points, nearest);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
