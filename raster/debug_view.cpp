#include "raster/debug_view.hpp"

#include "raster/passes/binning.hpp"
#include "raster/passes/executor.hpp"
#include "raster/passes/fp_environment.hpp"
#include "raster/passes/geometry.hpp"
#include "raster/passes/tile_renderer.hpp"

namespace halflit::raster {

Result<shading::ShadingPlan> frame_plan(const Scene& scene, const Camera& camera, const Settings& settings, int width, int height) {
    const FpEnvironment environment;
    Frame frame;
    if (auto ok = prepare_frame(frame, scene, camera, settings, {width, height, nullptr, nullptr}); !ok)
        return tl::unexpected<Error>(ok.error());
    return std::move(frame.plan);
}

Result<VisibilityView> visibility(const Scene& scene, const Camera& camera, const Settings& settings, int width, int height) {
    const FpEnvironment environment;
    Frame frame;
    Executor executor;
    frame.keep_submitted = true;
    if (auto ok = prepare_frame(frame, scene, camera, settings, {width, height, nullptr, nullptr}); !ok)
        return tl::unexpected<Error>(ok.error());
    executor.configure(settings.threads, settings.parallel_for);
    transform_vertices(frame, executor);
    bin_triangles(frame, executor);
    make_vertex_records(frame, executor);
    make_clip_records(frame, executor);

    VisibilityView view{width, height, {}, {}};
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    view.triangle.assign(pixels, 0);
    view.depth.assign(pixels, 0.0f);
    Pool<TileScratch> scratch;
    executor.run(frame.tiles_x * frame.tiles_y, [&](int tile) {
        Pool<TileScratch>::Loan loan(scratch);
        TileRenderer(frame, tile, *loan).draw_visibility();
        const TileRect rect = frame.tile_rect(tile);
        for (int y = 0; y < rect.height; ++y) {
            for (int x = 0; x < rect.width; ++x) {
                const std::uint32_t id = loan->buffers.triangle[0][y * kTileStride + x];
                if (id == kNoTriangle) continue;
                const std::size_t at =
                    static_cast<std::size_t>(rect.y + y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(rect.x + x);
                const Chunk& chunk = *frame.chunks[id >> frame.local_bits];
                view.triangle[at] = static_cast<std::uint32_t>(chunk.submitted[id & ((1u << frame.local_bits) - 1u)] + 1);
                view.depth[at] = loan->buffers.depth[0][y * kTileStride + x];
            }
        }
    });
    return view;
}

Result<std::vector<std::uint32_t>> triangle_ids(const Scene& scene, const Camera& camera, const Settings& settings, int width, int height) {
    auto view = visibility(scene, camera, settings, width, height);
    if (!view) return tl::unexpected<Error>(view.error());
    return std::move(view->triangle);
}

}  // namespace halflit::raster
