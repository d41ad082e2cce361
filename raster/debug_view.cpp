#include "raster/debug_view.hpp"

#include "raster/detail/guarded.hpp"
#include "raster/frame_plan.hpp"
#include "raster/passes/tile.hpp"

namespace halflit::raster {

namespace {

Result<VisibilityView> draw_view(const Scene& scene, const Camera& camera, const Settings& settings, int width, int height) {
    const auto prepared = PreparedScene::make(scene, {settings.threads, settings.parallel_for});
    if (!prepared) return tl::unexpected<Error>(prepared.error());
    const auto plan = plan_frame(*prepared, camera, settings, width, height);
    if (!plan) return tl::unexpected<Error>(plan.error());
    const RasterKernels& raster = raster_kernels(*settings.isa);
    Executor executor;
    executor.configure(settings.threads, settings.parallel_for);
    ViewGeometry geometry;
    SubmissionNumbers numbers;
    if (auto ok = geometry.make(*prepared, plan->picture, raster, executor, &numbers); !ok) return tl::unexpected<Error>(ok.error());
    VertexRecords records;
    records.make(geometry, plan->shading.materials, raster, executor);

    VisibilityView view{width, height, {}, {}};
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    view.triangle.assign(pixels, 0);
    view.depth.assign(pixels, 0.0f);
    Pool<TileScratch> scratch;
    const TilePass pass{geometry, records, plan->shading.materials, raster, shading::shade_kernels(*settings.isa)};
    executor.run(plan->picture.tile_count(), [&](int tile) {
        Pool<TileScratch>::Loan loan(scratch);
        TileCounts ignored;
        draw_visibility(pass, tile, *loan, ignored);
        const TileRect rect = plan->picture.tile_rect(tile);
        for (int y = 0; y < rect.height; ++y) {
            for (int x = 0; x < rect.width; ++x) {
                const std::uint32_t id = loan->buffers.triangle[0][y * kTileStride + x];
                if (id == kNoTriangle) continue;
                const std::size_t at =
                    static_cast<std::size_t>(rect.y + y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(rect.x + x);
                const std::size_t chunk = geometry.chunk_of(id);
                view.triangle[at] = static_cast<std::uint32_t>(numbers[chunk][id - geometry.source(chunk).id_base] + 1);
                view.depth[at] = loan->buffers.depth[0][y * kTileStride + x];
            }
        }
    });
    return view;
}

}  // namespace

Result<VisibilityView> visibility(const Scene& scene, const Camera& camera, const Settings& settings, int width, int height) {
    return guarded("finding what is visible", [&] { return draw_view(scene, camera, settings, width, height); });
}

Result<std::vector<std::uint32_t>> triangle_ids(const Scene& scene, const Camera& camera, const Settings& settings, int width, int height) {
    auto view = visibility(scene, camera, settings, width, height);
    if (!view) return tl::unexpected<Error>(view.error());
    return std::move(view->triangle);
}

}  // namespace halflit::raster
