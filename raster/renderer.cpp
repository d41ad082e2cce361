#include "halflit/renderer.hpp"

#include "raster/check_execution.hpp"
#include "raster/detail/guarded.hpp"
#include "raster/detail/stopwatch.hpp"
#include "raster/passes/shading_rate.hpp"
#include "raster/renderer_impl.hpp"

#include <mutex>
#include <string>

namespace halflit {

using namespace raster;

namespace {

void add_counts(const ViewGeometry& geometry, const TileCounts& tiles, RenderReport& report) {
    report.triangles_submitted = geometry.scene().triangle_count();
    report.triangles_drawn = geometry.triangles_drawn();
    report.triangles_not_finite = geometry.triangles_not_finite();
    report.pixels_visible = tiles.pixels_visible;
    report.fragments_shaded = tiles.fragments_shaded;
    report.nan_pixels = tiles.nan_pixels;
    report.work += tiles.work;
    if (report.triangles_not_finite > 0)
        report.warnings.push_back(std::to_string(report.triangles_not_finite) + " triangles dropped: a vertex is NaN or infinite");
    if (report.nan_pixels > 0)
        report.warnings.push_back(std::to_string(report.nan_pixels) + " fragments came out as NaN and were written as 0");
}

/// Checks all arguments but the scene. Returns the instruction set to use.
Result<Isa> check_call(const Settings& settings, const Target& target, const Execution& execution) {
    const auto isa = check_execution(execution);
    if (!isa) return isa;
    if (auto ok = check_settings(settings, target.width, target.height); !ok) return tl::unexpected<Error>(ok.error());
    if (auto ok = check_target(target, settings.region); !ok) return tl::unexpected<Error>(ok.error());
    return isa;
}

}  // namespace

Result<void> Renderer::Impl::make_plan(const PreparedData& scene, const Lighting& light, const Camera& camera, const Settings& settings,
                                       const Target& target, int tile_size) {
    PlanKey key{scene.revision(), camera, settings, target.width, target.height, tile_size};
    if (plan_key && *plan_key == key && plan_light == light) return {};
    plan_key.reset();
    auto made = plan_frame(scene, light, camera, settings, target.width, target.height, tile_size, plan_memory);
    if (!made) return tl::unexpected<Error>(made.error());
    plan = std::move(*made);
    plan_key = std::move(key);
    plan_light = light;
    return {};
}

void Renderer::Impl::make_surface(const PreparedData& scene, const RasterKernels& kernels, bool of_materials) {
    ShadingSettings options = plan.options;
    options.rate = ShadingRate::pixel;
    surface_materials.assign(scene.drawn_materials().size(), {});
    for (std::size_t i = 0; i < surface_materials.size(); ++i) {
        shading::MaterialPlan& material = surface_materials[i];
        if (of_materials)
            material =
                shading::plan_material(scene.material(i), scene.scene().textures, scene.available_slots()[i], {.lights = true}, options);
        material.slots |= shading::kBaseSlots;
        material.double_sided = scene.material(i).double_sided;
    }
    surface.make(geometry, surface_materials, kernels, executor);
}

TileCounts Renderer::Impl::draw_behind(const PicturePass& pass, const Settings& settings, const Execution& execution) {
    const Target target = behind.target(plan.picture, executor.stop());
    LayerBudget layers(settings, plan.picture.region.width, plan.picture.region.height);  // of its own: it is a picture, too
    PicturePass all = {pass.view, plan, Output(target, plan.picture.region), pass.reference, nullptr, plan.picture.region, layers};
    all.view.behind = true;
    Execution watched;
    if (execution.progress) watched.progress = [&](double done) { execution.progress(0.5 * done); };
    const TileCounts tiles = draw_tiles(all, watched, 0.0);
    plan.shading.behind = behind.make(plan.picture, plan.exposure, executor);
    return tiles;
}

TileCounts Renderer::Impl::draw_tiles(const PicturePass& pass, const Execution& execution, double begun) {
    std::mutex counting;
    TileCounts sum;
    int done = 0;
    const int count = plan.picture.tile_count();
    executor.run(count, [&](int tile) {
        const TileRect rect = intersection(plan.picture.tile_rect(tile), pass.written);
        TileCounts counts;
        if (rect.width > 0 && rect.height > 0) {
            Pool<TileScratch>::Loan loan(scratch);
            counts = PictureTile(pass, tile, *loan).draw();
            if (execution.on_tile) execution.on_tile({rect.x, rect.y, rect.width, rect.height});
        } else if (pass.eye_dome != nullptr) {
            Pool<TileScratch>::Loan loan(scratch);
            PictureTile(pass, tile, *loan).keep_depths();
        }
        const std::lock_guard lock(counting);
        sum += counts;
        ++done;
        if (execution.progress) execution.progress(begun + (1.0 - begun) * done / count);
    });
    return sum;
}

Result<RenderReport> Renderer::Impl::render(const PreparedData& scene, const Lighting& light, const Camera& camera,
                                            const Settings& settings, const Target& target, const Execution& execution, Isa isa,
                                            RenderReport report, const PixelMask* only) {
    Stopwatch watch, begun;
    const std::uint64_t allowed = scene.scene().frame_work, samples = static_cast<std::uint64_t>(settings.samples);
    constexpr std::uint64_t kWorkOfSample = 256;  // surfaces behind each other, lights
    const WorkLimit work(allowed == 0 ? 0
                                      : allowed + kWorkOfSample * samples * static_cast<std::uint64_t>(target.width) *
                                                      static_cast<std::uint64_t>(target.height));
    executor.configure(execution);
    plan_memory.stop = &executor.stop();
    plan_memory.for_each_row = [this](int count, const std::function<void(int)>& body) { executor.run(count, body); };
    const RasterKernels& raster = raster_kernels(isa);
    plan_memory.kernels = &raster;
    if (auto ok = make_plan(scene, light, camera, settings, target, execution.tile_size); !ok) return tl::unexpected<Error>(ok.error());
    const shading::ShadeKernels& shade = shading::shade_kernels(isa);
    const bool by_reference = plan.options.accuracy == Accuracy::reference;
    const bool shades = target.pixels != nullptr || target.linear != nullptr;
    if (by_reference && shades)
        if (auto ok = reference.build(scene, light, plan.shading, plan.options); !ok) return tl::unexpected<Error>(ok.error());
    report.ms.plan = watch.lap();

    if (shades)
        if (auto ok = shadow_maps.draw(scene, plan, *plan_memory.shadow_texels, raster, shade, executor); !ok)
            return tl::unexpected<Error>(ok.error());
    report.ms.shadows = watch.lap();

    const Output output(target, plan.written, settings.alpha == AlphaSpace::display && !(plan.background_linear.w > 0.0f));
    if (auto ok = geometry.make(scene, plan.picture, raster, executor, output.has_triangle() || !scene.coplanar().empty()); !ok)
        return tl::unexpected<Error>(ok.error());
    report.ms.cull = geometry.times_ms().cull;
    report.ms.transform = geometry.times_ms().transform;
    report.ms.bin = geometry.times_ms().bin;
    watch.lap();

    records.make(geometry, plan.shading.materials, raster, executor);
    if (shades && plan.options.rate == ShadingRate::gouraud) report.work = light_vertices(geometry, records, plan.shading, shade, executor);
    if (output.has_surface()) make_surface(scene, raster, output.has_material());
    report.ms.transform += watch.lap();

    const TilePass surface_pass{geometry, surface, surface_materials, raster, shade, executor.stop()};
    LayerBudget layers(settings, target.width, target.height);
    const bool has_dome = shades && plan.eye_dome.strength > 0.0f && only == nullptr;
    if (has_dome) eye_dome.begin(plan, executor);
    const bool has_splats = splats.begin(scene, plan, executor);
    const PicturePass pass{{geometry, records, plan.shading.materials, raster, shade, executor.stop(), plan.shading.shadow_offset},
                           plan,
                           output,
                           by_reference ? &reference : nullptr,
                           output.has_surface() ? &surface_pass : nullptr,
                           plan.written,
                           layers,
                           has_dome ? &eye_dome : nullptr,
                           has_splats ? &splats : nullptr,
                           only};
    TileCounts behind_counts;
    if (shades && plan.looks_through) behind_counts = draw_behind(pass, settings, execution);
    const bool has_lines = shades && settings.edges != EdgeChoice::none && only == nullptr;
    Execution watched = execution;
    if (has_dome || has_lines || has_splats) watched.on_tile = {};  // told when the picture is done
    TileCounts tiles = draw_tiles(pass, watched, shades && plan.looks_through ? 0.5 : 0.0);
    tiles.work += behind_counts.work, tiles.fragments_shaded += behind_counts.fragments_shaded;
    tiles.layers_seen += behind_counts.layers_seen;
    if (has_dome) eye_dome.shade(plan, output, executor);
    SplatPicture::Drawn splats_drawn;
    if (has_splats) splats_drawn = splats.draw(scene, plan, output, raster, target.width, target.height, executor);
    if (has_lines) {
        const Execution rest = with_time_left(execution, begun.lap() / 1000.0);
        if (auto ok = draw_edges(scene, plan.camera, settings, output, target.edges, target.width, target.height, rest, isa); !ok)
            return tl::unexpected<Error>(ok.error());
    }
    if ((has_dome || has_lines || has_splats) && execution.on_tile)
        for (int tile = 0; tile < plan.picture.tile_count(); ++tile)
            if (const TileRect r = intersection(plan.picture.tile_rect(tile), pass.written); r.width > 0 && r.height > 0)
                execution.on_tile({r.x, r.y, r.width, r.height});
    report.ms.tiles = watch.lap();

    report.threads = executor.threads();
    report.isa = isa;
    report.environment = plan.environment_uses;
    report.error = plan.shading.error;
    if (plan.splat_codes > 0.0) {
        // What was left out is known now, and that the exact picture leaves out some too.
        const double less = plan.splat_codes + kExactSplatCodes - splats_drawn.left_out,
                     rounding = 2.0 * splats_drawn.rounding;  // of both pictures
        report.error.left_out -= less, report.error.rounding += rounding, report.error.codes += rounding - less;
    }
    report.warnings.insert(report.warnings.end(), plan.warnings.begin(), plan.warnings.end());
    add_counts(geometry, tiles, report);
    report.pixels_visible += splats_drawn.pixels;
    // An empty region is common; an empty whole picture is rarely intended.
    const Region& drawn = plan.written;
    if (has_splats) return report;
    const bool whole_picture = drawn.width == target.width && drawn.height == target.height;
    if (report.triangles_submitted == 0)
        report.warnings.emplace_back("nothing to draw");
    else if (whole_picture && report.pixels_visible == 0 && report.fragments_shaded > 0 && tiles.layers_seen == 0)
        report.warnings.emplace_back("nothing to draw: the alpha of all that is in view is 0");
    else if (whole_picture && report.pixels_visible == 0 && report.fragments_shaded == 0)
        report.warnings.emplace_back("nothing to draw: all triangles face away, lie outside of the view, or cover no sample");
    return report;
}

Result<RenderReport> Renderer::Impl::render_within_memory(std::unique_ptr<Impl>& impl, const PreparedData& scene, const Lighting& light,
                                                          const Camera& camera, const Settings& settings, const Target& target,
                                                          const Execution& execution, Isa isa, const RenderReport& report) {
    const std::size_t held = impl->executor.stop().memory();
    if (execution.memory_limit > 0 && held > execution.memory_limit) impl = std::make_unique<Impl>();
    try {
        return impl->render(scene, light, camera, settings, target, execution, isa, report);
    } catch (const MemoryStopped&) {
        impl = std::make_unique<Impl>();
        if (held == 0) throw;
    }
    return impl->render(scene, light, camera, settings, target, execution, isa, report);
}

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::forget_frames() {
    impl_->plan_key.reset();
    impl_->plan_memory.light_distances.clear();
    impl_->plan_memory.covers.revision.reset();
    impl_->plan_memory.sky_grid.revision.reset();
    impl_->plan_memory.contact_map.revision.reset();
    impl_->shadow_maps.forget();
    impl_->geometry.forget();
    impl_->records.changed();
    impl_->surface.changed();
}

namespace {

template <class Body>
Result<RenderReport> timed(const Execution& execution, const Body& body) {
    return guarded("rendering", execution, [&] {
        Stopwatch total;
        Result<RenderReport> report = body();
        if (report) report->total_ms = total.lap();
        return report;
    });
}

}  // namespace

Result<RenderReport> Renderer::render(const PreparedScene& scene, const Lighting& light, const Camera& camera, const Settings& settings,
                                      const Target& target, const Execution& execution) {
    return timed(execution, [&]() -> Result<RenderReport> {
        const auto isa = check_call(settings, target, execution);
        if (!isa) return tl::unexpected<Error>(isa.error());
        return Impl::render_within_memory(impl_, scene.data(), light, camera, settings, target, execution, *isa, {});
    });
}

Result<RenderReport> Renderer::render(const PreparedScene& scene, const Camera& camera, const Settings& settings, const Target& target,
                                      const Execution& execution) {
    return render(scene, scene.scene(), camera, settings, target, execution);
}

Result<RenderReport> Renderer::render(const Scene& scene, const Lighting& light, const Camera& camera, const Settings& settings,
                                      const Target& target, const Execution& execution) {
    return timed(execution, [&]() -> Result<RenderReport> {
        Stopwatch watch;
        RenderReport report;
        const auto isa = check_call(settings, target, execution);
        if (!isa) return tl::unexpected<Error>(isa.error());
        const auto prepared = PreparedData::make(scene, execution);
        if (!prepared) return tl::unexpected<Error>(prepared.error());
        report.ms.prepare = watch.lap();
        const Execution rest = with_time_left(execution, report.ms.prepare / 1000.0);
        return Impl::render_within_memory(impl_, *prepared, light, camera, settings, target, rest, *isa, report);
    });
}

Result<RenderReport> Renderer::render(const Scene& scene, const Camera& camera, const Settings& settings, const Target& target,
                                      const Execution& execution) {
    return render(scene, scene, camera, settings, target, execution);
}

Result<RenderReport> render(const Scene& scene, const Lighting& light, const Camera& camera, const Settings& settings, const Target& target,
                            const Execution& execution) {
    return guarded("rendering", execution, [&] { return Renderer().render(scene, light, camera, settings, target, execution); });
}

Result<RenderReport> render(const Scene& scene, const Camera& camera, const Settings& settings, const Target& target,
                            const Execution& execution) {
    return render(scene, scene, camera, settings, target, execution);
}

}  // namespace halflit
