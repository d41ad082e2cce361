// Views of very many triangles: drops those that no sample shows, before the rest of the view is made.
//
// A sample shows the nearest opaque triangle, and of equal depths the first. So a triangle that loses against others of the view is not
// missed when more are added, and what is drawn at the end is the same. Triangles of layers and masks hide nothing here; they are dropped
// where opaque ones hide them wholly. Members of coplanar groups stay: what others of their plane show decides about them.
#include "raster/passes/tile.hpp"
#include "raster/passes/used_vertices.hpp"
#include "raster/passes/view_geometry.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <utility>
#include <vector>

namespace halflit::raster {
namespace {

/// For each chunk, for each of its records: 1 if some sample shows it.
using ShownRecords = std::vector<std::vector<std::uint8_t>>;

void mark(std::uint8_t& shown) {
    // Stored only once: other tasks read the same lines.
    const std::atomic_ref flag(shown);
    if (flag.load(std::memory_order_relaxed) == 0) flag.store(1, std::memory_order_relaxed);
}

bool covers_any(const TileScratch& scratch, const CoverBox& box) {
    for (int y = box.y0; y <= box.y1; ++y)
        for (int x = box.x0; x <= box.x1; ++x)
            if (scratch.buffers.coverage[y * kTileStride + x] != 0) return true;
    return false;
}

/// Takes the next smaller number for each depth: a masked triangle that comes first wins against an opaque one of the same depth.
void move_back(const TileRect& rect, int samples, TileBuffers& buffers) {
    for (int s = 0; s < samples; ++s)
        for (int y = 0; y < rect.height; ++y)
            for (int x = 0; x < rect.width; ++x)
                if (float& depth = buffers.depth[s][y * kTileStride + x]; depth > 0.0f)
                    depth = std::bit_cast<float>(std::bit_cast<std::uint32_t>(depth) - 1);
}

void mark_shown(const ViewGeometry& geometry, const RasterKernels& kernels, StopSignal& stop, int tile, TileScratch& scratch,
                ShownRecords& shown) {
    draw_opaque(geometry, kernels, stop, tile, scratch);
    const TileRect rect = geometry.view().tile_rect(tile);
    const SamplePattern& samples = geometry.view().samples;
    std::uint32_t last = kNoTriangle;
    for (int s = 0; s < samples.count; ++s)
        for (int y = 0; y < rect.height; ++y)
            for (int x = 0; x < rect.width; ++x) {
                const std::uint32_t id = scratch.buffers.triangle[s][y * kTileStride + x];
                if (id == last || id == kNoTriangle) continue;
                last = id;
                const std::size_t chunk = geometry.chunk_of(id);
                mark(shown[chunk][id - geometry.source(chunk).id_base]);
            }
    if (geometry.has_coplanar())
        for (std::size_t c = 0; c < geometry.chunks().size(); ++c)
            for (const std::uint32_t record : geometry.tile_list(c, tile, scratch.tile_list))
                if (geometry.coplanar_group_of(geometry.source(c).id_base + record) != 0) mark(shown[c][record]);
    if (!geometry.has(AlphaMode::mask) && !geometry.has(AlphaMode::blend)) return;
    move_back(rect, samples.count, scratch.buffers);
    for (std::size_t c = 0; c < geometry.chunks().size(); ++c) {
        const TriangleSource& source = geometry.source(c);
        stop.check();
        for (const std::uint32_t record : geometry.tile_list(c, tile, scratch.tile_list)) {
            if (geometry.draw_of(source.records[record]).alpha_mode == AlphaMode::opaque) continue;
            if (std::atomic_ref(shown[c][record]).load(std::memory_order_relaxed) != 0) continue;
            const CoverBox box = kernels.cover(rect, samples, scratch.buffers, source, record);
            if (covers_any(scratch, box)) mark(shown[c][record]);
            clear_coverage(scratch, box);
        }
    }
}

/// Keeps the elements whose flag is set, in their order, and gives back the memory of the others.
template <class T>
void keep_flagged(std::vector<T>& list, const std::vector<std::uint8_t>& flags) {
    std::vector<T> kept;
    kept.reserve(static_cast<std::size_t>(std::count(flags.begin(), flags.end(), 1)));
    for (std::size_t i = 0; i < list.size(); ++i)
        if (flags[i] != 0) kept.push_back(list[i]);
    list.swap(kept);
}

/// For each element whose flag is set, its place among them.
std::vector<std::uint32_t> places(const std::vector<std::uint8_t>& flags) {
    std::vector<std::uint32_t> place(flags.size());
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < flags.size(); ++i) {
        place[i] = next;
        next += flags[i];
    }
    return place;
}

void keep_clip_vertices(Chunk& chunk) {
    std::vector<std::uint8_t> used(chunk.clip_vertices.size());
    for (const TriangleRecord& record : chunk.records)
        for (const std::uint32_t v : record.vertex)
            if (v >= kClipVertex) used[v - kClipVertex] = 1;
    const std::vector<std::uint32_t> place = places(used);
    for (TriangleRecord& record : chunk.records)
        for (std::uint32_t& v : record.vertex)
            if (v >= kClipVertex) v = kClipVertex + place[v - kClipVertex];
    keep_flagged(chunk.clip_vertices, used);
    keep_flagged(chunk.clip_screen, used);
}

void keep_in_tiles(Chunk& chunk, const std::vector<std::uint8_t>& shown) {
    const std::vector<std::uint32_t> place = places(shown);
    std::vector<std::uint32_t> kept;
    std::uint32_t begin = 0;
    for (std::size_t t = 0; t + 1 < chunk.tile_begin.size(); ++t) {
        const std::uint32_t end = chunk.tile_begin[t + 1];
        for (; begin < end; ++begin)
            if (const std::uint32_t record = chunk.tile_list[begin]; shown[record] != 0) kept.push_back(place[record]);
        chunk.tile_begin[t + 1] = static_cast<std::uint32_t>(kept.size());
    }
    kept.shrink_to_fit();
    chunk.tile_list.swap(kept);
}

void keep_shown(Chunk& chunk, const std::vector<std::uint8_t>& shown, std::span<const Draw> draws) {
    const std::size_t before = chunk.records.size();
    if (chunk.listed) keep_in_tiles(chunk, shown);
    keep_flagged(chunk.records, shown);
    if (!chunk.numbers.empty()) keep_flagged(chunk.numbers, shown);
    chunk.hidden += before - chunk.records.size();
    if (!chunk.clip_vertices.empty()) keep_clip_vertices(chunk);
    drop_unused_vertices(chunk, draws);
}

}  // namespace

void ViewGeometry::drop_hidden(std::size_t chunks, const RasterKernels& kernels, Executor& executor) {
    const std::size_t chunk_count = std::exchange(chunk_count_, chunks);
    // The view is complete for what is there, with each chunk's own vertices.
    if (list_sources()) {
        ShownRecords shown(chunks);
        for (std::size_t c = 0; c < chunks; ++c) {
            sources_[c].vertices = chunks_[c]->used.screen.data();
            shown[c].resize(chunks_[c]->records.size());
        }
        Pool<TileScratch> scratch;
        executor.run(view_.tile_count(), [&](int tile) {
            if (tile_is_empty(tile)) return;
            Pool<TileScratch>::Loan loan(scratch);
            mark_shown(*this, kernels, executor.stop(), tile, *loan, shown);
        });
        executor.run(static_cast<int>(chunks), [&](int i) {
            Chunk& chunk = *chunks_[static_cast<std::size_t>(i)];
            keep_shown(chunk, shown[static_cast<std::size_t>(i)], draws_);
            chunk.memory.hold(executor.stop(), chunk.bytes());
        });
    }
    chunk_count_ = chunk_count;
}

}  // namespace halflit::raster
