// Shadow maps that are read without a filter, at the texels alone that are read: which of them show a triangle nearer than a given depth.
// Coverage and depths are those of rasterize(), so that the answer is the whole map's.
#pragma once

#include "raster/kernels/fixed_function_args.hpp"
#include "raster/kernels/rasterize.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

/// A triangle on its way over the tiles that it touches.
struct Occluder {
    const ScreenVertex *v0 = nullptr, *v1 = nullptr, *v2 = nullptr;
    Edge edges[3]{};
    bool small = false;  ///< edge functions in its tiles fit 32 bits
    DepthPlane plane{};
    float offset = 0.0f;
    bool has_plane = false;
};

/// Edge functions at a tile's first pixel. False if no pixel of the tile is inside.
HALFLIT_INLINE bool edges_in_tile(const Occluder& of, int left, int top, int size, BoxEdge (&out)[3]) {
    if (of.small) {
        const ScreenVertex* const from[3] = {of.v0, of.v1, of.v2};
        small_edges(of.edges, from, left * 256, top * 256, out);
        return true;
    }
    int n = 0;
    for (const Edge& edge : of.edges) {
        const BoxTest test = test_edge(edge, edge.c, left, top, size, size, out[n]);
        if (test == BoxTest::outside) return false;
        n += test == BoxTest::crossing ? 1 : 0;
    }
    for (; n < 3; ++n) out[n] = {0, 0, 0};
    return true;
}

inline void occlude(const OcclusionGrid& grid, const ScreenVertex& v0, const ScreenVertex& v1, const ScreenVertex& v2, int tile_x0,
                    int tile_y0, int tile_x1, int tile_y1) {
    const float nearest = grid.offset_factor == 0.0f ? vmax(vmax(v0.z, v1.z), v2.z) - grid.offset_units : 2.0f;
    // Texels whose middles are in the triangle's box.
    const int first_x = (min3(v0.x, v1.x, v2.x) + 255) >> 8, last_x = max3(v0.x, v1.x, v2.x) >> 8;
    const int first_y = (min3(v0.y, v1.y, v2.y) + 255) >> 8, last_y = max3(v0.y, v1.y, v2.y) >> 8;
    Occluder of;
    bool has_edges = false;
    for (int ty = tile_y0; ty <= tile_y1; ++ty)
        for (int tx = tile_x0; tx <= tile_x1; ++tx) {
            const OcclusionTile& tile = grid.tiles[ty * grid.tiles_x + tx];
            if (!(nearest > tile.farthest) || first_x > tile.x1 || last_x < tile.x0 || first_y > tile.y1 || last_y < tile.y0) continue;
            if (!has_edges) {
                of.v0 = &v0, of.v1 = &v1, of.v2 = &v2;
                of.edges[0] = make_edge(v0, v1), of.edges[1] = make_edge(v1, v2), of.edges[2] = make_edge(v2, v0);
                // Two products of a size below 2^14 and a distance, to the first pixel of a tile that it touches, below 2^15.
                of.small = max3(v0.x, v1.x, v2.x) - min3(v0.x, v1.x, v2.x) < kSmallTriangle &&
                           max3(v0.y, v1.y, v2.y) - min3(v0.y, v1.y, v2.y) < kSmallTriangle;
                has_edges = true;
            }
            const int left = grid.x0 + tx * grid.tile_size, top = grid.y0 + ty * grid.tile_size;
            BoxEdge edge[3];
            if (!edges_in_tile(of, left, top, grid.tile_size, edge)) continue;
            const std::uint32_t end = (&tile)[1].first;
            for (std::uint32_t i = tile.first; i < end; i += kWidth) {
                const I x = load(grid.x + i), y = load(grid.y + i);
                I outside = I(static_cast<std::int32_t>(end - i) - 1) - iota_i();
                for (const BoxEdge& e : edge) outside = outside | ((I(e.e0) + I(e.a) * x) + I(e.b) * y);
                if (sign_bits(outside) == (1u << kWidth) - 1u) continue;
                if (!of.has_plane) {
                    of.plane = make_depth_plane(make_depth_slope(v0, v1, v2), v0, v1, v2, 0, 0);
                    of.offset = grid.offset_factor * vmax(vabs(of.plane.zx), vabs(of.plane.zy)) + grid.offset_units;
                    of.has_plane = true;
                }
                const DepthPlane& plane = of.plane;
                const F row = mad(to_float(y + I(top - plane.anchor_y)), F(plane.zy), F(plane.za));
                const F z = vmin(vmax(mad(to_float(x + I(left - plane.anchor_x)), F(plane.zx), row), F(plane.lo)), F(plane.hi));
                const M hides = less(I(-1), outside) & (z - F(of.offset) > load(grid.z + i));
                store(grid.hidden + i, sel(hides, I(-1), load(grid.hidden + i)));
            }
        }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
