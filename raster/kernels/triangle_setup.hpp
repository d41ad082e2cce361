// Set-up of kWidth small triangles side by side: one triangle in each lane. All of their integer arithmetic fits 32 bits
// (kSmallTriangle). Depth planes are computed in double, by the operations of make_depth_plane() in their order, so they have its bits.
#pragma once

#include "raster/kernels/triangle_walk.hpp"
#include "shading/kernels/simd_double.hpp"
#include "shading/kernels/simd_records.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Corners of kWidth triangles. `small`: triangles that the other functions here can set up. Others have all corners at (0, 0). `round`:
/// those of round points, unset where only corners are known.
struct TriangleCorners {
    I x[3], y[3];
    F z[3];
    I least_x, most_x, least_y, most_y;
    std::uint32_t small, round = 0;
};

HALFLIT_INLINE TriangleCorners corners_at(const float* const (&corner)[3][kWidth]) {
    TriangleCorners t;
    for (int k = 0; k < 3; ++k) {
        F x, y, inv_w;
        load4(corner[k], x, y, t.z[k], inv_w);
        t.x[k] = bits(x);
        t.y[k] = bits(y);
    }
    t.least_x = vmin(vmin(t.x[0], t.x[1]), t.x[2]);
    t.most_x = vmax(vmax(t.x[0], t.x[1]), t.x[2]);
    t.least_y = vmin(vmin(t.y[0], t.y[1]), t.y[2]);
    t.most_y = vmax(vmax(t.y[0], t.y[1]), t.y[2]);
    const M small = less(t.most_x - t.least_x, I(kSmallTriangle)) & less(t.most_y - t.least_y, I(kSmallTriangle));
    t.small = mask_bits(small);
    if (!all(small)) {
        for (int k = 0; k < 3; ++k) {
            t.x[k] = sel(small, t.x[k], I(0));
            t.y[k] = sel(small, t.y[k], I(0));
        }
        t.least_x = sel(small, t.least_x, I(0));
        t.most_x = sel(small, t.most_x, I(0));
        t.least_y = sel(small, t.least_y, I(0));
        t.most_y = sel(small, t.most_y, I(0));
    }
    return t;
}

HALFLIT_INLINE TriangleCorners load_corners(const TriangleTable& triangles, const std::uint32_t* ids, int count) {
    const float* corner[3][kWidth];
    std::uint32_t round = 0;
    for (int l = 0; l < kWidth; ++l) {
        const std::uint32_t id = ids[l < count ? l : count - 1];
        const TriangleSource& source = source_of(triangles, id);
        const TriangleRecord& record = record_of(triangles, id);
        for (int k = 0; k < 3; ++k) corner[k][l] = reinterpret_cast<const float*>(&vertex_of(source, record.vertex[k]));
        round |= record.is_round() ? 1u << l : 0u;
    }
    TriangleCorners corners = corners_at(corner);
    corners.round = round;
    return corners;
}

/// Values that all samples of a triangle share, for kWidth triangles: edge functions a x + b y, and the slopes of depth.
struct SetupLanes {
    I a[3], b[3], not_top_left[3];
    I anchor_x, anchor_y;
    F zx, zy, lo, hi;
    D z0, slope_x, slope_y;
};

/// Edge k, from corner k to the next one: change per pixel, and 1 for edges that are not top or left.
HALFLIT_INLINE void make_edge(const TriangleCorners& t, int k, I& a, I& b, I& not_top_left) {
    const int n = (k + 1) % 3;
    a = t.y[k] - t.y[n];
    b = t.x[n] - t.x[k];
    // is_top_left(): a > 0, or a = 0 and b > 0.
    const M top_left = less(I(0), a) | (equal(a, I(0)) & less(I(0), b));
    not_top_left = sel(top_left, I(0), I(1));
}

HALFLIT_INLINE SetupLanes set_up(const TriangleCorners& t) {
    SetupLanes s;
    for (int k = 0; k < 3; ++k) make_edge(t, k, s.a[k], s.b[k], s.not_top_left[k]);
    s.anchor_x = shr<8>(t.x[0]);
    s.anchor_y = shr<8>(t.y[0]);
    s.lo = vmin(vmin(t.z[0], t.z[1]), t.z[2]);
    s.hi = vmax(vmax(t.z[0], t.z[1]), t.z[2]);
    const D x1 = to_double(t.x[1] - t.x[0]), y1 = to_double(t.y[1] - t.y[0]);
    const D x2 = to_double(t.x[2] - t.x[0]), y2 = to_double(t.y[2] - t.y[0]);
    s.z0 = to_double(t.z[0]);
    const D z1 = to_double(t.z[1]) - s.z0, z2 = to_double(t.z[2]) - s.z0;
    const D inv_area = d_set(1.0) / (x1 * y2 - x2 * y1);
    s.slope_x = (z1 * y2 - z2 * y1) * inv_area;
    s.slope_y = (z2 * x1 - z1 * x2) * inv_area;
    s.zx = to_single(s.slope_x * d_set(256.0));
    s.zy = to_single(s.slope_y * d_set(256.0));
    return s;
}

/// One sample of kWidth triangles: the box of pixels that each may cover in the tile, edge functions and depth for its first pixel.
struct SampleLanes {
    I x0, y0, width, height;  ///< a width or height below 1: no pixel
    I e[3];
    F za;
};

HALFLIT_INLINE SampleLanes set_up_sample(const TileRect& tile, const TriangleCorners& t, const SetupLanes& s, int sample_x, int sample_y) {
    const I sx(sample_x), sy(sample_y);
    SampleLanes p;
    p.x0 = vmax(shr<8>(t.least_x - sx + I(255)), I(tile.x));
    p.y0 = vmax(shr<8>(t.least_y - sy + I(255)), I(tile.y));
    p.width = vmin(shr<8>(t.most_x - sx), I(tile.x + tile.width - 1)) - p.x0 + I(1);
    p.height = vmin(shr<8>(t.most_y - sy), I(tile.y + tile.height - 1)) - p.y0 + I(1);
    // Only where the box is empty does this change a position; it keeps the products below within 32 bits.
    const I px = vmin(shl<8>(p.x0) + sx, t.most_x), py = vmin(shl<8>(p.y0) + sy, t.most_y);
    for (int k = 0; k < 3; ++k) p.e[k] = shr<8>(s.a[k] * (px - t.x[k]) + s.b[k] * (py - t.y[k]) - s.not_top_left[k]);
    const D dx = to_double(shl<8>(s.anchor_x) + sx - t.x[0]), dy = to_double(shl<8>(s.anchor_y) + sy - t.y[0]);
    p.za = to_single((s.z0 + s.slope_x * dx) + s.slope_y * dy);
    return p;
}

/// Boxes up to this size are tested pixel by pixel, each for all lanes at once.
inline constexpr int kTinyBox = 2;

/// Pixels of tiny boxes that their triangles cover: bit 4 l + k is pixel (k % 2, k / 2) of lane l's box.
struct TinyHits {
    std::uint64_t mask;
    alignas(64) float z[4 * kWidth];          ///< depth of pixel 4 l + k
    alignas(64) std::int32_t at[4 * kWidth];  ///< its index in the tile's buffers
};

/// Bit l goes to bit 4 l.
HALFLIT_INLINE std::uint64_t spread4(std::uint64_t x) {
    x = (x | x << 24) & 0x000000ff000000ffu;
    x = (x | x << 12) & 0x000f000f000f000fu;
    x = (x | x << 6) & 0x0303030303030303u;
    return (x | x << 3) & 0x1111111111111111u;
}

/// tiny: lanes whose boxes are.
HALFLIT_INLINE void test_tiny(const TileRect& tile, const SetupLanes& s, const SampleLanes& p, std::uint32_t tiny, TinyHits& hits) {
    const I second_column = p.width - I(2), second_row = p.height - I(2);  // below 0 if the box has none
    I outside[4];
    for (int k = 0; k < 4; ++k) {
        I e[3] = {p.e[0], p.e[1], p.e[2]};
        for (int n = 0; n < 3; ++n) {
            if (k & 1) e[n] = e[n] + s.a[n];
            if (k & 2) e[n] = e[n] + s.b[n];
        }
        outside[k] = e[0] | e[1] | e[2];
        if (k & 1) outside[k] = outside[k] | second_column;
        if (k & 2) outside[k] = outside[k] | second_row;
    }
    hits.mask = 0;
    for (int k = 0; k < 4; ++k) hits.mask |= spread4(~sign_bits(outside[k]) & tiny) << k;
    if (hits.mask == 0) return;
    const I x = p.x0 - s.anchor_x, y = p.y0 - s.anchor_y;
    const F x_of[2] = {to_float(x), to_float(x + I(1))};
    const F row[2] = {mad(to_float(y), s.zy, p.za), mad(to_float(y + I(1)), s.zy, p.za)};
    F z[4];
    for (int k = 0; k < 4; ++k) z[k] = vmin(vmax(mad(x_of[k & 1], s.zx, row[k >> 1]), s.lo), s.hi);
    store4(hits.z, z[0], z[1], z[2], z[3]);
    const I at = (p.y0 - I(tile.y)) * I(kTileStride) + (p.x0 - I(tile.x));
    store4(reinterpret_cast<float*>(hits.at), from_bits(at), from_bits(at + I(1)), from_bits(at + I(kTileStride)),
           from_bits(at + I(kTileStride + 1)));
}

/// The lanes of a sample in memory, for the walk of larger boxes.
struct StoredLanes {
    alignas(64) std::int32_t x0[kWidth], y0[kWidth], width[kWidth], height[kWidth];
    alignas(64) std::int32_t a[3][kWidth], b[3][kWidth], e[3][kWidth];
    alignas(64) std::int32_t anchor_x[kWidth], anchor_y[kWidth];
    alignas(64) float za[kWidth], zx[kWidth], zy[kWidth], lo[kWidth], hi[kWidth];
};

HALFLIT_INLINE void store_lanes(const SetupLanes& s, const SampleLanes& p, StoredLanes& out) {
    store(out.x0, p.x0);
    store(out.y0, p.y0);
    store(out.width, p.width);
    store(out.height, p.height);
    for (int k = 0; k < 3; ++k) {
        store(out.a[k], s.a[k]);
        store(out.b[k], s.b[k]);
        store(out.e[k], p.e[k]);
    }
    store(out.anchor_x, s.anchor_x);
    store(out.anchor_y, s.anchor_y);
    store(out.za, p.za);
    store(out.zx, s.zx);
    store(out.zy, s.zy);
    store(out.lo, s.lo);
    store(out.hi, s.hi);
}

/// Walks the box of a lane, whatever the triangle covers of it.
template <class Sink>
HALFLIT_INLINE void walk_box_of_lane(const TileRect& tile, const StoredLanes& s, int l, const Sink& sink) {
    const DepthPlane plane{s.za[l], s.zx[l], s.zy[l], s.lo[l], s.hi[l], s.anchor_x[l], s.anchor_y[l]};
    walk<0>(nullptr, plane, s.x0[l], s.y0[l], s.width[l], s.height[l], (s.y0[l] - tile.y) * kTileStride + (s.x0[l] - tile.x), sink);
}

/// Walks the box of a lane.
template <class Sink>
HALFLIT_INLINE void walk_lane(const TileRect& tile, const StoredLanes& s, int l, const Sink& sink) {
    const int x0 = s.x0[l], y0 = s.y0[l], w = s.width[l], h = s.height[l];
    int at = (y0 - tile.y) * kTileStride + (x0 - tile.x);
    if (w > kWidth) {
        const BoxEdge edges[3] = {{s.e[0][l], s.a[0][l], s.b[0][l]}, {s.e[1][l], s.a[1][l], s.b[1][l]}, {s.e[2][l], s.a[2][l], s.b[2][l]}};
        const DepthPlane plane{s.za[l], s.zx[l], s.zy[l], s.lo[l], s.hi[l], s.anchor_x[l], s.anchor_y[l]};
        walk<3>(edges, plane, x0, y0, w, h, at, sink);
        return;
    }
    // One vector of each row.
    const I lane = iota_i(), limit = I(w - 1) - lane;
    I e[3], down[3];
    for (int k = 0; k < 3; ++k) {
        e[k] = I(s.e[k][l]) + I(s.a[k][l]) * lane;
        down[k] = I(s.b[k][l]);
    }
    const F over = to_float(I(x0 - s.anchor_x[l]) + lane), zx(s.zx[l]), lo(s.lo[l]), hi(s.hi[l]);
    const float zy = s.zy[l], za = s.za[l];
    int row = y0 - s.anchor_y[l];
    for (int j = h; j > 0; --j, at += kTileStride, ++row) {
        const I outside = (limit | e[0]) | (e[1] | e[2]);
        for (int k = 0; k < 3; ++k) e[k] = e[k] + down[k];
        const F z = mad(over, zx, F(mad(static_cast<float>(row), zy, za)));
        sink.pixels(at, outside, vmin(vmax(z, lo), hi));
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
