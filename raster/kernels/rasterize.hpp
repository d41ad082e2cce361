// Visibility inside one tile: exact integer edge functions, top-left rule, float depth, nearest wins.
//
// The edge from a to b of a triangle with positive area has the edge function E(p) = A (px - ax) + B (py - ay), A = ay - by, B = bx - ax.
// Inside the triangle E >= 0. At pixel centres all terms except the constant C are multiples of 256, so E >= 0 is exactly
// A i + B j + floor(C / 256) >= 0 with whole pixel numbers i, j. Edges that are neither top nor left lose one unit in C, so that a pixel
// centre on a shared edge is drawn once. C is computed in 64 bits and rebased to the box that is walked. An edge that does not cross the
// box either holds for all of it or rejects it; the values of the other edges fit 32 bits (kGuardBandPx).
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "shading/kernels/simd.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

struct Edge {
    std::int32_t a, b;  ///< change per pixel to the right, and down
    std::int64_t c;     ///< value at pixel (0, 0) of the picture, times 256, with the top-left rule included
};

HALFLIT_INLINE Edge make_edge(const ScreenVertex& from, const ScreenVertex& to) {
    Edge e;
    e.a = from.y - to.y;
    e.b = to.x - from.x;
    const bool top_left = is_top_left(e.a, e.b);
    e.c = -(static_cast<std::int64_t>(e.a) * from.x + static_cast<std::int64_t>(e.b) * from.y) - (top_left ? 0 : 1);
    return e;
}

/// Depth over the window: z = za + (j - anchor_y) zy + (i - anchor_x) zx at pixel (i, j), clamped to [lo, hi], the range of the vertices'
/// depths. The anchor is the pixel of vertex 0, so that a depth does not depend on the tile. zx, zy: change per pixel.
struct DepthPlane {
    float za, zx, zy, lo, hi;
    std::int32_t anchor_x, anchor_y;
};

/// Slopes of the plane through three vertices, per fixed-point unit; the same for all samples.
struct DepthSlope {
    double zx, zy;
};

HALFLIT_INLINE DepthSlope make_depth_slope(const ScreenVertex& v0, const ScreenVertex& v1, const ScreenVertex& v2) {
    const double x1 = v1.x - v0.x, y1 = v1.y - v0.y, x2 = v2.x - v0.x, y2 = v2.y - v0.y;
    const double z1 = static_cast<double>(v1.z) - v0.z, z2 = static_cast<double>(v2.z) - v0.z;
    const double inv_area = 1.0 / (x1 * y2 - x2 * y1);
    return {(z1 * y2 - z2 * y1) * inv_area, (z2 * x1 - z1 * x2) * inv_area};
}

HALFLIT_INLINE DepthPlane make_depth_plane(const DepthSlope& slope, const ScreenVertex& v0, const ScreenVertex& v1, const ScreenVertex& v2,
                                           int sample_x, int sample_y) {
    DepthPlane p;
    p.anchor_x = v0.x >> 8;
    p.anchor_y = v0.y >> 8;
    const double dx = (p.anchor_x << 8) + sample_x - v0.x, dy = (p.anchor_y << 8) + sample_y - v0.y;
    p.za = static_cast<float>((static_cast<double>(v0.z) + slope.zx * dx) + slope.zy * dy);
    p.zx = static_cast<float>(slope.zx * 256.0);
    p.zy = static_cast<float>(slope.zy * 256.0);
    p.lo = vmin(vmin(v0.z, v1.z), v2.z);
    p.hi = vmax(vmax(v0.z, v1.z), v2.z);
    return p;
}

HALFLIT_INLINE std::int32_t min3(std::int32_t a, std::int32_t b, std::int32_t c) {
    const std::int32_t m = a < b ? a : b;
    return m < c ? m : c;
}
HALFLIT_INLINE std::int32_t max3(std::int32_t a, std::int32_t b, std::int32_t c) {
    const std::int32_t m = a > b ? a : b;
    return m > c ? m : c;
}

/// Edge function inside a box: e(i, j) = e0 + a i + b j, with i and j counted from the box's corner.
struct BoxEdge {
    std::int32_t e0, a, b;
};
enum class BoxTest { outside, inside, crossing };

/// Tests an edge over the w x h pixels from (x0, y0) on. c: constant of the edge for the sample. out: set if the edge crosses them.
HALFLIT_INLINE BoxTest test_edge(const Edge& e, std::int64_t c, int x0, int y0, int w, int h, BoxEdge& out) {
    const std::int64_t at = (c >> 8) + static_cast<std::int64_t>(e.a) * x0 + static_cast<std::int64_t>(e.b) * y0;
    const std::int64_t over_x = static_cast<std::int64_t>(e.a) * (w - 1), over_y = static_cast<std::int64_t>(e.b) * (h - 1);
    const std::int64_t least = at + (over_x < 0 ? over_x : 0) + (over_y < 0 ? over_y : 0);
    const std::int64_t most = at + (over_x > 0 ? over_x : 0) + (over_y > 0 ? over_y : 0);
    if (most < 0) return BoxTest::outside;
    if (least >= 0) return BoxTest::inside;
    out = {static_cast<std::int32_t>(at), e.a, e.b};
    return BoxTest::crossing;
}

/// Size of the blocks that large triangles are walked in, pixels; the width is a multiple of every vector width.
inline constexpr int kBlockW = 16, kBlockH = 8;

/// Draws into depth and triangle.
struct WriteVisible {
    float* depth;
    std::uint32_t* triangle;
    std::uint32_t id;

    HALFLIT_INLINE void pixels(int at, I outside, F z) const {
        float* d = depth + at;
        std::uint32_t* t = triangle + at;
        const F old = load(d);
        const M pass = less(I(-1), outside) & (z > old);
        store(d, sel(pass, z, old));
        std::int32_t* ti = reinterpret_cast<std::int32_t*>(t);
        store(ti, sel(pass, I(static_cast<std::int32_t>(id)), load(ti)));
    }
};

/// Draws into depth and triangle where the coverage plane has this sample's bit.
struct WriteCovered {
    WriteVisible visible;
    const std::uint8_t* coverage;
    std::uint8_t bit;

    HALFLIT_INLINE void pixels(int at, I outside, F z) const {
        alignas(64) std::int32_t not_covered[kWidth];
        for (int l = 0; l < kWidth; ++l) not_covered[l] = (coverage[at + l] & bit) ? 0 : -1;
        visible.pixels(at, outside | load(not_covered), z);
    }
};

/// Marks in the coverage plane the samples that pass the depth test.
struct MarkCoverage {
    const float* depth;
    std::uint8_t* coverage;
    std::uint8_t bit;

    HALFLIT_INLINE void pixels(int at, I outside, F z) const {
        const M pass = less(I(-1), outside) & (z > load(depth + at));
        std::uint32_t mask = mask_bits(pass);
        while (mask != 0) {
            const int l = __builtin_ctz(mask);
            mask &= mask - 1;
            coverage[at + l] = static_cast<std::uint8_t>(coverage[at + l] | bit);
        }
    }
};

/// Walks pixels [0, w) x [0, h) of a box with N crossing edges; `at` is the buffer index of its corner.
template <int N, class Sink>
HALFLIT_INLINE void walk(const BoxEdge* edges, const DepthPlane& plane, int x0, int y0, int w, int h, int at, const Sink& sink) {
    const F zx(plane.zx), lo(plane.lo), hi(plane.hi);
    const I lane = iota_i();
    I ramp[3] = {I(0), I(0), I(0)};
    std::int32_t row_e[3] = {0, 0, 0};
    for (int k = 0; k < N; ++k) {
        ramp[k] = I(edges[k].a) * lane;
        row_e[k] = edges[k].e0;
    }
    for (int j = 0; j < h; ++j, at += kTileStride) {
        const F z_row(mad(static_cast<float>(y0 + j - plane.anchor_y), plane.zy, plane.za));
        for (int i = 0; i < w; i += kWidth) {
            // One more "edge" puts lanes right of the box outside.
            I outside = I(w - 1 - i) - lane;
            for (int k = 0; k < N; ++k) outside = outside | (I(row_e[k] + edges[k].a * i) + ramp[k]);
            if (N > 0 && sign_bits(outside) == (1u << kWidth) - 1u) continue;
            const F z = mad(to_float(I(x0 + i - plane.anchor_x) + lane), zx, z_row);
            sink.pixels(at + i, outside, vmin(vmax(z, lo), hi));
        }
        for (int k = 0; k < N; ++k) row_e[k] += edges[k].b;
    }
}

template <class Sink>
HALFLIT_INLINE void walk_box(int n, const BoxEdge* edges, const DepthPlane& plane, int x0, int y0, int w, int h, int at, const Sink& sink) {
    switch (n) {
        case 0:
            walk<0>(edges, plane, x0, y0, w, h, at, sink);
            break;
        case 1:
            walk<1>(edges, plane, x0, y0, w, h, at, sink);
            break;
        case 2:
            walk<2>(edges, plane, x0, y0, w, h, at, sink);
            break;
        default:
            walk<3>(edges, plane, x0, y0, w, h, at, sink);
            break;
    }
}

/// Draws one sample plane of one triangle. (bx0, by0)..(bx1, by1): pixels of the picture, inside the tile.
template <class Sink>
HALFLIT_INLINE void draw_sample(const TileRect& tile, const Edge* edges, const std::int64_t* c, const DepthPlane& plane, int bx0, int by0,
                                int bx1, int by1, const Sink& sink) {
    const int w = bx1 - bx0 + 1, h = by1 - by0 + 1;
    BoxEdge crossing[3];
    const Edge* source[3];
    std::int64_t source_c[3];
    int n = 0;
    for (int k = 0; k < 3; ++k) {
        const BoxTest t = test_edge(edges[k], c[k], bx0, by0, w, h, crossing[n]);
        if (t == BoxTest::outside) return;
        if (t == BoxTest::crossing) {
            source[n] = &edges[k];
            source_c[n] = c[k];
            ++n;
        }
    }
    const int at = (by0 - tile.y) * kTileStride + (bx0 - tile.x);
    if (n == 0 || w <= kBlockW || h <= kBlockH) {
        walk_box(n, crossing, plane, bx0, by0, w, h, at, sink);
        return;
    }
    for (int y = 0; y < h; y += kBlockH) {
        const int bh = h - y < kBlockH ? h - y : kBlockH;
        for (int x = 0; x < w; x += kBlockW) {
            const int bw = w - x < kBlockW ? w - x : kBlockW;
            BoxEdge in_block[3];
            int m = 0;
            bool outside = false;
            for (int k = 0; k < n && !outside; ++k) {
                const BoxTest t = test_edge(*source[k], source_c[k], bx0 + x, by0 + y, bw, bh, in_block[m]);
                outside = t == BoxTest::outside;
                if (t == BoxTest::crossing) ++m;
            }
            if (!outside) walk_box(m, in_block, plane, bx0 + x, by0 + y, bw, bh, at + y * kTileStride + x, sink);
        }
    }
}

HALFLIT_INLINE void grow(CoverBox& box, int x0, int y0, int x1, int y1) {
    box.x0 = x0 < box.x0 ? x0 : box.x0;
    box.y0 = y0 < box.y0 ? y0 : box.y0;
    box.x1 = x1 > box.x1 ? x1 : box.x1;
    box.y1 = y1 > box.y1 ? y1 : box.y1;
}

/// Triangles below this size (fixed point) are walked without edge tests, and all their arithmetic fits 32 bits:
/// two products of 2^14 * 2^14.
inline constexpr int kSmallTriangle = 64 * 256;

/// Edge functions at pixel (x0, y0) of a small triangle.
HALFLIT_INLINE void small_edges(const Edge* edges, const ScreenVertex* const* from, std::int32_t x, std::int32_t y, BoxEdge* out) {
    for (int k = 0; k < 3; ++k) {
        const bool top_left = is_top_left(edges[k].a, edges[k].b);
        out[k] = {(edges[k].a * (x - from[k]->x) + edges[k].b * (y - from[k]->y) - (top_left ? 0 : 1)) >> 8, edges[k].a, edges[k].b};
    }
}

/// Draws all samples of one triangle. make_sink(s) gives the sink of sample s. Returns the box walked.
template <class MakeSink>
HALFLIT_INLINE CoverBox draw_triangle(const TileRect& tile, const SamplePattern& pattern, const TriangleSource& source,
                                      const TriangleRecord& record, const MakeSink& make_sink) {
    const ScreenVertex& v0 = vertex_of(source, record.vertex[0]);
    const ScreenVertex& v1 = vertex_of(source, record.vertex[1]);
    const ScreenVertex& v2 = vertex_of(source, record.vertex[2]);
    const Edge edges[3] = {make_edge(v0, v1), make_edge(v1, v2), make_edge(v2, v0)};
    const int least_x = min3(v0.x, v1.x, v2.x), most_x = max3(v0.x, v1.x, v2.x);
    const int least_y = min3(v0.y, v1.y, v2.y), most_y = max3(v0.y, v1.y, v2.y);
    const ScreenVertex* const from[3] = {&v0, &v1, &v2};
    const bool small = most_x - least_x < kSmallTriangle && most_y - least_y < kSmallTriangle;
    const DepthSlope slope = make_depth_slope(v0, v1, v2);
    CoverBox all{kMaxTileSize, kMaxTileSize, -1, -1};
    for (int s = 0; s < pattern.count; ++s) {
        const int sx = pattern.x[s], sy = pattern.y[s];
        int bx0 = (least_x - sx + 255) >> 8, bx1 = (most_x - sx) >> 8, by0 = (least_y - sy + 255) >> 8, by1 = (most_y - sy) >> 8;
        bx0 = bx0 < tile.x ? tile.x : bx0;
        by0 = by0 < tile.y ? tile.y : by0;
        bx1 = bx1 >= tile.x + tile.width ? tile.x + tile.width - 1 : bx1;
        by1 = by1 >= tile.y + tile.height ? tile.y + tile.height - 1 : by1;
        if (bx0 > bx1 || by0 > by1) continue;
        if (small) {
            BoxEdge at_corner[3];
            small_edges(edges, from, bx0 * 256 + sx, by0 * 256 + sy, at_corner);
            walk<3>(at_corner, make_depth_plane(slope, v0, v1, v2, sx, sy), bx0, by0, bx1 - bx0 + 1, by1 - by0 + 1,
                    (by0 - tile.y) * kTileStride + (bx0 - tile.x), make_sink(s));
            grow(all, bx0 - tile.x, by0 - tile.y, bx1 - tile.x, by1 - tile.y);
            continue;
        }
        std::int64_t c[3];
        for (int k = 0; k < 3; ++k)
            c[k] = edges[k].c + static_cast<std::int64_t>(edges[k].a) * sx + static_cast<std::int64_t>(edges[k].b) * sy;
        draw_sample(tile, edges, c, make_depth_plane(slope, v0, v1, v2, sx, sy), bx0, by0, bx1, by1, make_sink(s));
        grow(all, bx0 - tile.x, by0 - tile.y, bx1 - tile.x, by1 - tile.y);
    }
    return all;
}

inline void rasterize(const TileRect& tile, const SamplePattern& pattern, TileBuffers& buffers, const TriangleSource& source,
                      const std::uint32_t* list, int count) {
    for (int i = 0; i < count; ++i) {
        const std::uint32_t r = list[i];
        draw_triangle(
            tile, pattern, source, source.records[r], [&](int s) __attribute__((always_inline)) {
                return WriteVisible{buffers.depth[s], buffers.triangle[s], source.id_base + r};
            });
    }
}

inline void draw_covered(const TileRect& tile, const SamplePattern& pattern, TileBuffers& buffers, const TriangleSource& source,
                         std::uint32_t record) {
    draw_triangle(
        tile, pattern, source, source.records[record], [&](int s) __attribute__((always_inline)) {
            return WriteCovered{
                {buffers.depth[s], buffers.triangle[s], source.id_base + record}, buffers.coverage, static_cast<std::uint8_t>(1u << s)};
        });
}

inline CoverBox cover(const TileRect& tile, const SamplePattern& pattern, TileBuffers& buffers, const TriangleSource& source,
                      std::uint32_t record) {
    return draw_triangle(
        tile, pattern, source, source.records[record], [&](int s) __attribute__((always_inline)) {
            return MarkCoverage{buffers.depth[s], buffers.coverage, static_cast<std::uint8_t>(1u << s)};
        });
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
