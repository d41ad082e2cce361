#include "raster/passes/view_geometry.hpp"

#include "raster/detail/stopwatch.hpp"

#include <algorithm>

namespace halflit::raster {
namespace {

constexpr std::int64_t kMostVertices = kClipVertex;
/// Bytes of the scene's textures and of a view's triangles together, about 6 million of them without textures. The triangles have at
/// least kLeast, and an eighth of the textures' bytes. Beyond it those that are hidden are dropped.
constexpr std::size_t kBudget = std::size_t{384} << 20, kLeast = std::size_t{64} << 20, kShareOfTextures = 8;
/// Share of the memory that a call may take.
constexpr std::size_t kShareOfMemory = 4;

std::size_t triangle_budget(const Scene& scene, const StopSignal& call) {
    std::size_t textures = 0;
    for (const Texture& texture : scene.textures) textures += texture.data().size_bytes();
    const std::size_t budget = std::max({kBudget - std::min(textures, kBudget), kLeast, textures / kShareOfTextures});
    return call.memory_limit() == 0 ? budget : std::min(budget, call.memory_limit() / kShareOfMemory);
}

tl::unexpected<Error> fail_too_many_vertices() { return fail(ErrorCode::limit, "more than 2^31 vertices in view"); }

}  // namespace

Result<void> ViewGeometry::make(const PreparedData& scene, const View& view, const RasterKernels& kernels, Executor& executor,
                                bool numbered) {
    // Colours and lights change nothing here.
    const SceneRevision revision{scene.revision().geometry, 0, 0, scene.revision().coverage};
    times_ms_ = {};
    if (revision == revision_ && view == view_ && (numbered_ || !numbered)) {
        scene_ = &scene;
        return {};
    }
    scene_ = &scene;
    view_ = view;
    numbered_ = numbered;
    revision_ = {};  // invalid until all passes are done
    ++version_;
    Stopwatch watch;
    list_draws(executor);
    if (triangle_count_ >= (std::int64_t{1} << 28)) return fail(ErrorCode::limit, "more than 2^28 triangles in view");
    divide_into_chunks();
    divide_into_batches();
    cull_clusters(executor);
    times_ms_.cull = watch.lap();
    for (const Batch& batch : batches_)
        if (batch.vertex_count >= kMostVertices) return fail_too_many_vertices();
    const std::size_t budget = triangle_budget(scene.scene(), executor.stop());
    std::size_t held = 0, most = budget;
    for (const Batch& batch : batches_) {
        transform(batch, kernels, executor);
        times_ms_.transform += watch.lap();
        bin(batch, kernels, executor);
        if (has_only_used_vertices()) held += bytes_of_chunks(batch.first_chunk, batch.end_chunk);
        if (held > most) {
            drop_hidden(batch.end_chunk, kernels, executor);
            held = bytes_of_chunks(0, batch.end_chunk);
            most = std::max(budget, 2 * held);
        }
        times_ms_.bin += watch.lap();
    }
    if (has_only_used_vertices())
        if (auto ok = number_used_vertices(executor); !ok) return ok;
    if (auto ok = list_sources(); !ok) return ok;
    times_ms_.bin += watch.lap();
    revision_ = revision;
    return {};
}

Result<void> ViewGeometry::occlude(const PreparedData& scene, const View& view, const OcclusionGrid& grid, const RasterKernels& kernels,
                                   Executor& executor) {
    forget();
    struct Setting {
        ViewGeometry& of;
        ~Setting() { of.occlusion_ = nullptr, of.forget(); }
    } const ends_also_by_exception{*this};
    occlusion_ = &grid;
    return make(scene, view, kernels, executor);
}

/// Gives the used vertices of all chunks one numbering, that of the view, and moves them to its arrays.
Result<void> ViewGeometry::number_used_vertices(Executor& executor) {
    std::vector<std::int64_t> bases;
    for (Draw& draw : draws_) draw.record_count = -1;  // has no vertex yet
    std::int64_t count = 0;
    for (std::size_t c = 0; c < chunk_count_; ++c) {
        const UsedVertices& used = chunks_[c]->used;
        bases.push_back(count);
        for (const UsedVertices::Part& part : used.parts) {
            Draw& draw = draws_[part.draw];
            if (draw.record_count >= 0) continue;  // continues from the previous chunk, which ends with its vertices
            draw.record_count = 0;
            draw.vertex_base = count + part.first;
        }
        count += static_cast<std::int64_t>(used.screen.size());
    }
    if (count >= kMostVertices) return fail_too_many_vertices();
    vertex_count_ = count;
    for (std::size_t d = draws_.size(); d-- > 0;) {
        Draw& draw = draws_[d];
        if (draw.record_count < 0) draw.vertex_base = count;
        draw.record_count = (count - draw.vertex_base) >> draw.vertex_shift();
        count = draw.vertex_base;
    }
    group_count_ = 0;
    for (Draw& draw : draws_) {
        draw.group_base = group_count_;
        group_count_ += draw.group_count();
    }
    ScreenVertex* const screen = used_screen_.reserve(static_cast<std::size_t>(vertex_count_), executor.stop());
    std::uint32_t* const mesh_vertices = mesh_vertices_.reserve(static_cast<std::size_t>(vertex_count_), executor.stop());
    executor.run(static_cast<int>(chunk_count_), [&](int i) {
        Chunk& chunk = *chunks_[static_cast<std::size_t>(i)];
        const std::int64_t base = bases[static_cast<std::size_t>(i)];
        const auto renumber = [base](std::uint32_t& v) {
            if (v < kClipVertex) v += static_cast<std::uint32_t>(base);
        };
        for (TriangleRecord& record : chunk.records) std::for_each(std::begin(record.vertex), std::end(record.vertex), renumber);
        for (ClipVertex& vertex : chunk.clip_vertices) std::for_each(std::begin(vertex.parent), std::end(vertex.parent), renumber);
        std::copy(chunk.used.screen.begin(), chunk.used.screen.end(), screen + base);
        std::copy(chunk.used.mesh_vertex.begin(), chunk.used.mesh_vertex.end(), mesh_vertices + base);
        chunk.used = {};
        chunk.memory.hold(executor.stop(), chunk.bytes());
    });
    return {};
}

namespace {

template <class SizeOf>
std::size_t bytes_of(const Chunk& chunk, const SizeOf& size) {
    return size(chunk.runs) + size(chunk.records) + size(chunk.numbers) + size(chunk.clip_screen) + size(chunk.clip_vertices) +
           size(chunk.pairs) + size(chunk.tile_begin) + size(chunk.tile_list) + size(chunk.used.parts) + size(chunk.used.screen) +
           size(chunk.used.mesh_vertex);
}

}  // namespace

std::size_t Chunk::bytes() const {
    return bytes_of(*this, [](const auto& list) { return list.capacity() * sizeof list[0]; });
}

std::size_t Chunk::bytes_used() const {
    return bytes_of(*this, [](const auto& list) { return list.size() * sizeof list[0]; });
}

std::size_t ViewGeometry::bytes_of_chunks(std::size_t first, std::size_t end) const {
    constexpr std::size_t kBytesOfRecord = 48;  // VertexRecords takes 32 to 80 for each vertex
    std::size_t sum = 0;
    for (std::size_t c = first; c < end; ++c) sum += chunks_[c]->bytes_used() + kBytesOfRecord * chunks_[c]->used.screen.size();
    return sum;
}

void Chunk::drop_lists() {
    // Assigning {} would keep the memory.
    std::vector<std::uint64_t>().swap(pairs);
    std::vector<std::uint32_t>().swap(tile_begin);
    std::vector<std::uint32_t>().swap(tile_list);
}

bool ViewGeometry::tile_is_empty(int tile) const {
    return std::all_of(chunks().begin(), chunks().end(), [&](const std::unique_ptr<Chunk>& chunk) {
        return chunk->records.empty() || (chunk->listed && chunk->tile(tile).empty());
    });
}

std::uint64_t ViewGeometry::triangles_drawn() const {
    std::uint64_t sum = 0;
    for (const std::unique_ptr<Chunk>& chunk : chunks()) sum += chunk->records.size() + chunk->hidden;
    return sum;
}

std::uint64_t ViewGeometry::triangles_not_finite() const {
    std::uint64_t sum = 0;
    for (const std::unique_ptr<Chunk>& chunk : chunks()) sum += chunk->not_finite;
    return sum;
}

}  // namespace halflit::raster
