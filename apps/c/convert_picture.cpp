// Conversions of what describes a picture. The constants and the layout of halflit.h are checked here too.
#include "apps/c/convert_parts.hpp"
#include "apps/c/versioned.hpp"
#include "raster/settings_table.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace halflit::c {
namespace {

HALFLIT_ENDS_WITH(halflit_load_options, importers_count);
HALFLIT_ENDS_WITH(halflit_animation, channels);
HALFLIT_ENDS_WITH(halflit_counts, reserved);
HALFLIT_ENDS_WITH(halflit_node, light);
HALFLIT_ENDS_WITH(halflit_splats, reserved);
HALFLIT_ENDS_WITH(halflit_mesh, splats);
HALFLIT_ENDS_WITH(halflit_instance, place_rest);
HALFLIT_ENDS_WITH(halflit_light, position_rest);
HALFLIT_ENDS_WITH(halflit_material, reserved);
HALFLIT_ENDS_WITH(halflit_environment_options, reserved);
HALFLIT_ENDS_WITH(halflit_camera, place_rest);
HALFLIT_ENDS_WITH(halflit_settings, reserved);
HALFLIT_ENDS_WITH(halflit_picture_request, exposure_compensation_ev);
HALFLIT_ENDS_WITH(halflit_view, any_side);
HALFLIT_ENDS_WITH(halflit_execution, reserved);
HALFLIT_ENDS_WITH(halflit_target, uv_row_bytes);
HALFLIT_ENDS_WITH(halflit_report, reserved);
HALFLIT_ENDS_WITH(halflit_measured, reserved);
#undef HALFLIT_ENDS_WITH

// The constants are the numbers of the enumerations.
static_assert(HALFLIT_TOPOLOGY_LINES == static_cast<int>(Topology::lines) && HALFLIT_TOPOLOGY_POINTS == static_cast<int>(Topology::points));
static_assert(HALFLIT_SPLATS_KHR == static_cast<int>(SplatReference::khr) && HALFLIT_SPLATS_MIP == static_cast<int>(SplatReference::mip));
static_assert(HALFLIT_ERROR_USAGE == static_cast<int>(ErrorCode::usage) &&
              HALFLIT_ERROR_CANCELLED == static_cast<int>(ErrorCode::cancelled));
static_assert(HALFLIT_COLOR_LINEAR == static_cast<int>(ColorSpace::linear) && HALFLIT_ALPHA_BLEND == static_cast<int>(AlphaMode::blend));
static_assert(HALFLIT_WRAP_CLAMP == static_cast<int>(TextureWrap::clamp) &&
              HALFLIT_FILTER_LINEAR == static_cast<int>(TextureFilter::linear));
static_assert(HALFLIT_MIP_LINEAR == static_cast<int>(MipFilter::linear) && HALFLIT_LIGHT_SPOT == static_cast<int>(LightType::spot));
static_assert(HALFLIT_ACCURACY_EXACT == static_cast<int>(Accuracy::exact) && HALFLIT_RATE_PIXEL == static_cast<int>(ShadingRate::pixel));
static_assert(HALFLIT_DETAIL_NEAREST == static_cast<int>(TextureDetail::nearest));
static_assert(HALFLIT_SPECULAR_GGX == static_cast<int>(SpecularModel::ggx));
static_assert(HALFLIT_SHADOWS_SOFT_SPLIT == static_cast<int>(ShadowMode::soft_split));
static_assert(HALFLIT_EDGES_ALL == static_cast<int>(EdgeChoice::all));
static_assert(HALFLIT_ALPHA_SPACE_DISPLAY == static_cast<int>(AlphaSpace::display));
static_assert(HALFLIT_HIDDEN_EDGES_DASHED == static_cast<int>(HiddenEdges::dashed));
static_assert(HALFLIT_EDL_ON == static_cast<int>(EyeDomeLighting::on));
static_assert(HALFLIT_TONE_REINHARD == static_cast<int>(ToneCurve::reinhard) &&
              HALFLIT_TONE_NEUTRAL == static_cast<int>(ToneCurve::neutral));
static_assert(HALFLIT_UP_BY_FORMAT == 0 && HALFLIT_UP_X == static_cast<int>(UpAxis::x) + 1 &&
              HALFLIT_UP_MINUS_Z == static_cast<int>(UpAxis::minus_z) + 1);
static_assert(HALFLIT_STUDIO_NEVER == static_cast<int>(StudioUse::never) &&
              HALFLIT_STUDIO_UNDER_LIGHTS == static_cast<int>(StudioUse::under_lights));

}  // namespace

halflit_camera to_c(const CallersCamera& given) {
    const Camera& from = given.camera;
    halflit_camera camera{};
    camera.size = sizeof camera;
    camera.name = from.name.c_str();
    put(from.world_from_camera, camera.world_from_camera);
#define HALFLIT_CAMERA(member, ...) camera.member = from.member;
#include "raster/camera_members.def"
    if (from.sides) {
        const float sides[] = {from.sides->left, from.sides->right, from.sides->bottom, from.sides->top};
        std::copy_n(sides, 4, camera.sides);
    }
    put(given.rest, camera.place_rest);
    return camera;
}

Result<CallersCamera> camera(const halflit_camera* given) {
    const auto read = read_struct(given, to_c(CallersCamera{}), "halflit_camera");
    if (!read) return tl::unexpected<Error>(read.error());
    Camera camera;
    camera.world_from_camera = mat4(read->world_from_camera);
#define HALFLIT_CAMERA(member, ...) camera.member = static_cast<decltype(camera.member)>(read->member);
#include "raster/camera_members.def"
    const auto& [left, right, bottom, top] = read->sides;
    if (left != 0 || right != 0 || bottom != 0 || top != 0) camera.sides = ViewSides{left, right, bottom, top};
    return CallersCamera{camera, vec3(read->place_rest)};
}

halflit_settings to_c(const Settings& from) {
    halflit_settings settings{};
    settings.size = sizeof settings;
    settings.region = {from.region.x, from.region.y, from.region.width, from.region.height};
    put(from.background_linear, settings.background);
    put(from.edge_color_linear, settings.edge_color);
    settings.background_environment = from.background_environment;
    settings.override_lobe = from.shading.lobe.has_value();
    settings.lobe = to_c(from.shading.lobe.value_or(Lobe{}));
#define HALFLIT_SETTING(place, name, ...) settings.name = static_cast<decltype(settings.name)>(from.place);
#include "raster/settings_table.def"
    return settings;
}

Result<Settings> settings(const halflit_settings* given) {
    Settings settings;
    if (given == nullptr) return settings;
    const auto read = read_struct(given, to_c(settings), "halflit_settings");
    if (!read) return tl::unexpected<Error>(read.error());
    settings.region = {read->region.x, read->region.y, read->region.width, read->region.height};
    settings.background_linear = vec4(read->background);
    settings.edge_color_linear = vec3(read->edge_color);
    settings.background_environment = read->background_environment != 0;
    if (read->override_lobe != 0) settings.shading.lobe = lobe(read->lobe);
    Members members("halflit_settings");
    members.finite("background", read->background);
    for (const float channel : read->edge_color)
        if (!(channel >= 0.0f && channel <= 1.0f)) members.wrong("edge_color", "is not from 0 to 1");
    const double values[] = {
#define HALFLIT_SETTING(place, name, ...) static_cast<double>(read->name),
#include "raster/settings_table.def"
    };
    for (std::size_t i = 0; i < std::size(values); ++i) {
        const raster::Setting& setting = raster::kSettings[i];
        if (setting.values.is_truth())
            setting.set(settings, values[i] != 0.0 ? 1.0 : 0.0);
        else if (setting.values.kind == raster::SettingValues::Kind::named && !setting.values.contains(values[i]))
            members.wrong(std::string(setting.name).c_str(), "is " + std::to_string(static_cast<int>(values[i])) + ", expected 0 to " +
                                                                 std::to_string(setting.values.names.size() - 1));
        else
            setting.set(settings, values[i]);
    }
    if (!members.result()) return tl::unexpected<Error>(members.result().error());
    return settings;
}

namespace {

/// Copies the members of a view that ViewSettings, halflit_view and halflit_picture_request share.
template <class From, class To>
void copy_view(const From& from, To& to) {
    to.azimuth_deg = from.azimuth_deg, to.elevation_deg = from.elevation_deg;
    to.zoom = from.zoom, to.fov_y_deg = from.fov_y_deg;
    to.orthographic = from.orthographic != 0, to.any_side = from.any_side != 0;
    to.margin_x = from.margin_x, to.margin_y = from.margin_y;
}
template <class Struct>
ViewSettings view_settings(const Struct& from) {
    ViewSettings view;
    copy_view(from, view);
    return view;
}

}  // namespace

halflit_view default_view() {
    halflit_view view{};
    view.size = sizeof view;
    copy_view(ViewSettings{}, view);
    return view;
}

Result<ViewSettings> view(const halflit_view* given) {
    const auto read = read_struct(given, default_view(), "halflit_view");
    if (!read) return tl::unexpected<Error>(read.error());
    Members members("halflit_view");
    members.finite("azimuth_deg", read->azimuth_deg);
    members.view(*read);
    if (!members.result()) return tl::unexpected<Error>(members.result().error());
    return view_settings(*read);
}

halflit_picture_request default_picture_request() {
    const PictureRequest defaults;
    halflit_picture_request options{};
    options.size = sizeof options;
    copy_view(defaults.view, options);
    options.add_lights = defaults.add_lights;
    return options;
}

Result<PictureRequest> picture_request(const halflit_picture_request* given, const World& world) {
    PictureRequest options;
    if (given == nullptr) return options;
    const auto read = read_struct(given, default_picture_request(), "halflit_picture_request");
    if (!read) return tl::unexpected<Error>(read.error());
    if (read->camera != nullptr) {
        const auto view = camera(read->camera);
        if (!view) return tl::unexpected<Error>(view.error());
        options.camera = world.into(*view);
    }
    if (!(read->exposure >= 0.0f && read->exposure < 1e18f))
        return fail(ErrorCode::usage, "halflit_picture_request: exposure is not 0 or a positive number");
    if (read->scene_camera != nullptr) options.scene_camera = read->scene_camera;
    if (read->width != 0 || read->height != 0) {
        if (auto ok = check_settings({}, read->width, read->height); !ok) return tl::unexpected<Error>(ok.error());
        options.size = PictureSize{read->width, read->height};
    }
    options.frame = read->frame != 0;
    options.view = view_settings(*read);
    if (read->own_ambient != 0) options.ambient_linear = vec3(read->ambient_color);
    if (read->exposure > 0.0f) options.exposure = read->exposure;
    if (!(read->exposure_compensation_ev >= -64.0 && read->exposure_compensation_ev <= 64.0))
        return fail(ErrorCode::usage, "halflit_picture_request: exposure_compensation_ev is not between -64 and 64");
    options.exposure_compensation_ev = static_cast<float>(read->exposure_compensation_ev);
    options.add_lights = read->add_lights != 0;
    options.studio_turn_rad = read->studio_turn_rad;
    Members members("halflit_picture_request");
    members.read(read->studio, StudioUse::under_lights, "studio", options.studio);
    members.finite("azimuth_deg or studio_turn_rad", read->azimuth_deg, read->studio_turn_rad);
    members.view(*read);
    members.finite("ambient_color", read->ambient_color);
    if (!members.result()) return tl::unexpected<Error>(members.result().error());
    return options;
}

namespace {

struct Loop {
    const std::function<void(int)>* body;
    int count;
};

/// Runs one part. Leaves out a part that does not exist, so that the frame fails for the part that the host calls by a wrong number.
void run_part(void* task, std::int32_t i) {
    const Loop& loop = *static_cast<const Loop*>(task);
    if (i >= 0 && i < loop.count) (*loop.body)(i);
}

}  // namespace

halflit_execution default_execution() {
    const Execution defaults;
    halflit_execution execution{};
    execution.size = sizeof execution;
    execution.threads = defaults.threads;
    execution.tile_size = defaults.tile_size;
    return execution;
}

Result<Execution> execution(const halflit_execution* given) {
    Execution execution;
    if (given == nullptr) return execution;
    const auto read = read_struct(given, default_execution(), "halflit_execution");
    if (!read) return tl::unexpected<Error>(read.error());
    if (read->isa != nullptr) {
        const auto isa = isa_by_name(read->isa);
        if (!isa) return fail(ErrorCode::usage, "halflit_execution: isa: " + isa.error().message);
        execution.isa = *isa;
    }
    if (read->threads < 0 || read->threads > kMostThreads)
        return fail(ErrorCode::usage,
                    "halflit_execution: threads is " + std::to_string(read->threads) + ", expected 0 to " + std::to_string(kMostThreads));
    if (read->tile_size != 16 && read->tile_size != 32 && read->tile_size != 64)
        return fail(ErrorCode::usage, "halflit_execution: tile_size is " + std::to_string(read->tile_size) + ", expected 16, 32 or 64");
    execution.threads = read->threads;
    execution.tile_size = read->tile_size;
    execution.time_limit_s = read->time_limit_s;
    execution.memory_limit = read->memory_limit;
    void* const user = read->user;
    if (auto* const cancelled = read->cancelled) execution.cancelled = [=] { return cancelled(user) != 0; };
    if (auto* const on_tile = read->on_tile) execution.on_tile = [=](const Region& r) { on_tile(user, r.x, r.y, r.width, r.height); };
    if (auto* const progress = read->progress) execution.progress = [=](double share) { progress(user, share); };
    if (auto* const parallel_for = read->parallel_for)
        execution.parallel_for = [=](int count, const std::function<void(int)>& body) {
            Loop loop{&body, count};
            parallel_for(user, count, run_part, &loop);
        };
    return execution;
}

bool stops_at_interrupt(const halflit_execution* given) {
    return given != nullptr &&
           read_struct(given, default_execution(), "halflit_execution").value_or(default_execution()).stop_at_interrupt != 0;
}

halflit_target default_target() {
    halflit_target target{};
    target.size = sizeof target;
    return target;
}

Result<halflit_target> target_struct(const halflit_target* given) {
    auto read = read_struct(given, default_target(), "halflit_target");
    if (read && (read->format < HALFLIT_FORMAT_RGBA8 || read->format > HALFLIT_FORMAT_RGBA_F32_PREMULTIPLIED))
        return fail(ErrorCode::usage, "halflit_target: format is " + std::to_string(read->format) + ", expected 0 to " +
                                          std::to_string(HALFLIT_FORMAT_RGBA_F32_PREMULTIPLIED));
    return read;
}

Target target(const halflit_target& given) {
    Target target;
    target.width = given.width;
    target.height = given.height;
    if (is_float(given.format)) {
        target.linear = static_cast<float*>(given.pixels);
        target.linear_row_bytes = given.row_bytes;
    } else {
        target.pixels = static_cast<std::uint8_t*>(given.pixels);
        target.row_bytes = given.row_bytes;
        target.format = is_bgra(given.format) ? PixelFormat::bgra8 : PixelFormat::rgba8;
    }
    target.premultiplied = is_premultiplied(given.format);
    target.region_alone = given.region_alone != 0;
#define HALFLIT_PLANE(name) target.name = given.name, target.name##_row_bytes = given.name##_row_bytes
    HALFLIT_PLANE(depth);
    HALFLIT_PLANE(normal);
    HALFLIT_PLANE(instance);
    HALFLIT_PLANE(triangle);
    HALFLIT_PLANE(shading_normal);
    HALFLIT_PLANE(albedo);
    HALFLIT_PLANE(position);
    HALFLIT_PLANE(lights);
    HALFLIT_PLANE(coverage);
    HALFLIT_PLANE(barycentric);
    HALFLIT_PLANE(uv);
#undef HALFLIT_PLANE
    return target;
}

halflit_report to_c(const RenderReport& from) {
    halflit_report report{};
    report.size = sizeof report;
    report.total_ms = from.total_ms;
    report.prepare_ms = from.ms.prepare;
    report.plan_ms = from.ms.plan;
    report.shadows_ms = from.ms.shadows;
    report.cull_ms = from.ms.cull;
    report.transform_ms = from.ms.transform;
    report.bin_ms = from.ms.bin;
    report.tiles_ms = from.ms.tiles;
    report.error_budget = from.error.budget;
    report.error_codes = from.error.codes;
    report.error_within = 1;
    report.triangles_submitted = from.triangles_submitted;
    report.triangles_drawn = from.triangles_drawn;
    report.triangles_not_finite = from.triangles_not_finite;
    report.pixels_visible = from.pixels_visible;
    report.fragments_shaded = from.fragments_shaded;
    report.nan_pixels = from.nan_pixels;
    const auto isa = isa_name(from.isa);
    std::memcpy(report.isa, isa.data(), std::min(isa.size(), sizeof report.isa - 1));
    report.threads = from.threads;
    report.warnings = static_cast<std::int32_t>(from.warnings.size());
    return report;
}

}  // namespace halflit::c
