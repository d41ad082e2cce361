#include "raster/renderer.hpp"

#include "raster/passes/binning.hpp"
#include "raster/passes/executor.hpp"
#include "raster/passes/fp_environment.hpp"
#include "raster/passes/geometry.hpp"
#include "raster/passes/shading_rate.hpp"
#include "raster/passes/tile_renderer.hpp"
#include "raster/passes/shadow_map.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <new>

namespace halflit::raster {
namespace {

class Stopwatch {
public:
    /// Milliseconds since the last call.
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
        last_ = now;
        return ms;
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Of the materials that something is drawn with, in the plan's order.
std::vector<EnvironmentUse> environment_uses(const Frame& frame) {
    enum : unsigned { kDiffuse = 1, kSpecular = 2 };
    std::vector<unsigned> uses(frame.plan.environments.size(), 0);
    for (const Draw& draw : frame.draws) {
        const shading::MaterialPlan& material = frame.plan.materials[static_cast<std::size_t>(draw.material)];
        if (material.environment >= 0) uses[static_cast<std::size_t>(material.environment)] |= kDiffuse;
        if (material.specular_environment >= 0) uses[static_cast<std::size_t>(material.specular_environment)] |= kSpecular;
    }
    std::vector<EnvironmentUse> out;
    for (std::size_t i = 0; i < uses.size(); ++i) {
        const shading::EnvironmentPlan& plan = frame.plan.environments[i];
        if (uses[i] != 0) out.push_back({plan.bands, plan.bound, plan.within, uses[i] == kSpecular});
    }
    return out;
}

/// Of the materials that light meets, each warning once.
void add_lobe_warnings(const Frame& frame, std::vector<std::string>& warnings) {
    const shading::PlanOptions& options = frame.settings->shading;
    const shading::Material without;
    for (const Draw& draw : frame.draws) {
        const auto index = static_cast<std::size_t>(draw.material);
        if ((frame.plan.materials[index].stages & (shading::kStageLights | shading::kStageEnvironment)) == 0) continue;
        const bool listed = index < frame.scene->materials.size();
        std::string warning = shading::lobe_warning(shading::lobe_of(listed ? frame.scene->materials[index] : without, options));
        if (!warning.empty() && std::find(warnings.begin(), warnings.end(), warning) == warnings.end())
            warnings.push_back(std::move(warning));
    }
}

}  // namespace

struct Renderer::Impl {
    Frame frame;
    Executor executor;
    Pool<TileScratch> scratch;
    ShadowMaps shadow_maps;

    Result<RenderReport> render(const Scene& scene, const Camera& camera, const Settings& asked, const FramebufferView& target) {
        const FpEnvironment environment;
        Settings settings = asked;
        if (settings.shading.accuracy == shading::Accuracy::reference) {
            // What the cheaper ways are measured against: light at every pixel, textures as their samplers say.
            settings.shading.rate = shading::ShadingRate::pixel;
            settings.shading.texture_detail = shading::TextureDetail::full;
            settings.shading.max_error_codes = 0.0;
        }
        Stopwatch total, watch;
        RenderReport report;
        if (auto ok = prepare_frame(frame, scene, camera, settings, target); !ok) return tl::unexpected<Error>(ok.error());
        executor.configure(settings.threads, settings.parallel_for);
        report.ms.plan = watch.lap();
        if (auto ok = shadow_maps.draw(scene, settings, executor, frame.plan); !ok) return tl::unexpected<Error>(ok.error());
        set_shadow_fades(frame);
        report.ms.shadows = watch.lap();
        transform_vertices(frame, executor);
        report.ms.transform = watch.lap();
        bin_triangles(frame, executor);
        report.ms.bin = watch.lap();
        make_vertex_records(frame, executor);
        if (settings.shading.rate == shading::ShadingRate::gouraud) report.work = light_vertices(frame, executor);
        make_clip_records(frame, executor);
        report.ms.transform += watch.lap();

        std::mutex counting;
        TileCounts sum;
        std::atomic<bool> stopped{false};
        executor.run(frame.tiles_x * frame.tiles_y, [&](int tile) {
            if (stopped.load(std::memory_order_relaxed)) return;
            if (settings.cancelled && (*settings.cancelled)()) {
                stopped = true;
                return;
            }
            typename Pool<TileScratch>::Loan loan(scratch);
            const TileCounts counts = TileRenderer(frame, tile, *loan).render();
            const std::lock_guard lock(counting);
            sum += counts;
        });
        if (stopped) return fail(ErrorCode::negative_result, "stopped on request");
        report.ms.tiles = watch.lap();

        report.threads = executor.threads();
        report.isa = *settings.isa;
        report.triangles_submitted = static_cast<std::uint64_t>(frame.triangle_count);
        for (std::size_t i = 0; i < frame.chunk_count; ++i) {
            report.triangles_drawn += frame.chunks[i]->records.size();
            report.triangles_not_finite += frame.chunks[i]->not_finite;
        }
        report.pixels_visible = sum.pixels_visible;
        report.fragments_shaded = sum.fragments_shaded;
        report.nan_pixels = sum.nan_pixels;
        report.work += sum.work;
        report.environment = environment_uses(frame);
        report.error = frame.plan.error;
        add_lobe_warnings(frame, report.warnings);
        if (std::string halved = shadow_maps.warning(); !halved.empty()) report.warnings.push_back(std::move(halved));
        if (report.triangles_not_finite > 0)
            report.warnings.push_back(std::to_string(report.triangles_not_finite) + " triangles dropped: a vertex is NaN or infinite");
        if (report.nan_pixels > 0)
            report.warnings.push_back(std::to_string(report.nan_pixels) + " fragments came out as NaN and were written as 0");
        // A part of a picture may well be empty; a whole one is rarely meant to be.
        const bool whole_picture = settings.region.width == 0;
        if (report.triangles_submitted == 0 || (whole_picture && report.triangles_drawn == 0)) report.warnings.emplace_back("nothing to draw");
        report.total_ms = total.lap();
        return report;
    }
};

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Result<RenderReport> Renderer::render(const Scene& scene, const Camera& camera, const Settings& settings, const FramebufferView& target) {
    try {
        return impl_->render(scene, camera, settings, target);
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::limit, "out of memory while rendering");
    } catch (const std::exception& e) {
        return fail(ErrorCode::internal, e.what());
    }
}

Result<RenderReport> render(const Scene& scene, const Camera& camera, const Settings& settings, const FramebufferView& target) {
    return Renderer().render(scene, camera, settings, target);
}

}  // namespace halflit::raster
