// Shadow maps that are read without a filter, at the texels alone that are read: which of them show a triangle nearer than a given depth.
// Coverage and depths are those of rasterize(), so that the answer is the whole map's.
#pragma once

#include "raster/kernels/fixed_function_args.hpp"
#include "raster/kernels/rasterize.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

inline void occlude(const OcclusionGrid& grid, const ScreenVertex& v0, const ScreenVertex& v1, const ScreenVertex& v2, int tile_x0,
                    int tile_y0, int tile_x1, int tile_y1) {
    const float nearest = grid.offset_factor == 0.0f ? vmax(vmax(v0.z, v1.z), v2.z) - grid.offset_units : 2.0f;
    Edge edges[3];
    DepthPlane plane{};
    float offset = 0.0f;
    bool has_edges = false, has_plane = false;
    for (int ty = tile_y0; ty <= tile_y1; ++ty)
        for (int tx = tile_x0; tx <= tile_x1; ++tx) {
            const int tile = ty * grid.tiles_x + tx;
            if (!(nearest > grid.farthest[tile]) | (grid.first[tile] == grid.first[tile + 1])) continue;
            if (!has_edges) {
                edges[0] = make_edge(v0, v1), edges[1] = make_edge(v1, v2), edges[2] = make_edge(v2, v0);
                has_edges = true;
            }
            const int left = grid.x0 + tx * grid.tile_size, top = grid.y0 + ty * grid.tile_size;
            BoxEdge crossing[3];
            int n = 0;
            bool outside_tile = false;
            for (const Edge& edge : edges) {
                const BoxTest test = test_edge(edge, edge.c, left, top, grid.tile_size, grid.tile_size, crossing[n]);
                outside_tile |= test == BoxTest::outside;
                n += test == BoxTest::crossing ? 1 : 0;
            }
            if (outside_tile) continue;
            for (int k = n; k < 3; ++k) crossing[k] = {0, 0, 0};
            for (std::uint32_t i = grid.first[tile]; i < grid.first[tile + 1]; i += kWidth) {
                const I x = load(grid.x + i), y = load(grid.y + i);
                I outside(0);
                for (const BoxEdge& edge : crossing) outside = outside | ((I(edge.e0) + I(edge.a) * x) + I(edge.b) * y);
                if (sign_bits(outside) == (1u << kWidth) - 1u) continue;
                if (!has_plane) {
                    plane = make_depth_plane(make_depth_slope(v0, v1, v2), v0, v1, v2, 0, 0);
                    offset = grid.offset_factor * vmax(vabs(plane.zx), vabs(plane.zy)) + grid.offset_units;
                    has_plane = true;
                }
                const F row = mad(to_float(y + I(top - plane.anchor_y)), F(plane.zy), F(plane.za));
                const F z = vmin(vmax(mad(to_float(x + I(left - plane.anchor_x)), F(plane.zx), row), F(plane.lo)), F(plane.hi));
                const M hides = less(I(-1), outside) & (z - F(offset) > load(grid.z + i));
                store(grid.hidden + i, sel(hides, I(-1), load(grid.hidden + i)));
            }
        }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
