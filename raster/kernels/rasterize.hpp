// Visibility inside one tile: exact integer edge functions, top-left rule, float depth, nearest wins.
//
// The edge from a to b of a triangle with positive area has the edge function E(p) = A (px - ax) + B (py - ay), A = ay - by, B = bx - ax.
// Inside the triangle E >= 0. At pixel centres all terms except the constant C are multiples of 256, so E >= 0 is exactly
// A i + B j + floor(C / 256) >= 0 with whole pixel numbers i, j. Edges that are neither top nor left lose one unit in C, so that a pixel
// centre on a shared edge is drawn once. C is computed in 64 bits and rebased to the box that is walked. An edge that does not cross the
// box either holds for all of it or rejects it; the values of the other edges fit 32 bits (kGuardBandPx).
#pragma once

#include "raster/kernels/triangle_setup.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

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

/// Edge functions at pixel (x0, y0) of a small triangle.
HALFLIT_INLINE void small_edges(const Edge* edges, const ScreenVertex* const* from, std::int32_t x, std::int32_t y, BoxEdge* out) {
    for (int k = 0; k < 3; ++k) {
        const bool top_left = is_top_left(edges[k].a, edges[k].b);
        out[k] = {(edges[k].a * (x - from[k]->x) + edges[k].b * (y - from[k]->y) - (top_left ? 0 : 1)) >> 8, edges[k].a, edges[k].b};
    }
}

/// Draws all samples of one triangle in the part of a tile. make_sink(s) gives the sink of sample s. Returns the box walked.
template <bool kRound, class MakeSink>
HALFLIT_INLINE CoverBox draw_samples(const TileRect& tile, const TileRect& part, const SamplePattern& pattern, const TriangleSource& source,
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
        bx0 = bx0 < part.x ? part.x : bx0;
        by0 = by0 < part.y ? part.y : by0;
        bx1 = bx1 >= part.x + part.width ? part.x + part.width - 1 : bx1;
        by1 = by1 >= part.y + part.height ? part.y + part.height - 1 : by1;
        if (bx0 > bx1 || by0 > by1) continue;
        if constexpr (kRound) {
            walk<0>(nullptr, make_depth_plane(slope, v0, v1, v2, sx, sy), bx0, by0, bx1 - bx0 + 1, by1 - by0 + 1,
                    (by0 - tile.y) * kTileStride + (bx0 - tile.x), in_circle(make_sink(s), tile, least_x, most_x, least_y, sx, sy));
            grow(all, bx0 - tile.x, by0 - tile.y, bx1 - tile.x, by1 - tile.y);
            continue;
        }
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

template <class MakeSink>
HALFLIT_INLINE CoverBox draw_triangle(const TileRect& tile, const TileRect& part, const SamplePattern& pattern,
                                      const TriangleSource& source, const TriangleRecord& record, const MakeSink& make_sink) {
    return record.is_round() ? draw_samples<true>(tile, part, pattern, source, record, make_sink)
                             : draw_samples<false>(tile, part, pattern, source, record, make_sink);
}

/// The sink of one triangle.
template <bool kIds>
HALFLIT_INLINE auto visible_sink(float* depth, std::uint32_t* triangle, std::uint32_t id) {
    if constexpr (kIds)
        return WriteVisible{depth, triangle, id};
    else
        return WriteDepth{depth};
}

/// Draws a sample of small triangles. lanes: those to draw; ids: of the lanes; kIds: whether the ids of visible triangles are written.
template <bool kIds>
HALFLIT_INLINE void draw_lanes(const TileRect& tile, const TriangleCorners& corners, const SetupLanes& setup, std::uint32_t lanes,
                               const std::uint32_t* ids, int sample_x, int sample_y, float* depth, std::uint32_t* triangle) {
    const SampleLanes sample = set_up_sample(tile, corners, setup, sample_x, sample_y);
    const std::uint32_t some = mask_bits(less(I(0), sample.width) & less(I(0), sample.height)) & lanes;
    const std::uint32_t tiny =
        mask_bits(less(sample.width, I(kTinyBox + 1)) & less(sample.height, I(kTinyBox + 1))) & some & ~corners.round;
    TinyHits hits;
    hits.mask = 0;
    if (tiny != 0) test_tiny(tile, setup, sample, tiny, hits);
    const auto draw_hits = [&](std::uint64_t mask) __attribute__((always_inline)) {
        for (; mask != 0; mask &= mask - 1) {
            const int k = __builtin_ctzll(mask);
            const std::int32_t at = hits.at[k];
            const float old = depth[at], z = hits.z[k];
            const bool pass = z > old;
            depth[at] = pass ? z : old;
            if constexpr (kIds) triangle[at] = pass ? ids[k >> 2] : triangle[at];
        }
    };
    std::uint32_t larger = some & ~tiny;
    if (larger != 0) {
        StoredLanes stored;
        store_lanes(setup, sample, stored);
        alignas(64) std::int32_t least_x[kWidth], most_x[kWidth], least_y[kWidth];
        if ((larger & corners.round) != 0) store(least_x, corners.least_x), store(most_x, corners.most_x), store(least_y, corners.least_y);
        // In the order of the list: of equal depths the first stays.
        for (; larger != 0; larger &= larger - 1) {
            const int l = __builtin_ctz(larger);
            const std::uint64_t before = hits.mask & ((std::uint64_t{1} << (4 * l)) - 1u);
            draw_hits(before);
            hits.mask ^= before;
            const auto sink = visible_sink<kIds>(depth, triangle, ids[l]);
            if ((corners.round >> l & 1) != 0)
                walk_box_of_lane(tile, stored, l, in_circle(sink, tile, least_x[l], most_x[l], least_y[l], sample_x, sample_y));
            else
                walk_lane(tile, stored, l, sink);
        }
    }
    draw_hits(hits.mask);
}

/// Triangles ahead whose records and vertices are prefetched: records first, as they tell the vertices.
inline constexpr int kRecordsAhead = 32, kVerticesAhead = 16;

template <bool kIds>
HALFLIT_INLINE void draw_triangles(const TileRect& tile, const SamplePattern& pattern, TileBuffers& buffers, const TriangleTable& triangles,
                                   const std::uint32_t* ids, int count) {
    const auto prefetch_records = [&](int from, int to) __attribute__((always_inline)) {
        for (int i = from; i < to && i < count; ++i) prefetch(&record_of(triangles, ids[i]));
    };
    const auto prefetch_vertices = [&](int from, int to) __attribute__((always_inline)) {
        for (int i = from; i < to && i < count; ++i)
            for (int k = 0; k < 3; ++k) prefetch(&vertex_of(source_of(triangles, ids[i]), record_of(triangles, ids[i]).vertex[k]));
    };
    prefetch_records(0, kRecordsAhead);
    prefetch_vertices(0, kVerticesAhead);
    for (int first = 0; first < count; first += kWidth) {
        prefetch_records(first + kRecordsAhead, first + kRecordsAhead + kWidth);
        prefetch_vertices(first + kVerticesAhead, first + kVerticesAhead + kWidth);
        const int n = count - first < kWidth ? count - first : kWidth;
        const TriangleCorners corners = load_corners(triangles, ids + first, n);
        const std::uint32_t lanes = (1u << n) - 1u;
        std::uint32_t large = ~corners.small & lanes;
        const SetupLanes setup = set_up(corners);
        // Small triangles are drawn together, up to the next large one.
        for (std::uint32_t left = lanes; left != 0;) {
            const std::uint32_t run = large != 0 ? ((large & (0u - large)) - 1u) & left : left;
            if (run != 0)
                for (int s = 0; s < pattern.count; ++s)
                    draw_lanes<kIds>(tile, corners, setup, run, ids + first, pattern.x[s], pattern.y[s], buffers.depth[s],
                                     buffers.triangle[s]);
            left &= ~run;
            if (large == 0) break;
            const std::uint32_t id = ids[first + __builtin_ctz(large)];
            draw_triangle(
                tile, tile, pattern, source_of(triangles, id), record_of(triangles, id), [&](int s) __attribute__((always_inline)) {
                    return visible_sink<kIds>(buffers.depth[s], buffers.triangle[s], id);
                });
            left &= left - 1;
            large &= large - 1;
        }
    }
}

inline void rasterize(const TileRect& tile, const SamplePattern& pattern, TileBuffers& buffers, const TriangleTable& triangles,
                      const std::uint32_t* ids, int count) {
    draw_triangles<true>(tile, pattern, buffers, triangles, ids, count);
}

inline void rasterize_depth(const TileRect& tile, const SamplePattern& pattern, TileBuffers& buffers, const TriangleTable& triangles,
                            const std::uint32_t* ids, int count) {
    draw_triangles<false>(tile, pattern, buffers, triangles, ids, count);
}

inline void draw_covered(const TileRect& tile, const SamplePattern& pattern, TileBuffers& buffers, const TriangleSource& source,
                         std::uint32_t record) {
    draw_triangle(
        tile, tile, pattern, source, source.records[record], [&](int s) __attribute__((always_inline)) {
            return WriteCovered{
                {buffers.depth[s], buffers.triangle[s], source.id_base + record}, buffers.coverage, static_cast<std::uint16_t>(1u << s)};
        });
}

inline CoverBox cover(const TileRect& tile, const SamplePattern& pattern, TileBuffers& buffers, const TriangleSource& source,
                      std::uint32_t record) {
    return draw_triangle(
        tile, tile, pattern, source, source.records[record], [&](int s) __attribute__((always_inline)) {
            return MarkCoverage{buffers.depth[s], {buffers.coverage, static_cast<std::uint16_t>(1u << s)}};
        });
}

inline CoverBox cover_layer(const TileRect& tile, const TileRect& part, const SamplePattern& pattern, TileBuffers& buffers,
                            LayerDepths& layer, const TriangleSource& source, std::uint32_t record) {
    return draw_triangle(
        tile, part, pattern, source, source.records[record], [&](int s) __attribute__((always_inline)) {
            return MarkLayer{{buffers.depth[s], {buffers.coverage, static_cast<std::uint16_t>(1u << s)}}, layer.depth[s]};
        });
}

inline CoverBox cover_all(const TileRect& tile, const TileRect& part, const SamplePattern& pattern, TileBuffers& buffers,
                          LayerDepths& layer, const TriangleSource& source, std::uint32_t record) {
    return draw_triangle(
        tile, part, pattern, source, source.records[record], [&](int s) __attribute__((always_inline)) {
            return MarkAll{{buffers.coverage, static_cast<std::uint16_t>(1u << s)}, layer.depth[s]};
        });
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
