// The visibility pass: the triangle that each sample of a tile shows.
#include "raster/passes/count_work.hpp"
#include "raster/passes/tile.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

namespace halflit::raster {
namespace {

/// The least depth of a tile's samples; 0 if one of them shows nothing.
float farthest_depth(const TileRect& rect, int samples, const TileBuffers& buffers) {
    float least = 1.0f;
    for (int s = 0; s < samples; ++s)
        for (int y = 0; y < rect.height; ++y)
            for (int x = 0; x < rect.width; ++x) least = std::min(least, buffers.depth[s][y * kTileStride + x]);
    return least;
}

/// Opaque triangles of a tile on their way to the kernel, which sees them as one list although they come from many chunks: most chunks have
/// less than a hundred in a tile, and prefetching and side by side set-up need longer lists.
class OpaqueTriangles {
public:
    using Kernel = decltype(RasterKernels::rasterize);
    OpaqueTriangles(const ViewGeometry& geometry, Kernel rasterize, StopSignal& stop, const TileRect& rect, TileScratch& scratch)
        : geometry_(geometry), rasterize_(rasterize), stop_(stop), rect_(rect), scratch_(scratch) {}

    void add(const TriangleSource& source, std::span<const std::uint32_t> records) {
        if (farthest_ > 0.0f) return add_nearer(source, records);
        while (!records.empty()) {
            if (count_ == std::size(scratch_.opaque)) draw();
            const std::size_t n = std::min(records.size(), std::size(scratch_.opaque) - count_);
            for (std::size_t i = 0; i < n; ++i) scratch_.opaque[count_ + i] = source.id_base + records[i];
            count_ += n;
            records = records.subspan(n);
        }
    }
    void draw() {
        if (count_ == 0) return;
        stop_.check();
        charge();
        rasterize_(rect_, geometry_.view().samples, scratch_.buffers, geometry_.table(), scratch_.opaque, static_cast<int>(count_));
        since_look_ += count_;
        count_ = 0;
        if (since_look_ < kTrianglesBetweenLooks) return;
        since_look_ = 0;
        farthest_ = farthest_depth(rect_, geometry_.view().samples.count, scratch_.buffers);
    }

private:
    const ViewGeometry& geometry_;
    Kernel rasterize_;
    StopSignal& stop_;
    static constexpr std::size_t kTrianglesBetweenLooks = 4096, kCharged = 16;

    /// Work of the triangles on their way, by the part of the tile that every sixteenth one's box covers.
    void charge() const {
        constexpr std::uint64_t kUnitsATriangle = 10, kSamplesAUnit = 4;
        constexpr int kFraction = 8;  // bits of ScreenVertex
        const TriangleTable table = geometry_.table();
        std::uint64_t pixels = 0;
        for (std::size_t i = 0; i < count_; i += kCharged) {
            const TriangleSource& source = table.chunks[scratch_.opaque[i] >> table.local_bits];
            const std::uint32_t(&v)[3] = source.records[scratch_.opaque[i] - source.id_base].vertex;
            const ScreenVertex &a = vertex_of(source, v[0]), &b = vertex_of(source, v[1]), &c = vertex_of(source, v[2]);
            const auto length = [](std::int64_t low, std::int64_t high, std::int64_t first, std::int64_t size) {
                const std::int64_t from = std::max(low >> kFraction, first), to = std::min(high >> kFraction, first + size - 1);
                return static_cast<std::uint64_t>(std::max<std::int64_t>(0, to - from + 1));
            };
            pixels += length(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), rect_.x, rect_.width) *
                      length(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), rect_.y, rect_.height);
        }
        const auto samples = static_cast<std::uint64_t>(geometry_.view().samples.count);
        charge_work(kUnitsATriangle * count_ + kCharged * pixels * samples / kSamplesAUnit);
    }
    /// Those that are not behind all samples of the tile. A triangle's depths lie within those of its vertices.
    void add_nearer(const TriangleSource& source, std::span<const std::uint32_t> records) {
        for (const std::uint32_t record : records) {
            const std::uint32_t(&v)[3] = source.records[record].vertex;
            if (!(std::max({vertex_of(source, v[0]).z, vertex_of(source, v[1]).z, vertex_of(source, v[2]).z}) > farthest_)) continue;
            if (count_ == std::size(scratch_.opaque)) draw();
            scratch_.opaque[count_++] = source.id_base + record;
        }
    }

    const TileRect& rect_;
    TileScratch& scratch_;
    std::size_t count_ = 0, since_look_ = 0;
    float farthest_ = 0.0f;  ///< depth that all samples have at least
};

/// Adds a tile's opaque triangles of one chunk, and calls visit(record) for each other one, in submission order.
template <class Visit>
void add_list(OpaqueTriangles& opaque, const ViewGeometry& geometry, const TriangleSource& source, std::span<const std::uint32_t> list,
              bool all_opaque, const Visit& visit) {
    if (all_opaque) {
        opaque.add(source, list);
        return;
    }
    const auto is_opaque = [&](std::size_t i) { return geometry.draw_of(source.records[list[i]]).alpha_mode == AlphaMode::opaque; };
    for (std::size_t i = 0; i < list.size(); ++i) {
        std::size_t run = i;
        while (run < list.size() && is_opaque(run)) ++run;
        opaque.add(source, list.subspan(i, run - i));
        if (run < list.size()) visit(list[run]);
        i = run;
    }
}

void clear_tile(const TileRect& rect, int samples, bool depth_only, TileBuffers& buffers) {
    const std::size_t used = static_cast<std::size_t>(rect.height) * kTileStride;
    for (int s = 0; s < samples; ++s) {
        std::memset(buffers.depth[s], 0, used * sizeof(float));
        if (!depth_only) std::memset(buffers.triangle[s], 0xff, used * sizeof(std::uint32_t));
    }
}

bool is_all_opaque(const ViewGeometry& geometry) { return !geometry.has(AlphaMode::mask) && !geometry.has(AlphaMode::blend); }

/// True if the samples of a pixel may have different alpha: a texture gives it.
bool tests_samples(const TilePass& pass, const shading::MaterialPlan& material) {
    return pass.geometry.view().samples.count > 1 && (material.stages & kStageBaseColorTexture) != 0;
}

/// Takes the samples off the coverage plane that fail the alpha test, each at its own place in the texture: the edge of a mask is as smooth
/// as that of a triangle. True if some are left.
bool test_samples(const TilePass& pass, const shading::MaterialPlan& material, const TileRect& rect, const FragmentList& list,
                  TileScratch& scratch) {
    const SamplePattern& samples = pass.geometry.view().samples;
    const bool second = material.textures[TextureSlot::base_color].uv_set == 1;
    auto& lane = scratch.block.lane;
    float* const u = lane[second ? shading::kU1 : shading::kU0];
    float* const v = lane[second ? shading::kV1 : shading::kV0];
    const int steps = second ? shading::kDu1Dx : shading::kDu0Dx;
    float middle_u[shading::kBlockSize], middle_v[shading::kBlockSize];
    std::memcpy(middle_u, u, sizeof middle_u);
    std::memcpy(middle_v, v, sizeof middle_v);
    unsigned left = 0;
    constexpr std::uint64_t kUnitsASample = 8;
    charge_work(kUnitsASample * static_cast<std::uint64_t>(samples.count) * static_cast<std::uint64_t>(list.count));
    for (int s = 0; s < samples.count; ++s) {
        const float x = static_cast<float>(samples.x[s]) * (1.0f / 256.0f), y = static_cast<float>(samples.y[s]) * (1.0f / 256.0f);
        for (int l = 0; l < list.count; ++l) {
            u[l] = middle_u[l] + (x * lane[steps][l] + y * lane[steps + 2][l]);
            v[l] = middle_v[l] + (x * lane[steps + 1][l] + y * lane[steps + 3][l]);
        }
        pass.shade.alpha(material, scratch.block, list.count);
        for (int l = 0; l < list.count; ++l) {
            std::uint16_t& mask = scratch.buffers.coverage[(list.y_px[l] - rect.y) * kTileStride + (list.x_px[l] - rect.x)];
            if (!(scratch.block.alpha[l] >= material.alpha_cutoff)) mask = static_cast<std::uint16_t>(mask & ~(1u << s));
        }
    }
    for (int l = 0; l < list.count; ++l) left |= scratch.buffers.coverage[(list.y_px[l] - rect.y) * kTileStride + (list.x_px[l] - rect.x)];
    return left != 0;
}

}  // namespace

void interpolate(const TilePass& pass, FragmentList& list, shading::FragmentBlock& block, bool gradients) {
    const int last = list.count - 1, padded = (list.count + 15) & ~15;
    for (int l = list.count; l < padded; ++l) {
        list.id[l] = list.id[last];
        list.x_px[l] = list.x_px[last];
        list.y_px[l] = list.y_px[last];
    }
    const shading::MaterialPlan& material = pass.materials[static_cast<std::size_t>(list.material)];
    InterpolateArgs args{};
    args.triangles = pass.geometry.table();
    args.draws = pass.records.draws();
    args.clip_records = pass.records.clip_records();
    args.slots = material.slots;
    args.stride = 4 * __builtin_popcount(material.slots);
    args.gradients = gradients || (material.stages & kStageGradients) != 0;
    args.facing = material.double_sided;
    args.shadow_offset = pass.shadow_offset && (material.stages & (kStageLights | kStagePrelit)) == kStageLights;
    args.count = padded;
    args.ids = list.id;
    args.x_px = list.x_px;
    args.y_px = list.y_px;
    pass.raster.interpolate(args, block);
}

void clear_coverage(TileScratch& scratch, const CoverBox& box) {
    for (int y = box.y0; y <= box.y1; ++y)
        std::memset(scratch.buffers.coverage + y * kTileStride + box.x0, 0,
                    sizeof(scratch.buffers.coverage[0]) * static_cast<std::size_t>(box.x1 - box.x0 + 1));
}

bool test_mask(const TilePass& pass, const TileRect& rect, const CoverBox& box, std::size_t chunk, std::uint32_t record,
               TileScratch& scratch, TileCounts& counts) {
    bool any = false;
    collect_covered(pass, rect, box, chunk, record, scratch, [&](FragmentList& list) {
        const shading::MaterialPlan& material = pass.materials[static_cast<std::size_t>(list.material)];
        const bool of_samples = tests_samples(pass, material);
        interpolate(pass, list, scratch.block, of_samples);
        count_alpha_test(counts.work, material, list.count);
        if (of_samples) {
            any |= test_samples(pass, material, rect, list, scratch);
            return;
        }
        pass.shade.alpha(material, scratch.block, list.count);
        for (int l = 0; l < list.count; ++l) {
            if (scratch.block.alpha[l] >= material.alpha_cutoff)
                any = true;
            else
                scratch.buffers.coverage[(list.y_px[l] - rect.y) * kTileStride + (list.x_px[l] - rect.x)] = 0;
        }
    });
    return any;
}

void draw_visibility(const TilePass& pass, int tile, TileScratch& scratch, TileCounts& counts) {
    const ViewGeometry& geometry = pass.geometry;
    const TileRect rect = geometry.view().tile_rect(tile);
    clear_tile(rect, geometry.view().samples.count, pass.depth_only, scratch.buffers);
    const bool all_opaque = is_all_opaque(geometry);
    OpaqueTriangles opaque(geometry, pass.depth_only ? pass.raster.rasterize_depth : pass.raster.rasterize, pass.stop, rect, scratch);
    for (std::size_t c = 0; c < geometry.chunks().size(); ++c) {
        const TriangleSource& source = geometry.source(c);
        add_list(opaque, geometry, source, geometry.tile_list(c, tile, scratch.tile_list), all_opaque, [&](std::uint32_t record) {
            // Masked triangles are tested one by one, after the opaque ones before them.
            if (geometry.draw_of(source.records[record]).alpha_mode != AlphaMode::mask) return;
            opaque.draw();
            pass.stop.check();
            const CoverBox box = pass.raster.cover(rect, geometry.view().samples, scratch.buffers, source, record);
            if (test_mask(pass, rect, box, c, record, scratch, counts))
                pass.raster.draw_covered(rect, geometry.view().samples, scratch.buffers, source, record);
            clear_coverage(scratch, box);
        });
    }
    opaque.draw();
    if (geometry.has_coplanar() && !pass.depth_only) draw_coplanar(pass, tile, scratch, counts);
}

void draw_opaque(const ViewGeometry& geometry, const RasterKernels& kernels, StopSignal& stop, int tile, TileScratch& scratch) {
    const TileRect rect = geometry.view().tile_rect(tile);
    clear_tile(rect, geometry.view().samples.count, false, scratch.buffers);
    OpaqueTriangles opaque(geometry, kernels.rasterize, stop, rect, scratch);
    for (std::size_t c = 0; c < geometry.chunks().size(); ++c)
        add_list(opaque, geometry, geometry.source(c), geometry.tile_list(c, tile, scratch.tile_list), is_all_opaque(geometry),
                 [](std::uint32_t) {});
    opaque.draw();
}

}  // namespace halflit::raster
