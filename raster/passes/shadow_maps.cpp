#include "raster/passes/shadow_maps.hpp"

#include <algorithm>
#include <utility>

namespace halflit::raster {
namespace {

/// Geometry of more vertices is not kept for the next frame, because the picture needs as much memory afterwards; nor is that of batches.
constexpr std::int64_t kMostVerticesForNextFrame = std::int64_t{1} << 22;

void gather_wide(const float* distance, int size, float* out) {
    const int side = shading::wide_side(size);
    for (int j = 0; j < side; ++j) {
        const float* const row = distance + static_cast<std::ptrdiff_t>(shading::wide_texel(j, size)) * size;
        for (int i = 0; i < side; ++i) *out++ = row[shading::wide_texel(i, size)];
    }
}

}  // namespace

Result<void> ShadowMaps::draw_face(const PreparedData& scene, const FramePlan& plan, const ShadowView& face, float* texels,
                                   const RasterKernels& raster, const shading::ShadeKernels& shade, Executor& executor) {
    const auto size = static_cast<std::size_t>(face.view.region.width);
    float* distance = texels + face.first_texel;
    if (!face.sees_casters) {
        std::fill_n(distance, size * size, shading::kNoBlocker);
        if (face.penumbra) gather_wide(distance, face.view.region.width, texels + face.first_wide);
        return {};
    }
    ViewGeometry& geometry = work_->geometry;
    VertexRecords& records = work_->records;
    if (auto ok = geometry.make(scene, face.view, raster, executor); !ok) return ok;
    work_->is_large |= geometry.has_only_used_vertices() || geometry.vertex_count() > kMostVerticesForNextFrame;
    // Alpha tests read vertex records.
    const bool masks = geometry.has(AlphaMode::mask);
    if (masks) records.make(geometry, plan.casters, raster, executor);
    const TilePass pass{geometry, records, plan.casters, raster, shade, executor.stop(), false, true};
    const DepthRange range{face.near_z, face.far_z, face.perspective};
    executor.run(face.view.tile_count(), [&](int tile) {
        const TileRect rect = face.view.tile_rect(tile);
        float* out = distance + static_cast<std::size_t>(rect.y) * size + static_cast<std::size_t>(rect.x);
        if (geometry.tile_is_empty(tile)) {
            for (int y = 0; y < rect.height; ++y, out += size) std::fill_n(out, rect.width, shading::kNoBlocker);
            return;
        }
        Pool<TileScratch>::Loan scratch(scratch_);
        TileCounts ignored;
        draw_visibility(pass, tile, *scratch, ignored);
        for (int y = 0; y < rect.height; ++y, out += size)
            raster.distances(range, scratch->buffers.depth[0] + y * kTileStride, rect.width, out);
    });
    if (face.penumbra) gather_wide(distance, face.view.region.width, texels + face.first_wide);
    return {};
}

Result<void> ShadowMaps::draw(const PreparedData& scene, const FramePlan& plan, RawBuffer<float>& texels, const RasterKernels& raster,
                              const shading::ShadeKernels& shade, Executor& executor) {
    const SceneRevision& revision = scene.revision();
    Drawn before = std::exchange(drawn_, {});  // no map is valid until all are drawn
    if (before.capacity != texels.capacity() || before.geometry_revision != revision.geometry ||
        before.coverage_revision != revision.coverage || before.caster_detail != plan.options.texture_detail)
        before.views.clear();
    for (std::size_t i = 0; i < plan.shadow_views.size(); ++i) {
        const ShadowView& face = plan.shadow_views[i];
        if (i < before.views.size() && before.views[i] == face) continue;
        if (auto ok = draw_face(scene, plan, face, texels.data(), raster, shade, executor); !ok) return ok;
    }
    if (work_->is_large) work_ = std::make_unique<Workspace>();
    drawn_ = {texels.capacity(), revision.geometry, revision.coverage, plan.options.texture_detail, plan.shadow_views};
    return {};
}

}  // namespace halflit::raster
