#include "halflit/renderer.hpp"

#include "raster/check_execution.hpp"
#include "raster/detail/guarded.hpp"
#include "raster/detail/stopwatch.hpp"
#include "raster/frame_plan.hpp"
#include "raster/passes/behind.hpp"
#include "raster/passes/picture_tile.hpp"
#include "raster/passes/shading_rate.hpp"
#include "raster/passes/shadow_maps.hpp"
#include "raster/quality.hpp"

#include <algorithm>
#include <mutex>
#include <optional>
#include <set>
#include <string>

namespace halflit {

using namespace raster;

namespace {

/// Inputs of a plan.
struct PlanKey {
    SceneRevision scene;
    Camera camera;
    Settings settings;
    int width, height, tile_size;
    friend bool operator==(const PlanKey&, const PlanKey&) = default;
};

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

struct Renderer::Impl {
    Executor executor;
    FramePlanMemory plan_memory;
    std::optional<PlanKey> plan_key;
    Lighting plan_light;
    FramePlan plan;
    ShadowMaps shadow_maps;
    ViewGeometry geometry;
    VertexRecords records;
    /// For the planes of surfaces: shading needs their attributes of some materials only, and keeps light in their place at a rate below
    /// one a pixel.
    VertexRecords surface;
    std::vector<shading::MaterialPlan> surface_materials;
    ReferenceShading reference;
    Behind behind;
    Pool<TileScratch> scratch;

    Impl() { plan_memory.shadow_texels.emplace(); }

    Result<void> make_plan(const PreparedData& scene, const Lighting& light, const Camera& camera, const Settings& settings,
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

    /// of_materials: base colours and normal maps are read too, whatever light there is.
    void make_surface(const PreparedData& scene, const RasterKernels& kernels, bool of_materials) {
        ShadingSettings options = plan.options;
        options.rate = ShadingRate::pixel;
        surface_materials.assign(scene.drawn_materials().size(), {});
        for (std::size_t i = 0; i < surface_materials.size(); ++i) {
            shading::MaterialPlan& material = surface_materials[i];
            if (of_materials)
                material = shading::plan_material(scene.material(i), scene.scene().textures, scene.available_slots()[i], {.lights = true},
                                                  options);
            material.slots |= shading::kBaseSlots;
            material.double_sided = scene.material(i).double_sided;
        }
        surface.make(geometry, surface_materials, kernels, executor);
    }

    /// Draws what is seen through glass that blurs or bends light, the first half of the progress.
    TileCounts draw_behind(const PicturePass& pass, const Execution& execution) {
        const Target target = behind.target(plan.picture, executor.stop());
        PicturePass all = {pass.view, plan, Output(target, plan.picture.region), pass.reference, nullptr, plan.picture.region};
        all.view.behind = true;
        Execution watched;
        if (execution.progress) watched.progress = [&](double done) { execution.progress(0.5 * done); };
        const TileCounts tiles = draw_tiles(all, watched, 0.0);
        plan.shading.behind = behind.make(plan.picture, plan.exposure, executor);
        return tiles;
    }

    /// begun: the progress before.
    TileCounts draw_tiles(const PicturePass& pass, const Execution& execution, double begun) {
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
            }
            const std::lock_guard lock(counting);
            sum += counts;
            ++done;
            if (execution.progress) execution.progress(begun + (1.0 - begun) * done / count);
        });
        return sum;
    }

    Result<RenderReport> render(const PreparedData& scene, const Lighting& light, const Camera& camera, const Settings& settings,
                                const Target& target, const Execution& execution, Isa isa, RenderReport report,
                                const PixelMask* only = nullptr) {
        Stopwatch watch;
        executor.configure(execution);
        plan_memory.stop = &executor.stop();
        plan_memory.for_each_row = [this](int count, const std::function<void(int)>& body) { executor.run(count, body); };
        if (auto ok = make_plan(scene, light, camera, settings, target, execution.tile_size); !ok) return tl::unexpected<Error>(ok.error());
        const RasterKernels& raster = raster_kernels(isa);
        const shading::ShadeKernels& shade = shading::shade_kernels(isa);
        const bool by_reference = plan.options.accuracy == Accuracy::reference;
        if (by_reference)
            if (auto ok = reference.build(scene, light, plan.shading, plan.options); !ok) return tl::unexpected<Error>(ok.error());
        report.ms.plan = watch.lap();

        if (auto ok = shadow_maps.draw(scene, plan, *plan_memory.shadow_texels, raster, shade, executor); !ok)
            return tl::unexpected<Error>(ok.error());
        report.ms.shadows = watch.lap();

        if (auto ok = geometry.make(scene, plan.picture, raster, executor, target.triangle != nullptr); !ok)
            return tl::unexpected<Error>(ok.error());
        report.ms.cull = geometry.times_ms().cull;
        report.ms.transform = geometry.times_ms().transform;
        report.ms.bin = geometry.times_ms().bin;
        watch.lap();

        records.make(geometry, plan.shading.materials, raster, executor);
        if (plan.options.rate == ShadingRate::gouraud) report.work = light_vertices(geometry, records, plan.shading, shade, executor);
        const Output output(target, plan.written);
        if (output.has_surface()) make_surface(scene, raster, output.has_material());
        report.ms.transform += watch.lap();

        const TilePass surface_pass{geometry, surface, surface_materials, raster, shade, executor.stop()};
        const PicturePass pass{{geometry, records, plan.shading.materials, raster, shade, executor.stop(), plan.shading.shadow_offset},
                               plan,
                               output,
                               by_reference ? &reference : nullptr,
                               output.has_surface() ? &surface_pass : nullptr,
                               plan.written,
                               only};
        TileCounts behind_counts;
        if (plan.looks_through) behind_counts = draw_behind(pass, execution);
        TileCounts tiles = draw_tiles(pass, execution, plan.looks_through ? 0.5 : 0.0);
        tiles.work += behind_counts.work, tiles.fragments_shaded += behind_counts.fragments_shaded;
        report.ms.tiles = watch.lap();

        report.threads = executor.threads();
        report.isa = isa;
        report.environment = plan.environment_uses;
        report.error = plan.shading.error;
        report.warnings.insert(report.warnings.end(), plan.warnings.begin(), plan.warnings.end());
        add_counts(geometry, tiles, report);
        // An empty region is common; an empty whole picture is rarely intended.
        const Region& drawn = plan.written;
        const bool whole_picture = drawn.width == target.width && drawn.height == target.height;
        if (report.triangles_submitted == 0)
            report.warnings.emplace_back("nothing to draw");
        else if (whole_picture && report.pixels_visible == 0 && report.fragments_shaded == 0)
            report.warnings.emplace_back("nothing to draw: all triangles face away, lie outside of the view, or cover no sample");
        return report;
    }

    /// The same within Execution::memory_limit. What a renderer keeps of other frames may be more than the limit leaves: then it is
    /// replaced by a fresh one, so that only the frame itself decides.
    static Result<RenderReport> render_within_memory(std::unique_ptr<Impl>& impl, const PreparedData& scene, const Lighting& light,
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
};

namespace {

/// The finer of two results, setting by setting.
MeasuredShare more_careful(const MeasuredShare& a, const MeasuredShare& b) {
    MeasuredShare both = a;
    both.percent = std::min(a.percent, b.percent);
    both.probes = a.probes + b.probes, both.outside = a.outside + b.outside;
    both.samples = std::max(a.samples, b.samples);
    both.anisotropy = std::max(a.anisotropy, b.anisotropy);
    // 0 is the size in full quality.
    both.shadow_size = a.shadow_size == 0 || b.shadow_size == 0 ? 0 : std::max(a.shadow_size, b.shadow_size);
    return both;
}

}  // namespace

/// Measures what settings keep a share, by probes of one view.
class Renderer::Measuring {
public:
    Measuring(const PreparedData& scene, const Lighting& light, const Camera& camera, const ShareBudget& budget, int width, int height,
              Execution execution, Isa isa)
        : scene_(scene),
          light_(light),
          camera_(camera),
          budget_(budget),
          execution_(std::move(execution)),
          isa_(isa),
          width_(width),
          height_(height),
          probes_(choose_probes(width, height, camera)),
          mask_(width, height) {
        execution_.on_tile = {}, execution_.progress = {};
        execution_.memory_limit = (execution_.memory_limit + 1) / 2;  // two frames are kept
        for (const std::uint32_t at : probes_)
            mask_.add(static_cast<int>(at % static_cast<std::uint32_t>(width)), static_cast<int>(at / static_cast<std::uint32_t>(width)));
    }

    /// known: of other views; it is tried first. Null: there are none.
    Result<MeasuredShare> measure(Settings best, const MeasuredShare* known) {
        best.region = {};
        const Settings settings = known != nullptr ? with_share(best, *known) : best;
        if (known != nullptr && settings == best) return *known;
        if (auto ok = draw(full_, best, wanted_); !ok) return tl::unexpected<Error>(ok.error());
        if (full_.plan.looks_through) return result(best, 100.0, 0);  // what is behind glass is drawn as a whole: no probe is cheap
        if (known != nullptr) {
            const auto kept = keeps(settings);
            if (!kept) return tl::unexpected<Error>(kept.error());
            if (*kept) return result(settings, percent_, count_);
        }
        const std::vector<CheaperPart> parts = cheaper_parts(best, facts());
        std::vector<std::vector<bool>> outside;
        for (const CheaperPart& part : parts) {
            if (auto ok = compare(with_part(best, part)); !ok) return tl::unexpected<Error>(ok.error());
            outside.push_back(outside_);
        }
        int tried = 0;
        for (const Combination& one : combinations(best, parts, outside)) {
            if (shown(one.outside) < budget_.percent) continue;
            if (tried++ == kMostTried) break;
            const auto kept = keeps(one.settings);
            if (!kept) return tl::unexpected<Error>(kept.error());
            if (*kept) return result(one.settings, percent_, count_);
        }
        return result(best, 100.0, 0);
    }

private:
    static constexpr int kMostTried = 3;
    /// Any of 11 combinations, and what is known, may become the claim: together they are wrong with a probability of 5 %.
    static constexpr double kDoubt = 0.05 / 12;

    [[nodiscard]] double shown(int outside) const { return share_shown(static_cast<int>(probes_.size()), outside, kDoubt); }
    [[nodiscard]] MeasuredShare result(const Settings& settings, double percent, int outside) const {
        return {budget_,
                percent,
                static_cast<int>(probes_.size()),
                outside,
                settings.samples,
                settings.shading.anisotropy,
                settings.shadow_size};
    }
    [[nodiscard]] QualityFacts facts() const {
        QualityFacts facts;
        for (const shading::MaterialPlan& material : full_.plan.shading.materials)
            facts.textures |= (material.stages & kStageGradients) != 0;
        // A size that is set counts for all maps, so they must be of one size, and none of a light that has half of it.
        std::set<int> sides;
        for (const shading::ShadowMapPlan& map : full_.plan.shading.shadow_maps)
            sides.insert(map.kind == shading::ShadowMapPlan::Kind::cube ? 2 * map.size : map.size);
        const bool soft = std::any_of(full_.plan.shading.lights.begin(), full_.plan.shading.lights.end(),
                                      [](const shading::LightPlan& light) { return light.shadow_points > 1; });
        if (sides.size() == 1 && !soft && full_.plan.shading.sky.empty()) facts.shadow_size = *sides.begin();
        return facts;
    }
    /// Codes of the probes.
    Result<void> draw(Impl& by, const Settings& settings, std::vector<std::uint32_t>& codes) {
        std::uint32_t* const picture = picture_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
        const Target target{.width = width_, .height = height_, .pixels = reinterpret_cast<std::uint8_t*>(picture)};
        spent_s_ += watch_.lap() / 1000.0;
        auto report = by.render(scene_, light_, camera_, settings, target, with_time_left(execution_, spent_s_), isa_, {}, &mask_);
        if (!report) return tl::unexpected<Error>(report.error());
        codes.clear();
        for (const std::uint32_t at : probes_) codes.push_back(picture[at]);
        return {};
    }
    /// Sets the probes that the settings take outside.
    Result<void> compare(const Settings& settings) {
        std::vector<std::uint32_t> codes;
        if (auto ok = draw(cheaper_, settings, codes); !ok) return ok;
        outside_.resize(codes.size());
        for (std::size_t i = 0; i < codes.size(); ++i) outside_[i] = differs(codes[i], wanted_[i], budget_.codes);
        return {};
    }
    Result<bool> keeps(const Settings& settings) {
        if (auto ok = compare(settings); !ok) return tl::unexpected<Error>(ok.error());
        count_ = static_cast<int>(std::count(outside_.begin(), outside_.end(), true));
        percent_ = shown(count_);
        return percent_ >= budget_.percent;
    }

    Impl full_, cheaper_;
    Stopwatch watch_;
    double spent_s_ = 0;
    const PreparedData& scene_;
    const Lighting& light_;
    const Camera& camera_;
    const ShareBudget& budget_;
    Execution execution_;
    Isa isa_;
    int width_, height_;
    std::vector<std::uint32_t> probes_;
    PixelMask mask_;
    RawBuffer<std::uint32_t> picture_;
    std::vector<std::uint32_t> wanted_;
    std::vector<bool> outside_;
    double percent_ = 0;
    int count_ = 0;
};

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::forget_frames() {
    impl_->plan_key.reset();
    impl_->plan_memory.light_distances.clear();
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

Result<MeasuredShare> Renderer::measure(const PreparedScene& scene, const Lighting& light, const Camera& camera, const Settings& settings,
                                        const ShareBudget& budget, int width, int height, const MeasuredShare* known,
                                        const Execution& execution) {
    return guarded("measuring", execution, [&]() -> Result<MeasuredShare> {
        const auto isa = check_execution(execution);
        if (!isa) return tl::unexpected<Error>(isa.error());
        if (auto ok = check_settings(settings, width, height); !ok) return tl::unexpected<Error>(ok.error());
        if (!(budget.codes >= 0.0 && budget.codes <= 255.0))
            return fail(ErrorCode::usage, "codes: " + std::to_string(budget.codes) + ", expected a number from 0 to 255");
        if (!(budget.percent > 0.0 && budget.percent < 100.0))
            return fail(ErrorCode::usage, "percent: " + std::to_string(budget.percent) + ", expected a number above 0 and below 100");
        if (settings.shading.accuracy != Accuracy::exact || settings.shading.max_error_codes > 0.0)
            return fail(ErrorCode::usage, "measure: expected accuracy exact, and no error budget that is proven");
        if (known != nullptr) {
            if (known->asked.codes != budget.codes || known->asked.percent != budget.percent)
                return fail(ErrorCode::usage, "measure: what is known is of another budget");
            constexpr int kMostProbes = 1'000'000'000;
            if (known->probes < 1 || known->probes > kMostProbes || known->outside < 0 || known->outside > known->probes ||
                !(known->percent >= 0.0 && known->percent <= 100.0))
                return fail(ErrorCode::usage, "measure: what is known has impossible numbers");
            if (auto ok = check_settings(with_share(settings, *known), width, height); !ok) return tl::unexpected<Error>(ok.error());
        }
        auto found = Measuring(scene.data(), light, camera, budget, width, height, execution, *isa).measure(settings, known);
        if (found && known != nullptr) *found = more_careful(*known, *found);
        if (found && with_share(settings, *found) == settings) found->percent = 100.0;
        return found;
    });
}

Settings with_share(Settings settings, const MeasuredShare& measured) {
    settings.samples = measured.samples;
    settings.shading.anisotropy = measured.anisotropy;
    settings.shadow_size = measured.shadow_size;
    return settings;
}

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
