#include "raster/passes/view_geometry.hpp"

#include "raster/detail/stopwatch.hpp"

#include <algorithm>

namespace halflit::raster {

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
    if (vertex_count_ >= static_cast<std::int64_t>(kClipVertex)) return fail(ErrorCode::limit, "more than 2^31 vertices in view");
    if (triangle_count_ >= (std::int64_t{1} << 28)) return fail(ErrorCode::limit, "more than 2^28 triangles in view");
    cull_clusters(executor);
    times_ms_.cull = watch.lap();
    transform(kernels, executor);
    times_ms_.transform = watch.lap();
    bin(kernels, executor);
    times_ms_.bin = watch.lap();
    revision_ = revision;
    return {};
}

std::size_t Chunk::bytes() const {
    const auto size = [](const auto& list) { return list.capacity() * sizeof list[0]; };
    return size(runs) + size(records) + size(numbers) + size(clip_screen) + size(clip_vertices) + size(pairs) + size(tile_begin) +
           size(tile_list);
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
    for (const std::unique_ptr<Chunk>& chunk : chunks()) sum += chunk->records.size();
    return sum;
}

std::uint64_t ViewGeometry::triangles_not_finite() const {
    std::uint64_t sum = 0;
    for (const std::unique_ptr<Chunk>& chunk : chunks()) sum += chunk->not_finite;
    return sum;
}

}  // namespace halflit::raster
