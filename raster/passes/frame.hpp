// Everything that one frame carries from stage to stage. Owned by the Renderer and reused, so that a steady frame allocates
// nothing.
#pragma once

#include "raster/view/background.hpp"
#include "raster/passes/light_culling.hpp"
#include "raster/passes/reference_shading.hpp"
#include "raster/framebuffer.hpp"
#include "raster/kernels/raster_kernels.hpp"
#include "raster/renderer.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/plan/plan.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace halflit::raster {

/// One instance of one mesh.
struct Draw {
    const Mesh* mesh = nullptr;
    int material = 0;                ///< index into ShadingPlan::materials
    std::int64_t vertex_base = 0;    ///< first vertex in the frame's arrays
    std::int64_t triangle_base = 0;  ///< first triangle in submission order
    std::int64_t record_base = 0;    ///< first float in the frame's vertex records
    int stride = 0;                  ///< floats a record
    bool mirrored = false, cull_back = true;
    bool mask = false, blend = false;
    Mat4 clip_from_object, world_from_object;
};

/// A vertex made by clipping: weights of the three vertices of the triangle that it came from.
struct ClipVertex {
    std::uint32_t parent[3];
    std::uint32_t draw;
    float weight[3];
};

/// A run of consecutive triangles in submission order: set up by one task, into its own lists.
struct Chunk {
    std::int64_t first = 0, end = 0;
    std::vector<TriangleRecord> records;
    std::vector<std::int64_t> submitted;  ///< submission index of each record; only when asked for
    std::vector<ScreenVertex> clip_screen;
    std::vector<ClipVertex> clip_vertices;
    std::vector<float> clip_records;        ///< kVertexFloats floats each
    std::vector<std::uint64_t> pairs;       ///< tile << 32 | record, in submission order; scratch
    std::vector<std::uint32_t> tile_begin;  ///< per tile: first entry of tile_list; one more at the end
    std::vector<std::uint32_t> tile_list;
    std::uint64_t not_finite = 0;
};

/// A buffer that is not initialised when it grows.
template <class T>
class RawBuffer {
public:
    T* reserve(std::size_t count) {
        if (count > capacity_) {
            data_.reset();
            data_ = std::make_unique_for_overwrite<T[]>(count);
            capacity_ = count;
        }
        return data_.get();
    }
    [[nodiscard]] T* data() { return data_.get(); }
    [[nodiscard]] const T* data() const { return data_.get(); }

private:
    std::unique_ptr<T[]> data_;
    std::size_t capacity_ = 0;
};

/// Vertices in groups: records are made only for groups that some drawn triangle touches.
inline constexpr int kVertexGroup = 64;

struct Frame {
    const Scene* scene = nullptr;
    const Settings* settings = nullptr;
    FramebufferView target;
    Region region;  ///< resolved: inside the picture, never empty
    int tile_size = 64, tiles_x = 0, tiles_y = 0;
    SamplePattern pattern;
    Viewport viewport;
    const RasterKernels* raster = nullptr;
    const shading::ShadeKernels* shade = nullptr;
    bool depth_only = false;      ///< for shadow maps: no light is planned, and back faces count whatever the materials say
    bool keep_submitted = false;  ///< fill Chunk::submitted

    shading::ShadingPlan plan;
    shading::EnvironmentPlans environment_plans;  ///< kept from frame to frame
    ReferenceShading reference;  ///< used with Accuracy::reference
    LightCuller lights;
    Background background;  ///< instead of Settings::background_linear
    std::vector<Draw> draws;
    std::vector<DrawRecords> draw_records;
    bool has_mask = false, has_blend = false;
    std::int64_t vertex_count = 0, triangle_count = 0, record_floats = 0;

    RawBuffer<ScreenVertex> screen;
    RawBuffer<std::uint8_t> outcodes;
    RawBuffer<float> records;
    RawBuffer<std::uint8_t> group_used;  ///< per kVertexGroup vertices

    std::vector<std::unique_ptr<Chunk>> chunks;
    std::size_t chunk_count = 0;  ///< in use
    int local_bits = 0;
    std::vector<TriangleSource> sources;
    std::vector<const float*> clip_records;

    [[nodiscard]] TriangleTable table() const { return {sources.data(), local_bits}; }
    [[nodiscard]] const TriangleRecord& record(std::uint32_t id) const {
        return sources[id >> local_bits].records[id & ((1u << local_bits) - 1u)];
    }
    [[nodiscard]] TileRect tile_rect(int tile) const {
        const int x = region.x + (tile % tiles_x) * tile_size, y = region.y + (tile / tiles_x) * tile_size;
        const int right = region.x + region.width, bottom = region.y + region.height;
        return {x, y, right - x < tile_size ? right - x : tile_size, bottom - y < tile_size ? bottom - y : tile_size};
    }
};

}  // namespace halflit::raster
