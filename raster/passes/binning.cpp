#include "raster/passes/binning.hpp"

#include "raster/passes/clip.hpp"

#include <algorithm>
#include <atomic>
#include <bit>

namespace halflit::raster {
namespace {

constexpr std::int64_t kLeastChunk = 2048;
constexpr std::int64_t kMostChunks = 128;

/// A clipped triangle becomes at most this many.
constexpr int kMostPieces = kMaxPolygon - 2;

class ChunkBuilder {
public:
    ChunkBuilder(Frame& frame, Chunk& chunk) : frame_(frame), chunk_(chunk) {
        for (int s = 0; s < frame.pattern.count; ++s) {
            sample_min_x_ = std::min<int>(sample_min_x_, frame.pattern.x[s]);
            sample_max_x_ = std::max<int>(sample_max_x_, frame.pattern.x[s]);
            sample_min_y_ = std::min<int>(sample_min_y_, frame.pattern.y[s]);
            sample_max_y_ = std::max<int>(sample_max_y_, frame.pattern.y[s]);
        }
        tile_shift_ = std::countr_zero(static_cast<unsigned>(frame.tile_size));
    }

    void build() {
        chunk_.records.clear();
        chunk_.submitted.clear();
        chunk_.clip_screen.clear();
        chunk_.clip_vertices.clear();
        chunk_.pairs.clear();
        chunk_.not_finite = 0;
        auto draw = std::upper_bound(frame_.draws.begin(), frame_.draws.end(), chunk_.first,
                                     [](std::int64_t t, const Draw& d) { return t < d.triangle_base; }) -
                    frame_.draws.begin() - 1;
        for (std::int64_t t = chunk_.first; t < chunk_.end; ++draw) {
            const Draw& d = frame_.draws[static_cast<std::size_t>(draw)];
            const std::int64_t end = std::min(chunk_.end, d.triangle_base + static_cast<std::int64_t>(d.mesh->indices.size() / 3));
            add_triangles(d, static_cast<std::uint32_t>(draw), t, end);
            t = end;
        }
        sort_by_tile();
    }

private:
    void add_triangles(const Draw& draw, std::uint32_t draw_index, std::int64_t begin, std::int64_t end) {
        const std::uint32_t* index = draw.mesh->indices.data() + 3 * (begin - draw.triangle_base);
        const ScreenVertex* screen = frame_.screen.data();
        const std::uint8_t* outcodes = frame_.outcodes.data();
        const auto base = static_cast<std::uint32_t>(draw.vertex_base);
        for (std::int64_t t = begin; t < end; ++t, index += 3) {
            const std::uint32_t v[3] = {base + index[0], base + index[1], base + index[2]};
            const unsigned c0 = outcodes[v[0]], c1 = outcodes[v[1]], c2 = outcodes[v[2]];
            if ((c0 & c1 & c2 & kRejectWhenAll) != 0) continue;
            const unsigned any = c0 | c1 | c2;
            if ((any & (kNear | kGuard | kNotFinite)) == 0) {
                add(v, screen[v[0]], screen[v[1]], screen[v[2]], draw, draw_index, v, t);
            } else if (any & kNotFinite) {
                ++chunk_.not_finite;
            } else {
                add_clipped(v, index, any, draw, draw_index, t);
            }
        }
    }

    void add_clipped(const std::uint32_t (&v)[3], const std::uint32_t* index, unsigned codes, const Draw& draw, std::uint32_t draw_index,
                     std::int64_t t) {
        float clip[3][4];
        for (int k = 0; k < 3; ++k) {
            const Vec3f p = draw.mesh->positions[index[k]];
            const Vec4f c = ((draw.clip_from_object.c[0] * p.x + draw.clip_from_object.c[1] * p.y) + draw.clip_from_object.c[2] * p.z) +
                            draw.clip_from_object.c[3];
            clip[k][0] = c.x;
            clip[k][1] = c.y;
            clip[k][2] = c.z;
            clip[k][3] = c.w;
        }
        PolygonVertex polygon[kMaxPolygon];
        const int n = clip_triangle(clip, codes, frame_.viewport, polygon);
        if (n == 0) return;
        const std::size_t records_before = chunk_.records.size(), corners_before = chunk_.clip_vertices.size();
        std::uint32_t corner[kMaxPolygon];
        ScreenVertex screen[kMaxPolygon];
        for (int k = 0; k < n; ++k) {
            if (polygon[k].corner >= 0) {
                corner[k] = v[polygon[k].corner];
                screen[k] = frame_.screen.data()[corner[k]];
                continue;
            }
            corner[k] = kClipVertex + static_cast<std::uint32_t>(chunk_.clip_vertices.size());
            screen[k] = project(polygon[k].clip, frame_.viewport);
            chunk_.clip_screen.push_back(screen[k]);
            ClipVertex made{{v[0], v[1], v[2]}, draw_index, {}};
            for (int i = 0; i < 3; ++i) made.weight[i] = static_cast<float>(polygon[k].weight[i]);
            chunk_.clip_vertices.push_back(made);
        }
        for (int k = 2; k < n; ++k) {
            const std::uint32_t piece[3] = {corner[0], corner[k - 1], corner[k]};
            add(piece, screen[0], screen[k - 1], screen[k], draw, draw_index, v, t);
        }
        // Corners that no drawn piece uses must not stay: they would be made from parents whose records nobody made.
        if (chunk_.records.size() == records_before) {
            chunk_.clip_vertices.resize(corners_before);
            chunk_.clip_screen.resize(corners_before);
        }
    }

    /// Culls, records and bins one triangle; `parents` are the vertices whose records its shading will read.
    void add(const std::uint32_t (&v)[3], const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, const Draw& draw,
             std::uint32_t draw_index, const std::uint32_t (&parents)[3], std::int64_t submitted) {
        const int least_x = std::min({a.x, b.x, c.x}), most_x = std::max({a.x, b.x, c.x});
        const int least_y = std::min({a.y, b.y, c.y}), most_y = std::max({a.y, b.y, c.y});
        const Region& r = frame_.region;
        const int x0 = std::max((least_x - sample_max_x_ + 255) >> 8, r.x), x1 = std::min((most_x - sample_min_x_) >> 8, r.x + r.width - 1);
        const int y0 = std::max((least_y - sample_max_y_ + 255) >> 8, r.y),
                  y1 = std::min((most_y - sample_min_y_) >> 8, r.y + r.height - 1);
        if (x0 > x1 || y0 > y1) return;

        const std::int64_t area = static_cast<std::int64_t>(b.x - a.x) * (c.y - a.y) - static_cast<std::int64_t>(c.x - a.x) * (b.y - a.y);
        if (area == 0) return;
        // y points down here: a counter-clockwise triangle has negative area.
        const bool back = (area > 0) != draw.mirrored;
        if (back && draw.cull_back) return;
        const bool swap = area < 0;
        if (x0 == x1 && y0 == y1 && frame_.pattern.count == 1 && !covers(a, swap ? c : b, swap ? b : c, x0 * 256, y0 * 256)) return;

        const auto record = static_cast<std::uint32_t>(chunk_.records.size());
        chunk_.records.push_back({{v[0], swap ? v[2] : v[1], swap ? v[1] : v[2]}, draw_index * 2 + (back ? 1u : 0u)});
        if (frame_.keep_submitted) chunk_.submitted.push_back(submitted);
        for (const std::uint32_t p : parents)
            std::atomic_ref(frame_.group_used.data()[p / kVertexGroup]).store(1, std::memory_order_relaxed);

        const int tx0 = (x0 - r.x) >> tile_shift_, tx1 = (x1 - r.x) >> tile_shift_, ty0 = (y0 - r.y) >> tile_shift_,
                  ty1 = (y1 - r.y) >> tile_shift_;
        if (tx0 == tx1 || ty0 == ty1) {
            for (int ty = ty0; ty <= ty1; ++ty)
                for (int tx = tx0; tx <= tx1; ++tx) push(ty * frame_.tiles_x + tx, record);
        } else {
            push_touched_tiles(a, swap ? c : b, swap ? b : c, tx0, ty0, tx1, ty1, record);
        }
    }

    /// The sample at (x, y) in fixed point, by the top-left rule; a, b, c with positive area.
    static bool covers(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, std::int32_t x, std::int32_t y) {
        const auto inside = [x, y](const ScreenVertex& p, const ScreenVertex& q) {
            const std::int32_t ea = p.y - q.y, eb = q.x - p.x;
            const std::int64_t e = static_cast<std::int64_t>(ea) * (x - p.x) + static_cast<std::int64_t>(eb) * (y - p.y);
            return e > 0 || (e == 0 && (ea > 0 || (ea == 0 && eb > 0)));
        };
        return inside(a, b) && inside(b, c) && inside(c, a);
    }

    /// Tiles of a block that no edge has wholly outside.
    void push_touched_tiles(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, int tx0, int ty0, int tx1, int ty1,
                            std::uint32_t record) {
        const ScreenVertex* corner[4] = {&a, &b, &c, &a};
        const std::int64_t span = 256 * frame_.tile_size;
        for (int ty = ty0; ty <= ty1; ++ty) {
            for (int tx = tx0; tx <= tx1; ++tx) {
                // The tile with half a pixel around it holds all of its samples.
                const std::int64_t left = 256 * (frame_.region.x + static_cast<std::int64_t>(tx) * frame_.tile_size) - 128;
                const std::int64_t top = 256 * (frame_.region.y + static_cast<std::int64_t>(ty) * frame_.tile_size) - 128;
                bool outside = false;
                for (int k = 0; k < 3; ++k) {
                    const ScreenVertex &p = *corner[k], &q = *corner[k + 1];
                    const std::int64_t ea = p.y - q.y, eb = q.x - p.x;
                    const std::int64_t x = ea > 0 ? left + span : left, y = eb > 0 ? top + span : top;
                    outside |= ea * (x - p.x) + eb * (y - p.y) < 0;
                }
                if (!outside) push(ty * frame_.tiles_x + tx, record);
            }
        }
    }

    void push(int tile, std::uint32_t record) { chunk_.pairs.push_back(static_cast<std::uint64_t>(tile) << 32 | record); }

    /// A counting sort: stable, so each tile keeps submission order.
    void sort_by_tile() {
        const auto tiles = static_cast<std::size_t>(frame_.tiles_x) * static_cast<std::size_t>(frame_.tiles_y);
        chunk_.tile_begin.assign(tiles + 1, 0);
        chunk_.tile_list.resize(chunk_.pairs.size());
        for (const std::uint64_t p : chunk_.pairs) ++chunk_.tile_begin[(p >> 32) + 1];
        for (std::size_t t = 0; t < tiles; ++t) chunk_.tile_begin[t + 1] += chunk_.tile_begin[t];
        for (const std::uint64_t p : chunk_.pairs) chunk_.tile_list[chunk_.tile_begin[p >> 32]++] = static_cast<std::uint32_t>(p);
        // Each entry now holds the end of its tile; shift back to the beginnings.
        for (std::size_t t = tiles; t > 0; --t) chunk_.tile_begin[t] = chunk_.tile_begin[t - 1];
        chunk_.tile_begin[0] = 0;
    }

    Frame& frame_;
    Chunk& chunk_;
    int sample_min_x_ = 0, sample_max_x_ = 0, sample_min_y_ = 0, sample_max_y_ = 0;
    int tile_shift_ = 6;
};

}  // namespace

void bin_triangles(Frame& frame, Executor& executor) {
    const std::int64_t size = std::max(kLeastChunk, (frame.triangle_count + kMostChunks - 1) / kMostChunks);
    frame.chunk_count = static_cast<std::size_t>((frame.triangle_count + size - 1) / size);
    frame.local_bits = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(size) * kMostPieces));
    while (frame.chunks.size() < frame.chunk_count) frame.chunks.push_back(std::make_unique<Chunk>());
    executor.run(static_cast<int>(frame.chunk_count), [&](int i) {
        Chunk& chunk = *frame.chunks[static_cast<std::size_t>(i)];
        chunk.first = i * size;
        chunk.end = std::min(chunk.first + size, frame.triangle_count);
        ChunkBuilder(frame, chunk).build();
    });
    frame.sources.clear();
    for (std::size_t i = 0; i < frame.chunk_count; ++i) {
        const Chunk& chunk = *frame.chunks[i];
        frame.sources.push_back(
            {chunk.records.data(), frame.screen.data(), chunk.clip_screen.data(), static_cast<std::uint32_t>(i << frame.local_bits)});
    }
}

}  // namespace halflit::raster
