// The bin pass: triangle set-up and the tiles' triangle lists. Drops back faces, triangles without area, and triangles that touch no pixel
// of the region. Clips the few that cross the near plane or leave the guard band. Each tile's list is in submission order.
#include "raster/passes/clip.hpp"
#include "raster/passes/quads.hpp"
#include "raster/passes/tile_grid.hpp"
#include "raster/passes/used_vertices.hpp"
#include "raster/passes/view_geometry.hpp"
#include "raster/view/culling.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <atomic>
#include <bit>

namespace halflit::raster {
namespace {

/// Input of binning. groups_drawn is output: it marks the vertex groups that drawn triangles read.
struct BinInput {
    const PreparedData& scene;
    const View& view;
    std::span<const Draw> draws;
    const ScreenVertex* screen;
    const std::uint8_t* outcodes;
    std::uint8_t* groups_drawn;
    const OcclusionGrid* occlusion;  ///< not null: triangles hide its places, and are not kept
    bool numbered;                   ///< keep each record's submission number
    bool only_used;                  ///< keep only the vertices that triangles use
    const RasterKernels& kernels;
    StopSignal& stop;
};

constexpr int kTrianglesBetweenChecks = 1024;
/// A chunk lists the triangles of each tile as long as these are few. Long triangles touch hundreds of tiles each, and a file of some
/// megabytes could fill the memory with lists: a chunk with more entries than this keeps none, and each tile looks through all its
/// triangles.
constexpr std::size_t kFreePairs = 1 << 16, kPairsPerTriangle = 32;

class ChunkBuilder {
public:
    ChunkBuilder(const BinInput& input, Chunk& chunk) : in_(input), chunk_(chunk), grid_(input.view) {}

    void build() {
        chunk_.records.clear();
        chunk_.clip_screen.clear();
        chunk_.clip_vertices.clear();
        chunk_.pairs.clear();
        chunk_.listed = true;
        chunk_.not_finite = chunk_.hidden = 0;
        chunk_.numbers.clear();
        chunk_.used = {};
        chunk_.material = chunk_.runs.empty() ? -1 : in_.draws[chunk_.runs[0].draw].material;
        for (const TriangleRun& run : chunk_.runs) {
            if (in_.draws[run.draw].material != chunk_.material) chunk_.material = -1;
            add_triangles(run);
        }
        if (in_.occlusion != nullptr) return count_memory();
        if (chunk_.listed) sort_by_tile();
        if (in_.only_used) {
            std::vector<std::uint64_t>().swap(chunk_.pairs);
            copy_used_vertices(chunk_, in_.draws, in_.screen);
        }
        count_memory();
    }

private:
    /// Origin of a triangle: its draw, and the mesh's numbers of its vertices.
    struct Source {
        const Draw& draw;
        std::uint32_t draw_index;
        std::uint32_t first;  ///< added to `vertex`; of the quad's draw, otherwise 0
        const std::uint32_t* vertex;
        std::uint32_t triangle;  ///< number within the mesh

        /// Index of a corner in the view's arrays.
        [[nodiscard]] std::uint32_t corner(int k) const { return static_cast<std::uint32_t>(draw.vertex_base) + first + vertex[k]; }
    };

    void add_triangles(const TriangleRun& run) {
        const Draw& draw = in_.draws[run.draw];
        BinArgs args{};
        grid_.describe(args);
        args.mirrored = draw.mirrored;
        args.cull_back = draw.cull_back;
        args.round = draw.topology == Topology::points && in_.view.point_size >= kLeastRound;
        const std::uint32_t* const indices = in_.scene.source_mesh(draw.mesh).indices.data();
        BinnedTriangles binned;
        for (std::uint32_t first = run.first; first < run.end; first += kBinnedAtOnce) {
            const int count = static_cast<int>(std::min<std::uint32_t>(run.end - first, kBinnedAtOnce));
            if ((since_check_ += count) >= kTrianglesBetweenChecks) count_memory();
            // The four vertices of quad i begin at 4 i, its two triangles are 2 i and 2 i + 1.
            const std::uint32_t first_vertex = draw.quads() ? 2 * first : 0;
            const std::uint32_t* const index = draw.quads() ? quad_indices() : indices + std::size_t{3} * first;
            args.screen = in_.screen + draw.vertex_base + first_vertex;
            args.outcodes = in_.outcodes + draw.vertex_base + first_vertex;
            in_.kernels.bin_triangles(args, index, count, binned);
            for (std::uint64_t left = binned.keep | binned.other; left != 0; left &= left - 1) {
                const int i = std::countr_zero(left);
                const Source source{draw, run.draw, first_vertex, index + 3 * i, first + static_cast<std::uint32_t>(i)};
                if ((binned.other >> i & 1) != 0)
                    add_other(source);
                else
                    add_binned(source, binned, i);
            }
        }
    }

    /// A triangle that the kernel left alone.
    void add_other(const Source& source) {
        const std::uint32_t v[3] = {source.corner(0), source.corner(1), source.corner(2)};
        const unsigned any = in_.outcodes[v[0]] | in_.outcodes[v[1]] | in_.outcodes[v[2]];
        if ((any & (kNear | kGuard | kNotFinite)) == 0) {
            add(v, in_.screen[v[0]], in_.screen[v[1]], in_.screen[v[2]], source);
        } else if (source.draw.quads()) {
            if (source.triangle % 2 == 0) add_odd_quad(any, source);
        } else if (any & kNotFinite) {
            ++chunk_.not_finite;
        } else {
            add_clipped(v, any, source);
        }
    }

    void add_binned(const Source& source, const BinnedTriangles& binned, int i) {
        const bool swap = (binned.swap >> i & 1) != 0, back = (binned.back >> i & 1) != 0;
        const std::uint32_t v[3] = {source.corner(0), source.corner(swap ? 2 : 1), source.corner(swap ? 1 : 2)};
        const TileGrid::Tiles tiles{binned.tile_x0[i], binned.tile_x1[i], binned.tile_y0[i], binned.tile_y1[i]};
        add_record(v, in_.screen[v[0]], in_.screen[v[1]], in_.screen[v[2]], back, tiles, source);
    }

    /// Clip coordinates of a vertex of a draw's mesh.
    [[nodiscard]] Vec4f clip_coordinates(const Draw& draw, std::uint32_t vertex) const {
        const Mat4 m = multiply_in_double(in_.view.clip_from_world, in_.scene.scene().instances[draw.instance].world_from_object);
        const Vec3f p = in_.scene.source_mesh(draw.mesh).positions[vertex];
        return ((m.c[0] * p.x + m.c[1] * p.y) + m.c[2] * p.z) + m.c[3];
    }

    /// Both triangles of a line or point that needs clipping or is not finite. A point is not clipped: its middle lies before the near
    /// plane or outside of the guard band.
    void add_odd_quad(unsigned codes, const Source& source) {
        if (codes & kNotFinite) {
            chunk_.not_finite += 2;
            return;
        }
        if (source.draw.topology != Topology::lines) return;
        double clip[2][4];
        for (std::uint32_t k = 0; k < 2; ++k) {
            const Vec4f c = clip_coordinates(source.draw, source.triangle + k);
            clip[k][0] = c.x, clip[k][1] = c.y, clip[k][2] = c.z, clip[k][3] = c.w;
        }
        ClippedLine line;
        if (!clip_line(clip, in_.view, line)) return;
        // Corners 0 and 1 are those of the line's first end, 2 and 3 those of its second one.
        const std::uint32_t a = source.corner(0), b = source.corner(1);
        const auto first = static_cast<std::uint32_t>(chunk_.clip_vertices.size());
        const std::size_t records_before = chunk_.records.size();
        for (int k = 0; k < 4; ++k) {
            chunk_.clip_screen.push_back(line.corner[k]);
            const auto weight = static_cast<float>(line.weight[k / 2]);
            chunk_.clip_vertices.push_back({{a, b, b}, source.draw_index, {1.0f - weight, weight, 0.0f}});
        }
        for (std::uint32_t t = 0; t < 2; ++t) {
            const std::uint32_t* const corner = quad_indices() + std::size_t{3} * t;
            const std::uint32_t v[3] = {kClipVertex + first + corner[0], kClipVertex + first + corner[1], kClipVertex + first + corner[2]};
            const Source piece{source.draw, source.draw_index, source.first, source.vertex + std::size_t{3} * t, source.triangle + t};
            add(v, line.corner[corner[0]], line.corner[corner[1]], line.corner[corner[2]], piece);
        }
        if (chunk_.records.size() == records_before) {
            chunk_.clip_vertices.resize(first);
            chunk_.clip_screen.resize(first);
        }
    }

    void add_clipped(const std::uint32_t (&v)[3], unsigned codes, const Source& source) {
        float clip[3][4];
        for (int k = 0; k < 3; ++k) {
            const Vec4f c = clip_coordinates(source.draw, source.vertex[k]);
            clip[k][0] = c.x;
            clip[k][1] = c.y;
            clip[k][2] = c.z;
            clip[k][3] = c.w;
        }
        PolygonVertex polygon[kMaxPolygon];
        const int n = clip_triangle(clip, codes, in_.view.viewport, polygon);
        if (n == 0) return;
        const std::size_t records_before = chunk_.records.size(), corners_before = chunk_.clip_vertices.size();
        std::uint32_t corner[kMaxPolygon];
        ScreenVertex screen[kMaxPolygon];
        for (int k = 0; k < n; ++k) {
            if (polygon[k].corner >= 0 && (in_.outcodes[v[polygon[k].corner]] & kGuard) == 0) {
                corner[k] = v[polygon[k].corner];
                screen[k] = in_.screen[corner[k]];
                continue;
            }
            corner[k] = kClipVertex + static_cast<std::uint32_t>(chunk_.clip_vertices.size());
            screen[k] = project(polygon[k].clip, in_.view.viewport);
            chunk_.clip_screen.push_back(screen[k]);
            ClipVertex made{{v[0], v[1], v[2]}, source.draw_index, {}};
            for (int i = 0; i < 3; ++i) made.weight[i] = static_cast<float>(polygon[k].weight[i]);
            chunk_.clip_vertices.push_back(made);
        }
        for (int k = 2; k < n; ++k) {
            const std::uint32_t piece[3] = {corner[0], corner[k - 1], corner[k]};
            add(piece, screen[0], screen[k - 1], screen[k], source);
        }
        // If no piece is drawn, its corners are removed: their records would be made from vertices that may have none.
        if (chunk_.records.size() == records_before) {
            chunk_.clip_vertices.resize(corners_before);
            chunk_.clip_screen.resize(corners_before);
        }
    }

    /// Culls, records and bins a triangle or a piece of one. v: its corners, in the view's arrays or clip vertices.
    void add(const std::uint32_t (&v)[3], const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, const Source& source) {
        const TileGrid::Pixels p = grid_.pixels(a, b, c);
        if (p.empty()) return;

        const std::int64_t area = static_cast<std::int64_t>(b.x - a.x) * (c.y - a.y) - static_cast<std::int64_t>(c.x - a.x) * (b.y - a.y);
        if (area == 0) return;
        // y points down here: a counter-clockwise triangle has negative area.
        const bool back = (area > 0) != source.draw.mirrored;
        if (back && source.draw.cull_back) return;
        const bool swap = area < 0;
        if (p.x0 == p.x1 && p.y0 == p.y1 && in_.view.samples.count == 1 && !is_round(a, b, c, source) &&
            !covers(a, swap ? c : b, swap ? b : c, p.x0 * 256, p.y0 * 256))
            return;

        const std::uint32_t ordered[3] = {v[0], v[swap ? 2 : 1], v[swap ? 1 : 2]};
        add_record(ordered, a, swap ? c : b, swap ? b : c, back, grid_.tiles(p), source);
    }

    /// v, a, b, c: in the order of positive area.
    void add_record(const std::uint32_t (&v)[3], const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, bool back,
                    const TileGrid::Tiles& tiles, const Source& source) {
        if (in_.occlusion != nullptr) return in_.kernels.occlude(*in_.occlusion, a, b, c, tiles.x0, tiles.y0, tiles.x1, tiles.y1);
        const bool round = is_round(a, b, c, source);
        if (round && source.triangle % 2 != 0) return;  // the point's first triangle stands for all of it
        if (is_hidden_by_last(a, b, c, source.draw)) return;
        const auto record = static_cast<std::uint32_t>(chunk_.records.size());
        chunk_.records.push_back({{v[0], v[1], v[2]},
                                  source.draw_index << TriangleRecord::kBits | (back ? TriangleRecord::kBackFace : 0u) |
                                      (round ? TriangleRecord::kRoundPoint : 0u)});
        if (in_.numbered) chunk_.numbers.push_back(source.draw.triangle_base + source.triangle);
        for (int k = 0; k < 3; ++k) {
            // Stored only once: other tasks read the same lines.
            const std::uint32_t vertex = (source.first + source.vertex[k]) >> source.draw.vertex_shift();
            const std::atomic_ref drawn(in_.groups_drawn[source.draw.group_base + vertex / kVertexGroup]);
            if (drawn.load(std::memory_order_relaxed) == 0) drawn.store(1, std::memory_order_relaxed);
        }

        if (!chunk_.listed) return;
        const auto list = [&](int tile) { chunk_.pairs.push_back(static_cast<std::uint64_t>(tile) << 32 | record); };
        if (tiles.x0 == tiles.x1 && tiles.y0 == tiles.y1) {
            list(grid_.number(tiles.x0, tiles.y0));
            return;
        }
        grid_.for_each(a, b, c, tiles, round, list);
        if (chunk_.pairs.size() > kFreePairs + kPairsPerTriangle * chunk_.records.size()) {
            chunk_.listed = false;
            chunk_.drop_lists();
        }
    }

    /// Points below this size, in 1/256 pixel, are squares: their corners are less than a sample apart from a circle.
    static constexpr std::int32_t kLeastRound = 3 * 256;

    static bool is_round(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, const Source& source) {
        return source.draw.topology == Topology::points && std::max({a.x, b.x, c.x}) - std::min({a.x, b.x, c.x}) >= kLeastRound;
    }

    /// True if the triangle before it is equal, in corners and material, and hides it: of equal depths the first stays. Crafted files
    /// hold thousands of copies.
    [[nodiscard]] bool is_hidden_by_last(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, const Draw& draw) const {
        if (chunk_.records.empty()) return false;
        const TriangleRecord& last = chunk_.records.back();
        const auto is = [&](int k, const ScreenVertex& other) {
            const std::uint32_t v = last.vertex[k];
            const ScreenVertex& own = v < kClipVertex ? in_.screen[v] : chunk_.clip_screen[v - kClipVertex];
            return own.x == other.x && own.y == other.y && own.z == other.z && own.inv_w == other.inv_w;
        };
        if (!is(0, a) || !is(1, b) || !is(2, c)) return false;
        const Draw& of_last = in_.draws[last.draw()];
        return of_last.material == draw.material && draw.alpha_mode == AlphaMode::opaque && of_last.alpha_mode == AlphaMode::opaque;
    }

    /// True if the triangle covers the sample at (x, y) in fixed point, by the top-left rule. a, b, c: in the order of positive area.
    static bool covers(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, std::int32_t x, std::int32_t y) {
        const auto inside = [x, y](const ScreenVertex& p, const ScreenVertex& q) {
            const std::int32_t ea = p.y - q.y, eb = q.x - p.x;
            const std::int64_t e = static_cast<std::int64_t>(ea) * (x - p.x) + static_cast<std::int64_t>(eb) * (y - p.y);
            return e > 0 || (e == 0 && is_top_left(ea, eb));
        };
        return inside(a, b) && inside(b, c) && inside(c, a);
    }

    /// Ends the call if it holds too much memory or is to stop.
    void count_memory() {
        constexpr std::uint64_t kUnitsATriangle = 40;
        charge_work(kUnitsATriangle * static_cast<std::uint64_t>(since_check_));
        since_check_ = 0;
        in_.stop.check();
        chunk_.memory.hold(in_.stop, chunk_.bytes());
    }

    /// Counting sort; it is stable, so each tile keeps submission order.
    void sort_by_tile() {
        const auto tiles = static_cast<std::size_t>(in_.view.tiles_x) * static_cast<std::size_t>(in_.view.tiles_y);
        chunk_.tile_begin.assign(tiles + 1, 0);
        chunk_.tile_list.resize(chunk_.pairs.size());
        const auto tile_of = [](std::uint64_t pair) { return static_cast<std::size_t>(pair >> 32); };
        for (const std::uint64_t p : chunk_.pairs) ++chunk_.tile_begin[tile_of(p) + 1];
        for (std::size_t t = 0; t < tiles; ++t) chunk_.tile_begin[t + 1] += chunk_.tile_begin[t];
        for (const std::uint64_t p : chunk_.pairs) chunk_.tile_list[chunk_.tile_begin[tile_of(p)]++] = static_cast<std::uint32_t>(p);
        // Each entry now holds the end of its tile; shift back to the beginnings.
        for (std::size_t t = tiles; t > 0; --t) chunk_.tile_begin[t] = chunk_.tile_begin[t - 1];
        chunk_.tile_begin[0] = 0;
    }

    const BinInput& in_;
    Chunk& chunk_;
    TileGrid grid_;
    int since_check_ = 0;
};

}  // namespace

void ViewGeometry::bin(const Batch& batch, const RasterKernels& kernels, Executor& executor) {
    const BinInput input{*scene_,
                         view_,
                         draws_,
                         screen_.data(),
                         outcodes_.data(),
                         groups_drawn_.data(),
                         occlusion_,
                         numbered_,
                         has_only_used_vertices(),
                         kernels,
                         executor.stop()};
    const int count = static_cast<int>(batch.end_chunk - batch.first_chunk);
    const auto build = [&](int i) { ChunkBuilder(input, *chunks_[batch.first_chunk + static_cast<std::size_t>(i)]).build(); };
    if (occlusion_ == nullptr)
        executor.run(count, build);
    else
        for (int i = 0; i < count; ++i) build(i);  // all write to one grid
}

Result<void> ViewGeometry::list_sources() {
    std::int64_t most = 0;
    for (const std::unique_ptr<Chunk>& chunk : chunks()) most = std::max(most, static_cast<std::int64_t>(chunk->records.size()));
    local_bits_ = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(most)));
    if (local_bits_ + std::bit_width(chunk_count_) > 32) return fail(ErrorCode::limit, "triangles in view cannot be numbered");
    const ScreenVertex* const vertices = has_only_used_vertices() ? used_screen_.data() : screen_.data();
    sources_.clear();
    for (std::size_t i = 0; i < chunk_count_; ++i)
        sources_.push_back(
            {chunks_[i]->records.data(), vertices, chunks_[i]->clip_screen.data(), static_cast<std::uint32_t>(i << local_bits_)});
    return {};
}

std::span<const std::uint32_t> ViewGeometry::tile_list(std::size_t chunk, int tile, std::vector<std::uint32_t>& scratch) const {
    const Chunk& from = *chunks_[chunk];
    if (from.listed) return from.tile(tile);
    scratch.clear();
    const TileGrid grid(view_);
    const TriangleSource& source = sources_[chunk];
    const auto corner = [&](std::uint32_t v) -> const ScreenVertex& {
        return v < kClipVertex ? source.vertices[v] : source.clip_vertices[v - kClipVertex];
    };
    for (std::size_t i = 0; i < from.records.size(); ++i) {
        const TriangleRecord& record = from.records[i];
        if (grid.touches(corner(record.vertex[0]), corner(record.vertex[1]), corner(record.vertex[2]), record.is_round(), tile))
            scratch.push_back(static_cast<std::uint32_t>(i));
    }
    return scratch;
}

}  // namespace halflit::raster
