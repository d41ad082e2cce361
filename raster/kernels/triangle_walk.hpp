// The walk over a triangle's box of pixels, and what is done with the pixels inside.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "shading/kernels/simd.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Triangles below this size (fixed point) are walked without edge tests, and all their arithmetic fits 32 bits:
/// two products of 2^14 * 2^14.
inline constexpr int kSmallTriangle = 64 * 256;

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

/// Draws into depth alone.
struct WriteDepth {
    float* depth;

    HALFLIT_INLINE void pixels(int at, I outside, F z) const {
        const F old = load(depth + at);
        store(depth + at, sel(less(I(-1), outside) & (z > old), z, old));
    }
};

/// Draws into depth and triangle where the coverage plane has this sample's bit.
struct WriteCovered {
    WriteVisible visible;
    const std::uint16_t* coverage;
    std::uint16_t bit;

    HALFLIT_INLINE void pixels(int at, I outside, F z) const {
        alignas(64) std::int32_t not_covered[kWidth];
        for (int l = 0; l < kWidth; ++l) not_covered[l] = (coverage[at + l] & bit) ? 0 : -1;
        visible.pixels(at, outside | load(not_covered), z);
    }
};

/// Marks samples in the coverage plane.
struct MarkSamples {
    std::uint16_t* coverage;
    std::uint16_t bit;

    HALFLIT_INLINE void mark(int at, M lanes) const {
        std::uint32_t mask = mask_bits(lanes);
        while (mask != 0) {
            const int l = __builtin_ctz(mask);
            mask &= mask - 1;
            coverage[at + l] = static_cast<std::uint16_t>(coverage[at + l] | bit);
        }
    }
};

/// Those that pass the depth test.
struct MarkCoverage {
    const float* depth;
    MarkSamples samples;

    HALFLIT_INLINE void pixels(int at, I outside, F z) const { samples.mark(at, less(I(-1), outside) & (z > load(depth + at))); }
};

/// The same, with the depths.
struct MarkLayer {
    MarkCoverage mark;
    float* layer;

    /// Lanes outside are written too: they are right of the triangle's box, or not marked.
    HALFLIT_INLINE void pixels(int at, I outside, F z) const {
        mark.pixels(at, outside, z);
        store(layer + at, z);
    }
};

/// Lets a sink have the samples of a circle alone, in 1/256 pixel. Products fit 32 bits for circles of up to 256 pixels.
template <class Sink>
struct InCircle {
    Sink sink;
    std::int32_t x, y;     ///< from the circle's middle to the sample of the tile's pixel (0, 0)
    std::int32_t squared;  ///< radius

    HALFLIT_INLINE void pixels(int at, I outside, F z) const {
        const int row = at / kTileStride, dy = y + 256 * row;
        const I dx = I(x + 256 * (at - row * kTileStride)) + I(256) * iota_i();
        sink.pixels(at, outside | (I(squared - dy * dy) - dx * dx), z);
    }
};

/// The circle in a square of the window, whose sides are as given.
template <class Sink>
HALFLIT_INLINE InCircle<Sink> in_circle(const Sink& sink, const TileRect& tile, int least_x, int most_x, int least_y, int sample_x,
                                        int sample_y) {
    const int size = most_x - least_x, radius = size - size / 2;
    return {sink, 256 * tile.x + sample_x - (least_x + size / 2), 256 * tile.y + sample_y - (least_y + size / 2), radius * radius};
}

/// Without the test, with the depths.
struct MarkAll {
    MarkSamples samples;
    float* layer;

    HALFLIT_INLINE void pixels(int at, I outside, F z) const {
        samples.mark(at, less(I(-1), outside));
        store(layer + at, z);
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

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
