// The cull pass: instances first, then the clusters of those that remain.
#include "raster/passes/quads.hpp"
#include "raster/passes/view_geometry.hpp"
#include "raster/view/culling.hpp"
#include "sh/mat4.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>

namespace halflit::raster {
namespace {

constexpr std::size_t kInstancesPerTask = 1024;
constexpr std::int64_t kLeastClusters = 16, kMostChunks = 128;  ///< clusters in a chunk; chunks in a view
/// Target number of vertices of a batch; each takes 17 bytes. Smaller views are made at once.
constexpr std::int64_t kMostVerticesAtOnce = std::int64_t{1} << 20;
constexpr std::size_t kChunksOfBatch = 8, kLeastChunksOfBatch = 4;  ///< so that several threads have work
constexpr std::int64_t kMostTileLists = 1 << 22;  ///< chunks times tiles of a view, for four chunks or more; an empty list takes 4 bytes

bool is_mirrored(const View& view, const Mat4& world_from_object) { return (determinant3(world_from_object) < 0.0) != view.mirrored; }

Culler culler_of(const View& view, const Mat4& world_from_object, bool back_faces, Topology topology) {
    // Half of the diagonal of a point's square, or of a line's end, is less than its side.
    const double margin_px = topology == Topology::triangles ? 0.0 : size_of(view, topology) / 256.0;
    return {view, multiply_in_double(view.clip_from_world, world_from_object), is_mirrored(view, world_from_object), back_faces, margin_px};
}

Culler::Verdict verdict_on(const Culler& culler, const Bounds& bounds) {
    const float min[3] = {bounds.min.x, bounds.min.y, bounds.min.z}, max[3] = {bounds.max.x, bounds.max.y, bounds.max.z};
    return culler.box(min, max);
}

/// Index of the draw that has a cluster.
std::size_t draw_of_cluster(std::span<const Draw> draws, std::int64_t cluster) {
    const auto next =
        std::upper_bound(draws.begin(), draws.end(), cluster, [](std::int64_t c, const Draw& d) { return c < d.cluster_base; });
    return static_cast<std::size_t>(next - draws.begin()) - 1;
}

/// Culls the clusters of one chunk.
class ChunkCuller {
public:
    ChunkCuller(const PreparedData& scene, const View& view, Chunk& chunk, std::uint8_t* groups_seen)
        : scene_(scene), view_(view), chunk_(chunk), groups_seen_(groups_seen) {}

    void cull(const std::vector<Draw>& draws) {
        chunk_.runs.clear();
        auto draw = draws.begin() + static_cast<std::ptrdiff_t>(draw_of_cluster(draws, chunk_.first_cluster));
        for (std::int64_t c = chunk_.first_cluster; c < chunk_.end_cluster; ++draw) {
            const std::int64_t end =
                std::min(chunk_.end_cluster, draw->cluster_base + static_cast<std::int64_t>(scene_.mesh(draw->mesh).cluster_count()));
            cull(*draw, static_cast<std::uint32_t>(draw - draws.begin()), static_cast<std::size_t>(c - draw->cluster_base),
                 static_cast<std::size_t>(end - draw->cluster_base));
            c = end;
        }
    }

private:
    void cull(const Draw& draw, std::uint32_t number, std::size_t begin, std::size_t end) {
        const PreparedMesh& mesh = scene_.mesh(draw.mesh);
        const Culler culler = culler_of(view_, scene_.scene().instances[draw.instance].world_from_object, draw.cull_back, draw.topology);
        const bool test_boxes = mesh.cluster_count() > 1 && verdict_on(culler, mesh.bounds) != Culler::Verdict::inside;
        for (std::size_t c = begin; c < end; ++c) {
            const Cluster& cluster = mesh.clusters[c];
            if (cluster.finite) {  // others are kept: binning counts their triangles that are not finite
                if (test_boxes && culler.box(cluster.min, cluster.max) == Culler::Verdict::outside) continue;
                if (culler.faces_away(cluster)) continue;
            }
            keep(draw, number, c);
        }
    }

    void keep(const Draw& draw, std::uint32_t number, std::size_t cluster) {
        const IndexRange triangles = triangles_of_cluster(scene_.source_mesh(draw.mesh), cluster);
        const auto first = static_cast<std::uint32_t>(triangles.begin), end = static_cast<std::uint32_t>(triangles.end);
        if (!chunk_.runs.empty() && chunk_.runs.back().draw == number && chunk_.runs.back().end == first)
            chunk_.runs.back().end = end;
        else
            chunk_.runs.push_back({number, first, end});
        for (const std::uint32_t group : scene_.mesh(draw.mesh).groups_of(cluster))
            std::atomic_ref(groups_seen_[draw.group_base + group]).store(1, std::memory_order_relaxed);
    }

    const PreparedData& scene_;
    const View& view_;
    Chunk& chunk_;
    std::uint8_t* groups_seen_;
};

}  // namespace

void ViewGeometry::list_draws(Executor& executor) {
    const std::vector<Instance>& instances = scene_->scene().instances;
    // If the whole scene lies inside the view, no instance needs a test.
    const bool all = verdict_on(Culler(view_, view_.clip_from_world, false, false), scene_->bounds()) == Culler::Verdict::inside;
    std::uint8_t* seen = nullptr;
    if (!all) {
        seen = seen_.reserve(instances.size());
        executor.run(static_cast<int>((instances.size() + kInstancesPerTask - 1) / kInstancesPerTask), [&](int task) {
            const std::size_t begin = static_cast<std::size_t>(task) * kInstancesPerTask;
            for (std::size_t i = begin; i < std::min(begin + kInstancesPerTask, instances.size()); ++i) {
                const PreparedMesh& mesh = scene_->mesh(instances[i].mesh);
                seen[i] = !mesh.finite || verdict_on(culler_of(view_, instances[i].world_from_object, false,
                                                               scene_->source_mesh(instances[i].mesh).topology),
                                                     mesh.bounds) != Culler::Verdict::outside;
            }
        });
    }
    draws_.clear();
    std::fill(std::begin(has_mode_), std::end(has_mode_), false);
    few_vertices_ = false;
    vertex_count_ = group_count_ = cluster_count_ = triangle_count_ = 0;
    std::int64_t triangle_base = 0;
    for (std::size_t i = 0; i < instances.size(); ++i) {
        const Mesh& mesh = scene_->source_mesh(instances[i].mesh);
        const auto triangles = static_cast<std::int64_t>(raster::triangle_count(mesh));
        triangle_base += triangles;
        if (mesh.splats != nullptr) continue;
        if (mesh.topology != Topology::triangles) {
            if (size_of(view_, mesh.topology) == 0) continue;
            vertex_count_ = (vertex_count_ + 3) / 4 * 4;
        }
        if (triangles == 0 || !instances[i].visible || (seen != nullptr && seen[i] == 0)) continue;
        Draw& draw = draws_.emplace_back();
        draw.instance = static_cast<std::uint32_t>(i);
        draw.mesh = instances[i].mesh;
        draw.topology = mesh.topology;
        draw.vertex_count = draw.record_count = static_cast<std::int64_t>(mesh.positions.size());
        draw.material = static_cast<std::int32_t>(scene_->material_of(i));
        draw.vertex_base = vertex_count_;
        draw.group_base = group_count_;
        draw.cluster_base = cluster_count_;
        draw.triangle_base = triangle_base - triangles;
        draw.mirrored = !draw.quads() && is_mirrored(view_, instances[i].world_from_object);
        draw.few_vertices = scene_->mesh(draw.mesh).few_vertices;
        few_vertices_ |= draw.few_vertices;
        const Material& material = scene_->material(scene_->material_of(i));
        draw.cull_back = !material.double_sided && !draw.quads();
        draw.alpha_mode = material.is_layer() ? AlphaMode::blend : material.alpha_mode;
        has_mode_[static_cast<std::size_t>(draw.alpha_mode)] = true;
        triangle_count_ += triangles;
        vertex_count_ += draw.view_vertex_count();
        group_count_ += draw.group_count();
        cluster_count_ += static_cast<std::int64_t>(scene_->mesh(draw.mesh).cluster_count());
    }
}

/// Chunks of about as many clusters each. They end where a draw does, if one does nearby.
void ViewGeometry::divide_into_chunks() {
    const std::int64_t usual = std::max(kMostChunks, std::int64_t{kChunksOfBatch} * (vertex_count_ / kMostVerticesAtOnce));
    const std::int64_t most = std::clamp<std::int64_t>(kMostTileLists / std::max(view_.tile_count(), 1), 4, usual);
    const std::int64_t size = std::max(kLeastClusters, (cluster_count_ + most - 1) / most);
    chunk_count_ = 0;
    for (std::int64_t first = 0, aim = size; first < cluster_count_; aim += size) {
        std::int64_t end = std::min(aim, cluster_count_);
        if (end < cluster_count_) {
            const std::size_t d = draw_of_cluster(draws_, end);
            const std::int64_t begin_of_draw = draws_[d].cluster_base;
            const std::int64_t end_of_draw = d + 1 < draws_.size() ? draws_[d + 1].cluster_base : cluster_count_;
            const std::int64_t nearest = end - begin_of_draw <= end_of_draw - end ? begin_of_draw : end_of_draw;
            if (std::abs(nearest - end) <= size / 2) end = nearest;
        }
        if (end <= first) continue;
        if (chunks_.size() == chunk_count_) chunks_.push_back(std::make_unique<Chunk>());
        Chunk& chunk = *chunks_[chunk_count_++];
        chunk.first_cluster = first;
        chunk.end_cluster = first = end;
    }
}

/// One batch, or several if there are many vertices; none without draws. Draws' vertices are numbered within their batch.
void ViewGeometry::divide_into_batches() {
    // A multiple of four, as lines and points need it.
    const auto first_vertex = [&](std::size_t draw) { return draws_[draw].vertex_base / 4 * 4; };
    batches_.clear();
    for (std::size_t c = 0; c < chunk_count_; ++c) {
        const Chunk& chunk = *chunks_[c];
        const std::size_t first = draw_of_cluster(draws_, chunk.first_cluster);
        const Draw& last = draws_[draw_of_cluster(draws_, chunk.end_cluster - 1)];
        const std::int64_t end_vertex = last.vertex_base + last.view_vertex_count();
        const bool is_first = batches_.empty() || (chunk.first_cluster == draws_[first].cluster_base &&
                                                   c >= batches_.back().first_chunk + kLeastChunksOfBatch &&
                                                   end_vertex - first_vertex(batches_.back().first_draw) > kMostVerticesAtOnce);
        if (is_first) batches_.push_back({first, first, c, c, 0});
        Batch& batch = batches_.back();
        batch.end_chunk = c + 1;
        batch.end_draw = static_cast<std::size_t>(&last - draws_.data()) + 1;
        batch.vertex_count = end_vertex - first_vertex(batch.first_draw);
    }
    for (const Batch& batch : batches_) {
        const std::int64_t base = first_vertex(batch.first_draw);
        for (std::size_t d = batch.first_draw; d < batch.end_draw; ++d) draws_[d].vertex_base -= base;
    }
}

void ViewGeometry::cull_clusters(Executor& executor) {
    const auto groups = static_cast<std::size_t>(group_count_);
    std::memset(groups_seen_.reserve(groups + 1, executor.stop()), 0, groups + 1);
    std::memset(groups_drawn_.reserve(groups + 1, executor.stop()), 0, groups + 1);
    one_material_ = draws_.empty() ? -1 : draws_[0].material;
    for (const Draw& draw : draws_) one_material_ = draw.material == one_material_ ? one_material_ : -1;
    executor.run(static_cast<int>(chunk_count_), [&](int i) {
        Chunk& chunk = *chunks_[static_cast<std::size_t>(i)];
        ChunkCuller(*scene_, view_, chunk, groups_seen_.data()).cull(draws_);
    });
}

}  // namespace halflit::raster
