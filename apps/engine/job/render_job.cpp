#include "apps/engine/job/render_job.hpp"

#include "apps/engine/basics/timeout.hpp"
#include "apps/engine/job/job_steps.hpp"
#include "apps/engine/request/camera_file.hpp"
#include "apps/engine/request/request_check.hpp"
#include "apps/io/models/scaled_lengths.hpp"
#include "apps/io/platform/errno_text.hpp"
#include "apps/io/platform/process.hpp"
#include "halflit/image.hpp"
#include "raster/check_execution.hpp"
#include "raster/scene/framed_part.hpp"
#include "sh/vec3d.hpp"

#include <fmt/core.h>

#include <utility>

namespace halflit::engine {
namespace {

/// Of an importer's triangles.
constexpr const char* kCoarse = "triangles may be more than a quarter of a pixel off: ";

/// Loads the scene as fine as its view needs, as far as that can be known before. Another detail is tried where that is refused.
Result<void> load_source(RenderJob& job, ModelRequest& model, const ViewRequest& view) {
    const Stopwatch loading;
    const auto loaded = [&] { return model.keeper != nullptr ? model.keeper->load(model) : load_scene(model); };
    if (model.scene == "-" && model.input == nullptr) {
        auto bytes = read_standard_input(model.load.limits.max_file_bytes, model.load.limits.time_limit_s);
        if (!bytes) return tl::unexpected(bytes.error());
        model.input = std::make_shared<const std::vector<std::byte>>(std::move(*bytes));
    }
    if (!model.detail_given) model.load.detail_px = framed_detail(view);
    auto source = loaded();
    if (!source && source.error().code == ErrorCode::limit && !model.detail_given && model.load.detail_px > LoadOptions{}.detail_px) {
        job.warnings.push_back(std::string(kCoarse) + source.error().message);
        model.load.detail_px = LoadOptions{}.detail_px;
        model.detail_given = true;
        source = loaded();
    }
    if (!source) return tl::unexpected(source.error());
    job.load_ms = loading.ms();
    job.source = std::move(*source);
    job.warnings.insert(job.warnings.end(), job.source.warnings.begin(), job.source.warnings.end());
    return {};
}

/// Settings that no flag gives. suited: to the scene.
void settle_settings(Settings& settings, const SettingsRequest& given, const std::optional<KeptView>& kept, const Settings& suited) {
    settings.exposure = suited.exposure;
    settings.shading.emission_scale = suited.shading.emission_scale;
    if (suited.shadows == ShadowMode::off && !given.has_given("shadows")) settings.shadows = ShadowMode::off;
    Vec4f background = (given.one_of_many ? usual_settings() : suited).background_linear;
    if (kept) {
        const Vec3f color = to_float(kept->background);
        background = {color.x, color.y, color.z, 1.0f};
    }
    settings.background_linear = given.background_linear.value_or(background);
    if (kept && !given.has_given("point_size")) settings.point_size = static_cast<float>(kept->point_size);
}

/// Chooses size, camera, light and exposure: what is asked for, and choose_picture for the rest. Returns the settings that suit the scene.
Result<Settings> choose(RenderJob& job, const PictureRequest& request) {
    auto choice = choose_picture(*job.prepared, job.film.bounds, request);
    if (!choice && choice.error().code == ErrorCode::usage) return fail(choice.error().code, "--" + choice.error().message);
    if (!choice) return fail(choice.error().code, job.source.name + ": " + choice.error().message);
    job.width = choice->size.width, job.height = choice->size.height;
    if (const auto checked = check_size(choice->size, job.settings.region); !checked) return tl::unexpected(checked.error());
    if (job.settings.region.width == 0) job.settings.region = {0, 0, job.width, job.height};
    job.light = std::move(choice->light);
    for (Light& one : job.light.lights) soften(one, job.film);
    if (job.settings.background_environment && job.light.environment == nullptr)
        return fail(ErrorCode::usage, "--background: environment needs --env");
    job.camera = choice->camera;
    job.film.framed |= choice->framed;
    if (choice->framed) tell_view(job, choice->view, choice->view_reason);
    job.film.file_camera = choice->scene_camera;
    return choice->settings;
}

/// View and light of a scene that is prepared, and what follows from them. Requires: the flags' settings. same_light: that of the job.
Result<void> set_up(RenderJob& job, const RenderOptions& options, bool same_light) {
    job.settings.shadow_fade = io::scaled(job.settings.shadow_fade, job.source.placement.scale);
    if (!same_light)
        if (const auto begun = begin_light(job, options); !begun) return begun;
    const auto request = picture_request(job, options, options.film, options.asks_for_frame());
    if (!request) return tl::unexpected(request.error());
    const auto suited = choose(job, *request);
    if (!suited) return tl::unexpected(suited.error());
    settle_settings(job.settings, options, options.kept_view, *suited);
    return {};
}

/// Shows the parts that are asked for, cut and painted, with a ground. moves: by an animation; then its box is known at last.
Result<void> shape(RenderJob& job, const ContentRequest& content, bool moves) {
    replace_materials(job.scene(), content.classic);
    if (!content.own_lobes) drop_own_lobes(job.scene());
    if (const auto chosen = choose_parts(job, content.parts); !chosen) return chosen;
    if (moves) {
        const auto swept = swept_bounds(job);
        if (!swept) return tl::unexpected(swept.error());
        job.film.bounds = *swept;
    }
    if (!content.sections.empty()) {
        if (moves)
            return fail(ErrorCode::usage, "--section: cannot be combined with an animation that moves; --time draws one moment of it");
        if (const auto cut = cut_job(job, content); !cut) return cut;
    }
    paint_parts(job, content.parts);
    if (content.ground) add_ground(job.scene(), moves ? job.film.bounds : scene_bounds(job.scene()));
    return {};
}

/// options: settled; with their settings. model: what is loaded; its detail is chosen.
Result<RenderJob> make_job(const RenderOptions& options, const Settings& settings, ModelRequest model) {
    RenderJob job;
    job.settings = settings;
    job.execution = options.execution;
    job.timeout_s = options.timeout_s;
    if (const auto loaded = load_source(job, model, options); !loaded) return tl::unexpected(loaded.error());
    if (options.cameras) job.warnings.insert(job.warnings.end(), options.cameras->warnings.begin(), options.cameras->warnings.end());
    const bool may_be_finer = job.source.file && job.source.file->detail_px > 0 && !model.detail_given;
    const Bounds whole = may_be_finer ? scene_bounds(job.scene()) : Bounds{};
    job.pose_time_s = model.load.time_s;
    job.film.pose = {model.load.animation, options.own_lobes, !options.classic.any()};
    const AnimationInfo* const animation = job.animation();
    if (animation != nullptr)
        job.choices.push_back(fmt::format("pose: animation {}{}{}, at {} s of {}", job.source.animation,
                                          animation->name.empty() ? "" : ", ", animation->name, job.pose_time_s, animation->end_s));
    const bool moves = options.film.animates() && job.source.motion && animation != nullptr;
    if (const auto shaped = shape(job, options, moves); !shaped) return tl::unexpected(shaped.error());

    const Stopwatch preparing;
    auto prepared = PreparedScene::make(job.scene(), job.timed_execution());
    if (!prepared) return fail(prepared.error().code, job.source.name + ": " + prepared.error().message);
    job.prepared = std::move(*prepared);
    job.prepare_ms = preparing.ms();
    if (!moves) job.film.bounds = options.film.turntable > 0 ? raster::framed_bounds(job.scene()) : job.prepared->bounds();
    const bool loader_said_so = job.source.file && job.source.file->triangles_drawn == 0;
    if (job.film.bounds.empty && !loader_said_so)
        job.warnings.push_back("nothing to draw: nothing that can be seen has finite coordinates");
    if (const auto done = set_up(job, options, false); !done) return tl::unexpected(done.error());
    if (may_be_finer && !job.film.bounds.empty) {
        model.load.detail_px = seen_detail(job, length(to_double(whole.max) - to_double(whole.min)));
        model.detail_given = true;
        if (model.load.detail_px > job.source.file->detail_px) {
            auto again = make_job(options, settings, std::move(model));
            if (again || again.error().code != ErrorCode::limit) return again;
            job.warnings.push_back(std::string(kCoarse) + again.error().message);
        }
    }
    tell_choices(job, options);
    return job;
}

/// Reads and chooses what needs no scene. Returns the settings.
Result<Settings> settle(RenderOptions& options) {
    if (const auto settled = settle_cameras(options); !settled) return tl::unexpected(settled.error());
    if (const auto checked = check_view(options, options.film.views, options.settings.region); !checked)
        return tl::unexpected(checked.error());
    if (options.max_memory_bytes > 0)
        if (const int error = platform::limit_memory(options.max_memory_bytes); error != 0)
            return fail(ErrorCode::limit, std::string("--max-memory: the system does not set the limit: ") + platform::errno_text(error));
    if (!options.execution.isa) {
        const auto isa = default_isa();
        if (!isa) return fail(ErrorCode::usage, isa.error().message);
        options.execution.isa = *isa;
    }
    return checked_settings(options);
}

}  // namespace

Result<RenderJob> make_render_job(const RenderOptions& given) {
    return within_time(given.timeout_s, [&]() -> Result<RenderJob> {
        RenderOptions options = given;
        const auto settings = settle(options);
        if (!settings) return tl::unexpected(settings.error());
        ModelRequest model = options;
        model.load = options.timed_load();
        model.load.keep_animations = options.film.animates();
        return make_job(options, *settings, std::move(model));
    });
}

Result<RenderJob> make_measured_job(RenderOptions options) {
    options.load.exact_measures = true;
    return make_render_job(options);
}

void drop_own_lobes(Scene& scene) {
    for (Material& material : scene.materials) material.has_own_lobe = false;
}

Result<void> change_light(RenderJob& job, const LightRequest& light) {
    if (const auto begun = begin_light(job, light); !begun) return begun;
    PictureRequest request;
    static_cast<AutoOptions&>(request) = job.film.choice;
    request.size = PictureSize{job.width, job.height};
    request.camera = job.camera;
    const int file_camera = job.film.file_camera;
    const auto suited = choose(job, request);
    job.film.file_camera = file_camera;
    if (!suited) return tl::unexpected(suited.error());
    job.settings.exposure = suited->exposure;
    job.settings.shading.emission_scale = suited->shading.emission_scale;
    return {};
}

Result<void> change_job(RenderJob& job, RenderOptions options, bool same_light) {
    if (const auto settled = settle_cameras(options); !settled) return settled;
    const auto settings = checked_settings(options);
    if (!settings) return tl::unexpected(settings.error());
    job.settings = *settings;
    if (const auto done = set_up(job, options, same_light); !done) return done;
    job.choices.clear();
    tell_choices(job, options);
    return {};
}

Execution RenderJob::timed_execution() const {
    Execution out = execution;
    out.time_limit_s = timeout_s;
    return raster::with_time_left(std::move(out), started.ms() / 1000.0);
}

Image make_image(const RenderJob& job, bool linear) {
    const Region& region = job.settings.region;
    Image image = Image::make(region.width, region.height);
    if (linear) image.rgba_linear.resize(image.rgba8.size());
    return image;
}

Target target_of(const RenderJob& job, Image& image) {
    Target target = image.target();
    target.width = job.width, target.height = job.height;
    target.region_alone = true;
    return target;
}

}  // namespace halflit::engine
