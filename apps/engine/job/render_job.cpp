#include "apps/engine/job/render_job.hpp"

#include "apps/engine/basics/stopwatch.hpp"
#include "apps/engine/basics/timeout.hpp"
#include "apps/engine/job/film_view.hpp"
#include "apps/engine/job/import_detail.hpp"
#include "apps/engine/job/part_choice.hpp"
#include "apps/engine/job/section_cuts.hpp"
#include "apps/engine/request/camera_file.hpp"
#include "apps/engine/request/scene_view.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/models/scaled_lengths.hpp"
#include "apps/io/platform/errno_text.hpp"
#include "apps/io/platform/process.hpp"
#include "halflit/auto_setup.hpp"
#include "halflit/camera.hpp"
#include "halflit/image.hpp"
#include "halflit/scene.hpp"
#include "raster/check_execution.hpp"
#include "raster/choice/completed_light.hpp"
#include "raster/scene/prepared_data.hpp"
#include "sh/arc.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"
#include "shading/environment.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

namespace halflit::engine {
namespace {

Result<void> check_size(PictureSize size, const Region& region) {
    const bool whole = region.width == 0;
    if (const PictureSize drawn = whole ? size : PictureSize{region.width, region.height};
        std::int64_t{drawn.width} * drawn.height > kMaxImagePixels)
        return fail(ErrorCode::limit, fmt::format("{}: {}x{} is more than 2^28 pixels{}", whole ? "--size" : "--region", drawn.width,
                                                  drawn.height, whole ? "; --region draws a part" : ""));
    if (std::int64_t{region.x} + region.width > size.width || std::int64_t{region.y} + region.height > size.height)
        return fail(ErrorCode::usage, fmt::format("--region: expected a part of the {}x{} picture, found {},{},{},{}", size.width,
                                                  size.height, region.x, region.y, region.width, region.height));
    return {};
}

std::string_view reason_text(ViewReason reason) {
    switch (reason) {
        case ViewReason::flat:
            return ", as it is flat";
        case ViewReason::hollow:
            return ", as it is open at the top";
        case ViewReason::thin:
            return ", as it is upright and thin";
        case ViewReason::backs:
            return ", as the usual side shows backs alone";
        case ViewReason::usual:
        case ViewReason::given:
            break;
    }
    return "";
}

/// view: of the whole scene. replaces: the file has a camera that shows the scene small or not at all.
std::string camera_choice(const Camera* of_file, const RenderOptions& options, const ViewSettings& view, ViewReason reason, bool replaces) {
    if (of_file != nullptr) return "camera: the file's" + (of_file->name.empty() ? "" : ", " + of_file->name);
    if (options.cameras) {
        const CameraFile& file = *options.cameras;
        const bool all = options.camera == kAllCameras;
        const std::string& name = all ? "" : file.cameras[find_camera(file, options.camera.value_or("")).value_or(0)].name;
        return "camera: " + (all ? "all" : name.empty() ? "one" : io::printable(name)) + " of " + file.path;
    }
    if (options.camera_orbit) return "camera: in the orbit " + options.camera_orbit->text;
    if (options.camera_position)
        return fmt::format("camera: at {},{},{}", options.camera_position->x, options.camera_position->y, options.camera_position->z);
    if (!options.film.views.empty())
        return fmt::format("camera: the whole scene, {}, all sides at one scale", options.film.views.front().name);
    return fmt::format("camera: a view of the whole scene, azimuth {}, elevation {}{}{}", view.azimuth_deg, view.elevation_deg,
                       reason_text(reason), replaces ? "; the file's shows the scene small or not at all (--camera 0: by it)" : "");
}

std::string pose_choice(const AnimationInfo& animation, int index, double time_s) {
    return fmt::format("pose: animation {}{}{}, at {} s of {}", index, animation.name.empty() ? "" : ", ", animation.name, time_s,
                       animation.end_s);
}

/// Replaces the ambient light by the environment.
Result<void> add_environment(Lighting& light, const RenderOptions& options) {
    auto image = find_environment(options.environment);
    if (!image) return fail(image.error().code, "--env: " + image.error().message);
    const auto environment =
        make_environment(std::move(*image), {options.environment_sun, static_cast<double>(options.environment_rotate_deg) * (kPi / 180.0),
                                             options.settings.background_environment,
                                             options.may_want_reference || options.settings.shading.accuracy == Accuracy::reference});
    if (!environment) return tl::unexpected(environment.error());
    light.ambient = {};
    light.environment = *environment;
    return {};
}

/// Gives a light the size that the flags say, unless it has one.
void soften(Light& light, const Film& film) {
    if (light.shadow_radius > 0.0f) return;
    light.shadow_radius = kind_of(light.type).placed ? film.lamp_radius : film.sun_radius;
}

/// The light to begin with, and what the flags say of the rest.
Result<void> begin_light(RenderJob& job, const RenderOptions& options) {
    AutoOptions choice;
    Lighting light;
    if (options.scene_lights)
        light = job.scene();
    else
        choice.add_lights = !options.ambient_linear;
    if (!options.environment.empty())
        if (const auto added = add_environment(light, options); !added) return added;
    choice.ambient_linear = options.ambient_linear;
    choice.exposure = options.exposure;
    choice.exposure_compensation_ev = options.exposure_compensation_ev;
    choice.studio = options.studio;
    if (choice.studio == StudioUse::for_dark && !options.lights.empty()) choice.studio = StudioUse::under_lights;
    if (options.ambient_linear && options.studio == StudioUse::for_dark) choice.studio = StudioUse::never;
    choice.studio_turn_rad = static_cast<double>(options.environment_rotate_deg) * (kPi / 180.0);
    for (const GivenLight& given : options.lights) light.lights.push_back(given.light);
    Film& film = job.film;
    film.sun_radius = light.sun_shadow_radius_rad = static_cast<float>(static_cast<double>(options.sun_size_deg) * (kPi / 180.0));
    film.lamp_radius = options.lamp_size;
    for (Light& one : light.lights) soften(one, film);
    choice.light = std::move(light);
    film.choice = std::move(choice);
    return {};
}

/// Keeps what was chosen for people to read, and warns where the usual side shows nothing.
void tell_view(RenderJob& job, const ViewSettings& drawn, ViewReason reason) {
    job.film.view = drawn, job.film.reason = reason;
    if (reason != ViewReason::backs) return;
    job.warnings.push_back(fmt::format("from the usual side only backs are seen, which are not drawn; seen from {:g},{:g}",
                                       drawn.azimuth_deg, drawn.elevation_deg));
}

/// Warns of what a view of the whole leaves out. Grounds are not named: they are seen to be cut off.
void warn_of_left_out(RenderJob& job) {
    constexpr std::size_t kMostNamed = 5;
    const NameOfInstance name_of = names_of(job.source.parts);
    std::vector<std::string> named;
    std::set<std::pair<int, raster::LeftOutFor>> noted;
    const raster::FramedPart& framed = job.prepared->data().framed_part();
    const auto is_told = [](raster::LeftOutFor reason) { return reason == raster::LeftOutFor::far || reason == raster::LeftOutFor::shell; };
    const auto part_of = [&](int instance) { return job.source.parts->of_instance(static_cast<std::size_t>(instance)); };
    std::set<int> told, seen;  // parts; those of them of which a piece is framed
    for (const raster::LeftOut& one : framed.left_out)
        if (is_told(one.reason)) told.insert(part_of(one.instance));
    if (told.empty()) return;
    for (const int instance : framed.instances)
        if (told.count(part_of(instance)) > 0) seen.insert(part_of(instance));
    for (const auto& [instance, reason, partly] : framed.left_out) {
        if (!is_told(reason)) continue;
        const int part = part_of(instance);
        if (part >= 0 && !noted.emplace(part, reason).second) continue;
        const std::string name = name_of(static_cast<std::size_t>(instance));
        named.push_back(fmt::format("{}{}, {}", partly || seen.count(part) > 0 ? "a piece of " : "",
                                    name.empty() ? fmt::format("part {}", part + 1) : "'" + io::printable(name) + "'",
                                    reason == raster::LeftOutFor::far ? "far from all else" : "around all else"));
    }
    if (named.empty()) return;
    std::string list;
    for (std::size_t i = 0; i < std::min(named.size(), kMostNamed); ++i) list += (i == 0 ? "" : "; ") + named[i];
    if (named.size() > kMostNamed) list += fmt::format("; and {} more", named.size() - kMostNamed);
    std::string warning = "the view of the whole leaves out: " + list;
    if (std::find(job.warnings.begin(), job.warnings.end(), warning) == job.warnings.end()) job.warnings.push_back(std::move(warning));
}

/// Chooses size, camera, light and exposure: what the flags say, and choose_picture for the rest.
Result<void> choose(RenderJob& job, const RenderOptions& options, PictureRequest request) {
    static_cast<AutoOptions&>(request) = [&] {
        AutoOptions all = job.film.choice;
        all.camera = request.camera, all.frame = request.frame, all.view = options.view;
        return all;
    }();
    auto choice = choose_picture(*job.prepared, job.film.bounds, request);
    if (!choice && choice.error().code == ErrorCode::usage) return fail(choice.error().code, "--" + choice.error().message);
    if (!choice) return fail(choice.error().code, job.source.name + ": " + choice.error().message);
    job.width = choice->size.width, job.height = choice->size.height;
    if (const auto checked = check_size(choice->size, options.settings.region); !checked) return checked;
    job.light = std::move(choice->light);
    for (Light& one : job.light.lights) soften(one, job.film);
    if (options.settings.background_environment && job.light.environment == nullptr)
        return fail(ErrorCode::usage, "--background: environment needs --env");
    job.camera = choice->camera;
    job.film.framed |= choice->framed;
    if (choice->framed) tell_view(job, choice->view, choice->view_reason);
    job.film.file_camera = choice->scene_camera;
    job.settings.exposure = choice->settings.exposure;
    if (choice->settings.shadows == ShadowMode::off && !options.has_given("shadows")) job.settings.shadows = ShadowMode::off;
    job.settings.shading.emission_scale = choice->settings.shading.emission_scale;
    Vec4f background = (options.one_of_many ? usual_settings() : choice->settings).background_linear;
    if (options.kept_view) {
        const Vec3f kept = to_float(options.kept_view->background);
        background = {kept.x, kept.y, kept.z, 1.0f};
    }
    job.settings.background_linear = options.background_linear.value_or(background);
    if (options.kept_view && !options.has_given("point_size")) job.settings.point_size = static_cast<float>(options.kept_view->point_size);
    job.settings.region = options.settings.region.width > 0 ? options.settings.region : Region{0, 0, job.width, job.height};
    return {};
}

/// The cameras of --camera-file that are drawn: one, or all. The picture has the size of the first, unless --size says another.
Result<void> use_given_cameras(RenderJob& job, const RenderOptions& options, PictureRequest& request) {
    const CameraFile& file = *options.cameras;
    const PictureSize usual = request.size.value_or(request.usual_size);
    const auto place = [&](GivenCamera camera) {
        if (camera.horizontal_fov && options.size) {
            const SinCos half = sin_cos(0.5 * static_cast<double>(camera.lens.fov_y_rad));
            const double across = half.sin / half.cos, up = across * usual.height / usual.width;
            camera.lens.sides =
                ViewSides{static_cast<float>(-across), static_cast<float>(across), static_cast<float>(-up), static_cast<float>(up)};
        }
        return placed(camera, job.source.placement, job.film.bounds);
    };
    bool stretched = false;
    const auto warn_of_stretch = [&](const GivenCamera& camera) {
        if (!options.size || !camera.size || stretched) return;
        const PictureSize made = *camera.size;
        stretched = std::int64_t{options.size->width} * made.height != std::int64_t{options.size->height} * made.width;
        if (stretched)
            job.warnings.push_back(fmt::format("{}: made for {}x{} pixels; --size {}x{} stretches it", file.path, made.width, made.height,
                                               options.size->width, options.size->height));
    };
    std::size_t first = 0;
    if (options.camera != kAllCameras) {
        const auto found = find_camera(file, options.camera.value_or(""));
        if (!found) return tl::unexpected(found.error());
        first = *found;
    } else {
        const auto size_text = [](const GivenCamera& camera) {
            return camera.size ? fmt::format("{}x{}", camera.size->width, camera.size->height) : std::string("none");
        };
        for (const GivenCamera& camera : file.cameras) {
            if (!options.size && size_text(camera) != size_text(file.cameras[0]))
                return fail(ErrorCode::usage,
                            fmt::format("{}: its cameras have pictures of different sizes, {} and {}; --size sets one for all", file.path,
                                        size_text(file.cameras[0]), size_text(camera)));
            warn_of_stretch(camera);
            job.film.views.push_back(place(camera));
        }
    }
    warn_of_stretch(file.cameras[first]);
    request.camera = place(file.cameras[first]);
    if (!request.size) request.size = file.cameras[first].size;
    return {};
}

/// The camera of --camera-orbit. Its distance may be a share of the one that shows all sides of the scene.
Camera orbit_camera(const RenderJob& job, const RenderOptions& options, float aspect) {
    const CameraOrbit& given = *options.camera_orbit;
    ViewSettings side = options.view;
    side.azimuth_deg = 0, side.elevation_deg = 0, side.any_side = true;
    ViewSettings opposite = side;
    opposite.azimuth_deg = 180;
    const std::vector<Camera> both = frame_views(job.scene(), job.film.bounds, aspect, std::array{side, opposite});
    const auto eye = [&](std::size_t i) {
        const Vec4f& at = both[i].world_from_camera.c[3];
        return Vec3d{at.x, at.y, at.z};
    };
    const Vec3d centre = (eye(0) + eye(1)) * 0.5;
    const double distance = given.share ? *given.share * 0.5 * length(eye(0) - eye(1)) : given.distance * job.source.placement.scale;
    const Vec3d target = options.camera_target.value_or(centre);
    return placed_camera(orbit(target, given.theta_deg, 90.0 - given.phi_deg, std::min(distance, 1e36)), options.view.fov_y_deg,
                         job.film.bounds);
}

/// The view that the flags ask for. usual: the size without --size.
Result<PictureRequest> request_of(RenderJob& job, const RenderOptions& options, PictureSize usual) {
    PictureRequest request;
    request.size = options.size;
    request.usual_size = usual;
    job.film.views.clear();
    job.film.framed = !options.cameras && (options.kept_view || !options.film.views.empty());
    if (options.kept_view && !options.cameras) {
        request.camera = camera_of(*options.kept_view, job.source.placement, job.prepared->bounds());
        job.film.bounds = bounds_of(*options.kept_view, job.source.placement);
        return request;
    }
    const Bounds& bounds = job.film.bounds;
    if (options.cameras) {
        if (const auto used = use_given_cameras(job, options, request); !used) return tl::unexpected(used.error());
        return request;
    }
    if (!options.film.views.empty()) {
        const PictureSize size = options.size.value_or(usual);
        job.film.views = frame_views(job.scene(), bounds, static_cast<float>(size.width) / static_cast<float>(size.height),
                                     given_sides(job.scene(), options));
        request.camera = job.film.views.front();
        return request;
    }
    if (options.camera_orbit) {
        const PictureSize size = options.size.value_or(usual);
        request.camera = orbit_camera(job, options, static_cast<float>(size.width) / static_cast<float>(size.height));
        return request;
    }
    if (options.camera_position) {
        const Vec3d target = options.camera_target.value_or(bounds.empty ? Vec3d{} : to_double(bounds.center()));
        request.camera = placed_camera(to_float(*options.camera_position), to_float(target), options.view.fov_y_deg, bounds);
        return request;
    }
    request.scene_camera = options.camera;
    // A turntable goes around the scene.
    request.frame = options.own_view() || options.views_parts() || (options.film.turntable > 0 && !options.camera);
    if (request.frame || (!options.camera && choose_camera(job.scene(), bounds) == nullptr)) {
        const PictureSize size = options.size.value_or(usual);
        const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
        if (options.film.moves() && !bounds.empty) {
            ViewSettings view = front_view(job.scene(), options.view);
            ViewReason reason = ViewReason::given;
            if (!options.own_view()) {
                const FramedView chosen = choose_view(job.scene(), bounds, aspect, options.view);
                view = chosen.view, reason = chosen.reason;
            }
            tell_view(job, view, reason);
            request.camera = film_camera(job.scene(), bounds, options.film, aspect, view);
        }
    }
    return request;
}

/// Tells people what was chosen. given: the flags as they were given.
void tell_choices(RenderJob& job, const RenderOptions& given) {
    const std::vector<Camera>& cameras = job.scene().cameras;
    const bool of_file = job.film.file_camera >= 0, whole = given.own_view() || given.views_parts() || given.film.turntable > 0;
    job.choices.push_back(camera_choice(of_file ? &cameras[static_cast<std::size_t>(job.film.file_camera)] : nullptr, given,
                                        job.film.view.value_or(front_view(job.scene(), given.view)), job.film.reason,
                                        !of_file && !cameras.empty() && !whole));
    const std::size_t lights = job.light.all_lights().size(), added = job.light.lights.size() - job.film.choice.light->lights.size();
    job.choices.push_back(fmt::format("lights: {}{}{}{}", lights,
                                      added == 0        ? ""
                                      : added == lights ? ", added by default"
                                                        : fmt::format(", {} of them added by default", added),
                                      job.light.environment == nullptr ? ""
                                      : given.environment.empty()      ? ", and the environment studio"
                                                                       : ", and the environment " + given.environment,
                                      job.light.ambient.sky_linear == Vec3f{} ? "" : ", and ambient light"));
    job.choices.push_back(fmt::format("exposure: {}, {:+.2f} stops{}", job.settings.exposure, std::log2(double{job.settings.exposure}),
                                      given.exposure ? "" : ", chosen"));
    if (!given.background_linear && !given.settings.background_environment)
        job.choices.push_back(fmt::format("background: {}", job.settings.background_linear == usual_settings().background_linear
                                                                ? "dark grey"
                                                                : "light grey, as surfaces are dark"));
}

/// The flags' coordinates are the file's; the scene may be drawn turned, elsewhere, and larger or smaller. The margin is in pixels of the
/// picture.
RenderOptions in_drawn_world(RenderOptions options, const SceneSource& source, PictureSize usual) {
    const Placement& place = source.placement;
    const auto placed = [&](Vec3d p) {
        const auto within = [](double x) { return std::clamp(x, -io::kLargestLength, io::kLargestLength); };
        const Vec3d at = place.into(p);
        return Vec3d{within(at.x), within(at.y), within(at.z)};
    };
    if (options.camera_position) options.camera_position = placed(*options.camera_position);
    if (options.camera_target) options.camera_target = placed(*options.camera_target);
    if (options.fit_px) {
        const PictureSize size = options.size.value_or(usual);
        options.view.margin_x = 2.0 * options.fit_px->width / size.width;
        options.view.margin_y = 2.0 * options.fit_px->height / size.height;
    }
    for (GivenView& view : options.film.views)
        if (view.of_section >= 0) {
            const Vec3d n = turned_upright(options.sections[static_cast<std::size_t>(view.of_section)].normal, place.up);
            constexpr double kDegrees = 180.0 / kPi;
            view.azimuth_deg = static_cast<float>(angle_of(n.x, n.z) * kDegrees);
            view.elevation_deg = static_cast<float>(angle_of(n.y, std::sqrt(n.x * n.x + n.z * n.z)) * kDegrees);
        }
    options.settings.shadow_fade = io::scaled(options.settings.shadow_fade, place.scale);
    options.lamp_size = io::scaled(options.lamp_size, place.scale);
    for (auto& [light, position] : options.lights) {
        light.direction_ws = to_float(turned_upright(to_double(light.direction_ws), place.up));
        if (!kind_of(light.type).placed) continue;
        light.position_ws = to_float(placed(position));
        io::scale_lengths(light, place.scale);
    }
    return options;
}

Result<void> limit_process_memory(std::size_t bytes) {
    const int error = platform::limit_memory(bytes);
    if (error == 0) return {};
    return fail(ErrorCode::limit, std::string("--max-memory: the system does not set the limit: ") + platform::errno_text(error));
}

Result<void> choose_settings(Settings& settings, const RenderOptions& options) {
    settings = options.settings;
    const auto lobe = chosen_lobe(options);
    if (!lobe) return tl::unexpected(lobe.error());
    settings.shading.lobe = *lobe;
    // The size is not known yet.
    Settings anywhere = settings;
    anywhere.region = {};
    if (const auto checked = check_settings(anywhere, 1, 1); !checked) return fail(checked.error().code, "--" + checked.error().message);
    return {};
}

/// Checks flags that exclude each other, and sizes that can be judged before a scene is loaded.
Result<void> check_conflicts(const RenderOptions& options, PictureSize usual) {
    const bool placed_by_flags = options.camera_position || options.camera_orbit;
    if (placed_by_flags && (options.camera || options.whole_scene || (options.camera_position && options.camera_orbit)))
        return fail(
            ErrorCode::usage,
            fmt::format("{}: cannot be combined with {}--camera, --view, --fit, --ortho, --azimuth, --elevation or --zoom",
                        options.camera_orbit ? "--camera-orbit" : "--camera-position", options.camera_orbit ? "--camera-position, " : ""));
    if (options.camera_target && !placed_by_flags)
        return fail(ErrorCode::usage, "--camera-target: expected together with --camera-position or --camera-orbit");
    const ViewSettings usual_view;
    const bool own_side = options.view.azimuth_deg != usual_view.azimuth_deg || options.view.elevation_deg != usual_view.elevation_deg;
    if (own_side && !options.camera && !options.film.views.empty())
        return fail(ErrorCode::usage, "--azimuth, --elevation: cannot be combined with --view, which takes both as AZ,EL");
    if (options.camera && options.own_view())
        return fail(
            ErrorCode::usage,
            "--camera: cannot be combined with --view, --fit, --azimuth, --elevation, --zoom or --fov, which make a camera of their own");
    if (options.fit_px) {
        const PictureSize size = options.size.value_or(usual);
        const double most = 0.45 * std::min(size.width, size.height);  // ViewSettings::margin_x ends there
        const int margin = std::max(options.fit_px->width, options.fit_px->height);
        if (margin > most)
            return fail(ErrorCode::usage, fmt::format("--fit: expected at most {} pixels, 45 % of the picture's shorter side, found {}",
                                                      static_cast<int>(most), margin));
    }
    if (options.size)
        if (const auto checked = check_size(*options.size, options.settings.region); !checked) return checked;
    return {};
}

/// Of an importer's triangles.
constexpr const char* kCoarse = "triangles may be more than a quarter of a pixel off: ";

Result<RenderJob> make_job(const RenderOptions& flags, PictureSize usual) {
    RenderOptions options = flags;
    if (const auto settled = settle_cameras(options); !settled) return tl::unexpected(settled.error());
    if (const auto checked = check_conflicts(options, usual); !checked) return tl::unexpected(checked.error());
    if (options.max_memory_bytes > 0)
        if (const auto limited = limit_process_memory(options.max_memory_bytes); !limited) return tl::unexpected(limited.error());
    RenderJob job;
    job.execution = options.execution;
    job.timeout_s = options.timeout_s;
    if (!job.execution.isa) {
        const auto isa = default_isa();
        if (!isa) return fail(ErrorCode::usage, isa.error().message);
        job.execution.isa = *isa;
    }
    if (const auto chosen = choose_settings(job.settings, options); !chosen) return tl::unexpected(chosen.error());

    const Stopwatch loading;
    RenderOptions timed = options;
    timed.load = options.timed_load();
    timed.load.keep_animations = options.film.animates();
    timed.load.import_cache = options.import_cache;
    if (!flags.detail_given) timed.load.detail_px = framed_detail(options, usual);
    if (options.scene == "-" && options.input == nullptr) {
        auto bytes = read_standard_input(timed.load.limits.max_file_bytes, timed.load.limits.time_limit_s);
        if (!bytes) return tl::unexpected(bytes.error());
        timed.input = std::make_shared<const std::vector<std::byte>>(std::move(*bytes));
    }
    auto source = load_scene(timed);
    bool may_be_finer = !flags.detail_given;
    if (!source && source.error().code == ErrorCode::limit && !flags.detail_given && timed.load.detail_px > LoadOptions{}.detail_px) {
        job.warnings.push_back(std::string(kCoarse) + source.error().message);
        timed.load.detail_px = LoadOptions{}.detail_px;
        may_be_finer = false;
        source = load_scene(timed);
    }
    if (!source) return tl::unexpected(source.error());
    job.load_ms = loading.ms();
    job.source = std::move(*source);
    job.warnings.insert(job.warnings.end(), job.source.warnings.begin(), job.source.warnings.end());
    if (options.cameras) job.warnings.insert(job.warnings.end(), options.cameras->warnings.begin(), options.cameras->warnings.end());
    const bool is_imported = job.source.file && job.source.file->detail_px > 0 && may_be_finer;
    const Bounds whole = is_imported ? scene_bounds(job.scene()) : Bounds{};
    job.pose_time_s = options.load.time_s;
    if (const AnimationInfo* const animation = job.animation())
        job.choices.push_back(pose_choice(*animation, job.source.animation, job.pose_time_s));
    replace_materials(job.scene(), options.classic);
    if (!options.own_lobes) drop_own_lobes(job.scene());
    if (const auto chosen = choose_parts(job, options); !chosen) return tl::unexpected(chosen.error());
    const bool moves = options.film.animates() && job.source.motion && job.animation() != nullptr;
    if (moves) {
        const auto swept = swept_bounds(job, options);
        if (!swept) return tl::unexpected(swept.error());
        job.film.bounds = *swept;
    }
    if (!options.sections.empty()) {
        if (moves)
            return fail(ErrorCode::usage, "--section: cannot be combined with an animation that moves; --time draws one moment of it");
        if (const auto cut = cut_job(job, options); !cut) return tl::unexpected(cut.error());
    }
    paint_parts(job, options);
    if (options.ground) add_ground(job.scene(), moves ? job.film.bounds : scene_bounds(job.scene()));

    const Stopwatch preparing;
    auto prepared = PreparedScene::make(job.scene(), job.timed_execution());
    if (!prepared) return fail(prepared.error().code, job.source.name + ": " + prepared.error().message);
    job.prepared = std::move(*prepared);
    job.prepare_ms = preparing.ms();
    if (!moves) job.film.bounds = options.film.turntable > 0 ? raster::framed_bounds(job.scene()) : job.prepared->bounds();
    const Bounds& bounds = job.film.bounds;
    const bool loader_said_so = job.source.file && job.source.file->triangles_drawn == 0;
    if (bounds.empty && !loader_said_so) job.warnings.push_back("nothing to draw: nothing that can be seen has finite coordinates");
    const RenderOptions placed = in_drawn_world(options, job.source, usual);
    job.settings.shadow_fade = placed.settings.shadow_fade;
    if (const auto begun = begin_light(job, placed); !begun) return tl::unexpected(begun.error());
    auto request = request_of(job, placed, usual);
    if (!request) return tl::unexpected(request.error());
    if (const auto chosen = choose(job, placed, std::move(*request)); !chosen) return tl::unexpected(chosen.error());
    if (is_imported && !bounds.empty) {
        RenderOptions finer = flags;
        finer.input = timed.input;
        finer.load.detail_px = seen_detail(job, length(to_double(whole.max) - to_double(whole.min)));
        finer.detail_given = true;
        if (finer.load.detail_px > job.source.file->detail_px) {
            auto again = make_job(finer, usual);
            if (again || again.error().code != ErrorCode::limit) return again;
            job.warnings.push_back(std::string(kCoarse) + again.error().message);
        }
    }
    if (job.film.framed && !options.kept_view) warn_of_left_out(job);
    tell_choices(job, options);
    return job;
}

}  // namespace

Result<void> check_request(const RenderOptions& options, PictureSize usual) {
    Settings settings;
    if (const auto chosen = choose_settings(settings, options); !chosen) return chosen;
    return check_conflicts(options, usual);
}

Result<RenderJob> make_render_job(const RenderOptions& options, PictureSize usual) {
    return within_time(options.timeout_s, [&] { return make_job(options, usual); });
}

Result<RenderJob> make_measured_job(RenderOptions options, PictureSize usual) {
    options.load.exact_measures = true;
    return make_render_job(options, usual);
}

std::vector<ViewSettings> given_sides(const Scene& scene, const RenderOptions& options) {
    std::vector<ViewSettings> sides;
    for (const GivenView& given : options.film.views) {
        ViewSettings& side = sides.emplace_back(options.view);
        side.azimuth_deg = given.azimuth_deg + (given.named ? front_azimuth_deg(scene) : 0.0f);
        side.elevation_deg = given.elevation_deg;
        side.any_side = !options.fit_px;
    }
    return sides;
}

void drop_own_lobes(Scene& scene) {
    for (Material& material : scene.materials) material.has_own_lobe = false;
}

bool relight(RenderJob& job, const Camera& camera) {
    const Film& film = job.film;
    Lighting& drawn = job.light;
    if (drawn.environment == film.choice.light->environment && drawn.lights.size() == film.choice.light->lights.size()) return false;
    const Lighting lit = raster::completed_light(job.scene(), film.bounds, camera, film.choice).light;
    drawn.ambient = lit.ambient;
    drawn.environment = lit.environment;
    for (std::size_t i = film.choice.light->lights.size(); i < lit.lights.size() && i < drawn.lights.size(); ++i) {
        drawn.lights[i] = lit.lights[i];
        soften(drawn.lights[i], film);
    }
    return true;
}

void follow_lights(RenderJob& job, const RenderOptions& options) {
    if (!options.scene_lights) return;
    const std::vector<Light>& lights = job.scene().lights;
    for (std::size_t i = 0; i < std::min(lights.size(), job.light.lights.size()); ++i) {
        job.light.lights[i] = lights[i];
        soften(job.light.lights[i], job.film);
    }
}

Result<void> change_light(RenderJob& job, const RenderOptions& options) {
    const RenderOptions placed = in_drawn_world(options, job.source, {job.width, job.height});
    if (const auto begun = begin_light(job, placed); !begun) return begun;
    PictureRequest request;
    request.size = PictureSize{job.width, job.height};
    request.camera = job.camera;
    const int file_camera = job.film.file_camera;
    const auto chosen = choose(job, placed, std::move(request));
    job.film.file_camera = file_camera;
    return chosen;
}

Result<void> change_job(RenderJob& job, const RenderOptions& flags, PictureSize usual, bool same_light) {
    RenderOptions options = flags;
    if (const auto settled = settle_cameras(options); !settled) return settled;
    if (const auto chosen = choose_settings(job.settings, options); !chosen) return chosen;
    const RenderOptions placed = in_drawn_world(options, job.source, usual);
    job.settings.shadow_fade = placed.settings.shadow_fade;
    if (!same_light)
        if (const auto begun = begin_light(job, placed); !begun) return begun;
    auto request = request_of(job, placed, usual);
    if (!request) return tl::unexpected(request.error());
    if (const auto chosen = choose(job, placed, std::move(*request)); !chosen) return chosen;
    if (job.film.framed && !options.kept_view) warn_of_left_out(job);
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
