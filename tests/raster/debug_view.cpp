#include "tests/raster/debug_view.hpp"

#include "raster/check_execution.hpp"
#include "raster/detail/guarded.hpp"
#include "raster/frame_plan.hpp"
#include "raster/passes/tile.hpp"

namespace halflit::raster {

namespace {

Result<VisibilityView> draw_view(const Scene& scene, const Camera& camera, const Settings& settings, int width, int height,
                                 const Execution& execution) {
    const auto prepared = PreparedData::make(scene, execution);
    if (!prepared) return tl::unexpected<Error>(prepared.error());
    const auto plan = plan_frame(*prepared, scene, camera, settings, width, height, execution.tile_size);
    if (!plan) return tl::unexpected<Error>(plan.error());
    const auto isa = check_execution(execution);
    if (!isa) return tl::unexpected<Error>(isa.error());
    const RasterKernels& raster = raster_kernels(*isa);
    Executor executor;
    executor.configure(execution);
    ViewGeometry geometry;
    if (auto ok = geometry.make(*prepared, plan->picture, raster, executor, true); !ok) return tl::unexpected<Error>(ok.error());
    VertexRecords records;
    records.make(geometry, plan->shading.materials, raster, executor);

    VisibilityView view{width, height, {}, {}};
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    view.triangle.assign(pixels, 0);
    view.depth.assign(pixels, 0.0f);
    Pool<TileScratch> scratch;
    const TilePass pass{geometry, records, plan->shading.materials, raster, shading::shade_kernels(*isa), executor.stop()};
    executor.run(plan->picture.tile_count(), [&](int tile) {
        Pool<TileScratch>::Loan loan(scratch);
        TileCounts ignored;
        draw_visibility(pass, tile, *loan, ignored);
        const TileRect rect = plan->picture.tile_rect(tile);
        const TileRect asked = intersection(rect, plan->written);
        for (int y = asked.y - rect.y; y < asked.y - rect.y + asked.height; ++y) {
            for (int x = asked.x - rect.x; x < asked.x - rect.x + asked.width; ++x) {
                const std::uint32_t id = loan->buffers.triangle[0][y * kTileStride + x];
                if (id == kNoTriangle) continue;
                const std::size_t at =
                    static_cast<std::size_t>(rect.y + y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(rect.x + x);
                view.triangle[at] = static_cast<std::uint32_t>(geometry.submission_of(id) + 1);
                view.depth[at] = loan->buffers.depth[0][y * kTileStride + x];
            }
        }
    });
    return view;
}

}  // namespace

Result<VisibilityView> visibility(const Scene& scene, const Camera& camera, const Settings& settings, int width, int height,
                                  const Execution& execution) {
    return guarded("finding what is visible", execution, [&] { return draw_view(scene, camera, settings, width, height, execution); });
}

Result<std::vector<std::uint32_t>> triangle_ids(const Scene& scene, const Camera& camera, const Settings& settings, int width, int height,
                                                const Execution& execution) {
    auto view = visibility(scene, camera, settings, width, height, execution);
    if (!view) return tl::unexpected<Error>(view.error());
    return std::move(view->triangle);
}

}  // namespace halflit::raster
