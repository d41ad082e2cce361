// The geometry of one view: the instances and clusters that it may see, their vertices in its window, and each tile's triangles. Made by
// three passes, which read a PreparedData and a View and do not depend on lights:
//     cull -> transform -> bin (set-up and tile lists)
// The geometry is kept from frame to frame: the passes do not run again if neither scene nor view changed, and a frame like the last one
// allocates nothing.
//
// Views of many vertices are transformed and binned in batches, from draw to draw, and keep only the vertices that their triangles use
// (used_vertices.hpp): an instance takes some bytes of a file and could take megabytes of memory. Whenever the triangles of the batches
// take more than a budget, which they share with the textures, those that no sample shows are dropped (hidden_triangles.cpp): the opaque
// ones that stay are no more than there are samples.
#pragma once

#include "halflit/material.hpp"
#include "raster/detail/executor.hpp"
#include "raster/detail/raw_buffer.hpp"
#include "raster/kernels/raster_kernels.hpp"
#include "raster/scene/prepared_data.hpp"
#include "raster/view/view.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace halflit::raster {

/// One instance that the view may see.
struct Draw {
    std::uint32_t instance = 0;
    std::int32_t mesh = 0;           ///< a number, as the scene's arrays may be moved between frames
    std::int32_t material = 0;       ///< index as in PreparedData
    std::int64_t vertex_base = 0;    ///< index of its first vertex in the view's or batch's arrays, a multiple of four for lines and points
    std::int64_t group_base = 0;     ///< index of its first vertex group
    std::int64_t cluster_base = 0;   ///< index of its first cluster, over all draws
    std::int64_t triangle_base = 0;  ///< number of its first triangle in submission order, over all instances of the scene
    bool mirrored = false, cull_back = true, few_vertices = false;
    AlphaMode alpha_mode = AlphaMode::opaque;  ///< blend for all layers (Material::is_layer)

    Topology topology = Topology::triangles;

    std::int64_t vertex_count = 0;  ///< of the mesh
    std::int64_t record_count = 0;  ///< vertices of the mesh that have a number in the view: all of them, or those that triangles use
    [[nodiscard]] bool quads() const { return topology != Topology::triangles; }
    /// Vertex of the mesh from one of the view's: their number >> this. A quad has four of the view's vertices and one or two of the
    /// mesh's.
    [[nodiscard]] int vertex_shift() const { return topology == Topology::triangles ? 0 : topology == Topology::lines ? 1 : 2; }
    [[nodiscard]] std::int64_t view_vertex_count() const { return vertex_count << vertex_shift(); }
    [[nodiscard]] std::int64_t group_count() const { return (record_count + kVertexGroup - 1) / kVertexGroup; }
};

/// Consecutive triangles of one draw.
struct TriangleRun {
    std::uint32_t draw;
    std::uint32_t first, end;  ///< triangles of the mesh
};

/// A vertex made by clipping: weights of the three vertices of the triangle that it came from.
struct ClipVertex {
    std::uint32_t parent[3];
    std::uint32_t draw;
    float weight[3];
};

/// Vertices that the triangles of a chunk use, in the order of draws. Their number is a multiple of four.
struct UsedVertices {
    struct Part {
        std::uint32_t draw, first;  ///< number of its first vertex
    };
    std::vector<Part> parts;
    std::vector<ScreenVertex> screen;
    std::vector<std::uint32_t> mesh_vertex;  ///< of each
};

/// Consecutive chunks and their draws. No draw is in two batches. A batch is transformed and binned before the next one.
struct Batch {
    std::size_t first_draw = 0, end_draw = 0, first_chunk = 0, end_chunk = 0;
    std::int64_t vertex_count = 0;
};

/// Consecutive triangles in submission order. One task culls them and sets them up, into the chunk's own lists.
struct Chunk {
    std::int64_t first_cluster = 0, end_cluster = 0;  ///< indices as Draw::cluster_base
    std::vector<TriangleRun> runs;                    ///< triangles that culling kept
    std::vector<TriangleRecord> records;
    std::vector<std::int64_t> numbers;  ///< submission number of each record; empty unless asked for
    std::vector<ScreenVertex> clip_screen;
    std::vector<ClipVertex> clip_vertices;
    std::vector<std::uint64_t> pairs;       ///< tile << 32 | record, in submission order; scratch
    std::vector<std::uint32_t> tile_begin;  ///< per tile: first entry of tile_list; one more at the end
    std::vector<std::uint32_t> tile_list;
    int material = -1;             ///< of all its triangles; -1: they have several
    bool listed = true;            ///< false: too many entries, so there are no lists
    std::uint64_t not_finite = 0;  ///< triangles dropped for a NaN or infinite vertex
    std::uint64_t hidden = 0;      ///< triangles dropped because no sample shows them
    UsedVertices used;             ///< only while a view is made in batches
    MemoryShare memory;

    [[nodiscard]] std::size_t bytes() const;       ///< memory of all lists
    [[nodiscard]] std::size_t bytes_used() const;  ///< the same without what they hold in reserve
    void drop_lists();
    /// Only if `listed`.
    [[nodiscard]] std::span<const std::uint32_t> tile(int number) const {
        const auto t = static_cast<std::size_t>(number);
        return std::span(tile_list).subspan(tile_begin[t], tile_begin[t + 1] - tile_begin[t]);
    }
};

/// A point of a triangle, line or point of the mesh.
struct TrianglePoint {
    double weight[3] = {};  ///< of its corners, in the mesh's order; their sum is 1
    double u = 0, v = 0;    ///< Mesh::uv0 there
};

class ViewGeometry {
public:
    /// Runs the passes, unless scene and view are those of the last call. Fails if there are more vertices or triangles than can be
    /// numbered. numbered: keep each record's submission number, for triangle_of() and has_coplanar().
    Result<void> make(const PreparedData& scene, const View& view, const RasterKernels& kernels, Executor& executor, bool numbered = false);
    /// Marks the places that the view's triangles hide, without keeping any: make() has to run before other members are used. One thread
    /// at a time writes to the grid.
    Result<void> occlude(const PreparedData& scene, const View& view, const OcclusionGrid& grid, const RasterKernels& kernels,
                         Executor& executor);
    /// Makes the next make() run the passes.
    void forget() { revision_ = {}; }

    /// Milliseconds of wall clock of the last call.
    struct Times {
        double cull = 0, transform = 0, bin = 0;
    };
    [[nodiscard]] const Times& times_ms() const { return times_ms_; }
    /// Changes whenever make() runs the passes.
    [[nodiscard]] std::uint64_t version() const { return version_; }

    [[nodiscard]] const View& view() const { return view_; }
    [[nodiscard]] const PreparedData& scene() const { return *scene_; }
    [[nodiscard]] std::span<const Draw> draws() const { return draws_; }
    /// Vertices that have a number: of all draws, seen or not, or those that are used.
    [[nodiscard]] std::int64_t vertex_count() const { return vertex_count_; }
    [[nodiscard]] std::span<const std::unique_ptr<Chunk>> chunks() const { return std::span(chunks_).first(chunk_count_); }
    /// True if some draw's mesh has fewer than 1.5 vertices a triangle.
    [[nodiscard]] bool few_vertices() const { return few_vertices_; }
    /// True if surfaces in one plane are ordered by their materials. Only if `numbered`.
    [[nodiscard]] bool has_coplanar() const { return numbered_ && !scene_->coplanar().empty(); }
    /// CoplanarGroups::of a triangle. Requires: has_coplanar().
    [[nodiscard]] std::uint32_t coplanar_group_of(std::uint32_t id) const {
        const Draw& draw = draw_of(record(id));
        return scene_->coplanar().of(draw.instance, triangle_of(id, draw));
    }
    [[nodiscard]] bool has(AlphaMode mode) const { return has_mode_[static_cast<std::size_t>(mode)]; }
    /// A chunk's triangles as the kernels read them.
    [[nodiscard]] const TriangleSource& source(std::size_t chunk) const { return sources_[chunk]; }
    [[nodiscard]] TriangleTable table() const { return {sources_.data(), local_bits_}; }
    [[nodiscard]] std::size_t chunk_of(std::uint32_t id) const { return id >> local_bits_; }
    [[nodiscard]] const TriangleRecord& record(std::uint32_t id) const {
        return sources_[chunk_of(id)].records[id & ((1u << local_bits_) - 1u)];
    }
    /// Material of all triangles of the view, or of a chunk; -1: they have several.
    [[nodiscard]] int one_material() const { return one_material_; }
    [[nodiscard]] int one_material(std::size_t chunk) const { return chunks_[chunk]->material; }
    [[nodiscard]] const Draw& draw_of(const TriangleRecord& record) const { return draws_[record.draw()]; }
    /// Number of a triangle in submission order, over all instances of the scene; and of the triangle, line or point in its mesh. Only if
    /// `numbered`.
    [[nodiscard]] std::int64_t submission_of(std::uint32_t id) const {
        return chunks_[chunk_of(id)]->numbers[id & ((1u << local_bits_) - 1u)];
    }
    [[nodiscard]] std::uint32_t triangle_of(std::uint32_t id) const { return triangle_of(id, draw_of(record(id))); }
    /// The same, of the triangle's own draw.
    [[nodiscard]] std::uint32_t triangle_of(std::uint32_t id, const Draw& draw) const {
        return static_cast<std::uint32_t>((submission_of(id) - draw.triangle_base) >> (draw.quads() ? 1 : 0));
    }
    /// The point of a triangle at a pixel's centre, or beside it as interpolate.hpp has it. Only if `numbered`.
    [[nodiscard]] TrianglePoint point_at(std::uint32_t id, int x_px, int y_px) const;
    /// True only if no triangle touches the tile.
    [[nodiscard]] bool tile_is_empty(int tile) const;
    /// Records of a chunk that may cover something of a tile, in submission order. scratch: may hold the result.
    [[nodiscard]] std::span<const std::uint32_t> tile_list(std::size_t chunk, int tile, std::vector<std::uint32_t>& scratch) const;

    /// True if a drawn triangle reads the group of kVertexGroup records.
    [[nodiscard]] bool group_is_drawn(std::int64_t group) const { return has_only_used_vertices() || groups_drawn_.data()[group] != 0; }
    /// True if the view was made in batches and has only the vertices that its triangles use. Chunks have copies of their own then.
    [[nodiscard]] bool has_only_used_vertices() const { return batches_.size() > 1; }
    /// The mesh's vertex for each of the view's; only if has_only_used_vertices().
    [[nodiscard]] const std::uint32_t* mesh_vertices() const { return mesh_vertices_.data(); }
    /// Equal for corners of triangles of one draw that are the same vertex. Those that clipping made are numbered by chunk.
    [[nodiscard]] std::uint32_t corner_of_draw(std::uint32_t vertex) const {
        return has_only_used_vertices() && vertex < kClipVertex ? mesh_vertices_.data()[vertex] : vertex;
    }
    [[nodiscard]] std::uint64_t triangles_drawn() const;
    [[nodiscard]] std::uint64_t triangles_not_finite() const;

private:
    void list_draws(Executor& executor);
    void divide_into_chunks();
    void divide_into_batches();
    void cull_clusters(Executor& executor);
    void transform(const Batch& batch, const RasterKernels& kernels, Executor& executor);
    void bin(const Batch& batch, const RasterKernels& kernels, Executor& executor);
    /// Drops triangles of the first chunks that no sample of the view shows.
    void drop_hidden(std::size_t chunks, const RasterKernels& kernels, Executor& executor);
    /// Bytes of the lists of chunks, without what vectors hold in reserve, and of the vertex records that are made of them: the same for
    /// each number of threads.
    [[nodiscard]] std::size_t bytes_of_chunks(std::size_t first, std::size_t end) const;
    Result<void> number_used_vertices(Executor& executor);
    Result<void> list_sources();

    const PreparedData* scene_ = nullptr;
    SceneRevision revision_;
    View view_;
    bool numbered_ = false;
    const OcclusionGrid* occlusion_ = nullptr;  ///< while occlude() runs
    std::uint64_t version_ = 0;
    Times times_ms_;

    std::vector<Draw> draws_;
    bool has_mode_[3] = {}, few_vertices_ = false;
    int one_material_ = -1;
    std::int64_t vertex_count_ = 0, group_count_ = 0, cluster_count_ = 0, triangle_count_ = 0;
    RawBuffer<std::uint8_t> seen_;  ///< per instance; scratch
    RawBuffer<std::uint8_t> groups_seen_, groups_drawn_;
    RawBuffer<ScreenVertex> screen_;  ///< of the view, or of one batch at a time
    RawBuffer<std::uint8_t> outcodes_;
    std::vector<Batch> batches_;
    RawBuffer<ScreenVertex> used_screen_;
    RawBuffer<std::uint32_t> mesh_vertices_;
    std::vector<std::unique_ptr<Chunk>> chunks_;
    std::size_t chunk_count_ = 0;
    int local_bits_ = 0;
    std::vector<TriangleSource> sources_;
};

}  // namespace halflit::raster
