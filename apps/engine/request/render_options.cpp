#include "apps/engine/request/render_options.hpp"

#include "apps/engine/basics/spelling.hpp"
#include "apps/engine/request/file_flags.hpp"
#include "apps/engine/request/lobe_model.hpp"
#include "apps/engine/request/plan_names.hpp"
#include "apps/engine/request/setting_flags.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/models/formats.hpp"
#include "halflit/scene.hpp"
#include "sh/vec3d.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <span>

namespace halflit::engine {
namespace {

using raster::kOffOn;

using Names = std::span<const std::string_view>;

/// Reads one of the names; the value is the name's index in the list.
template <class T>
ReadValue named(T& target, Names names) {
    return [&target, names](const std::string& text) {
        return read_value(raster::named(names), text).map([&](double index) { target = static_cast<T>(static_cast<int>(index)); });
    };
}

/// "a|b|c", the form of a flag that takes one of these.
std::string form_of(Names names) { return joined({names.begin(), names.end()}, "|"); }

template <class T>
std::string_view name_of(T value, Names names) {
    return names[static_cast<std::size_t>(value)];
}

template <class Target>
ReadValue number(Target& target, float min, float max) {
    return parsed(target, [min, max](const std::string& text) { return parse_float(text, min, max); });
}

/// Reads a text that is not empty.
ReadValue read_name(std::string& target, const char* expected) {
    return parsed(target, [expected](const std::string& text) -> Result<std::string> {
        if (text.empty()) return fail(ErrorCode::usage, fmt::format("expected {}, found ''", expected));
        return text;
    });
}

Result<void> read_exposure(LightRequest& options, const std::string& text) {
    constexpr std::string_view kAuto = "auto";
    const bool chosen = text.starts_with(kAuto);
    const std::string number = chosen ? text.substr(kAuto.size()) : text;
    const bool is_signed = number.starts_with('+') || number.starts_with('-');
    const auto ev = chosen && number.empty() ? Result<float>(0.0f) : parse_float(number, -64.0f, 64.0f);
    if (!ev || number.starts_with("+-") || (chosen && !number.empty() && !is_signed))
        return fail(ErrorCode::usage, fmt::format("expected a number from -64 to 64, auto, or as auto+1 and auto-0.5, found '{}'", text));
    options.exposure = chosen ? std::optional<float>() : exposure_factor(*ev);
    options.exposure_compensation_ev = chosen ? *ev : 0.0f;
    return {};
}

Result<void> read_background(SettingsRequest& options, const std::string& text) {
    options.settings.background_environment = text == "environment";
    options.background_linear.reset();
    if (options.settings.background_environment || text == "auto") return {};
    return assign(options.background_linear, parse_color(text));
}

Flag of_stage(Stage stage, Flag flag) {
    flag.stage = stage;
    return flag;
}

FlagGroup picture_flags(RenderOptions& o) {
    Settings& s = o.settings;
    return {
        "Picture",
        {{"--size", "WxH",
          fmt::format("Width and height in pixels; one number: the side of a square (default {}x{}, reduced to the aspect ratio of the "
                      "file's camera)",
                      o.usual_size.width, o.usual_size.height),
          parsed(o.size, parse_size)},
         {"--region", "X,Y,W,H", "Draw and write only this part of the picture", parsed(s.region, parse_region)},
         {"--background", "auto|COLOR|environment",
          "Colour behind the model: #rgb, #rrggbb, #rrggbbaa, a name, or transparent; auto: dark grey, or light grey if the model is dark "
          "(default); environment: the image of --env",
          [&o](const std::string& text) { return read_background(o, text); }},
         {"--exposure", "EV|auto[+EV]",
          "Multiply all light by 2^EV; auto: chosen from the file's lights or the environment (default); auto+1: one stop brighter than "
          "that, auto-0.5: half a stop darker",
          [&o](const std::string& text) { return read_exposure(o, text); }}},
        Stage::light};
}

/// A flag of the view of the whole scene. Sets `given`.
Flag view_flag(bool& given, const char* name, const char* form, const char* help, float& target, float min, float max) {
    return {name, form, fmt::format("{} (default {})", help, target), [&given, read = number(target, min, max)](const std::string& text) {
                given = true;
                return read(text);
            }};
}

Result<void> read_camera(ViewRequest& o, const std::string& text) {
    if (text == "frame")
        o.whole_scene = true;
    else
        o.camera = text;
    return {};
}

/// Other programs write "+Z" or "Z" for "z".
std::string plain_axis(std::string text) {
    if (text.starts_with('+')) text.erase(0, 1);
    std::transform(text.begin(), text.end(), text.begin(), io::lower);
    return text;
}

FlagGroup camera_flags(RenderOptions& o) {
    return {
        "Camera (default: the file's first camera, or a view of the whole scene)",
        {{"--camera", "INDEX|NAME|frame|all",
          "A camera of the file (default: the first); frame: no camera of the file, but a view of the whole scene; all: one picture for "
          "each camera of --camera-file, as -o '{view}.png'",
          [&o](const std::string& text) { return read_camera(o, text); }},
         view_flag(o.whole_scene, "--azimuth", "DEG", "Angle of the view about the vertical: 0 is from +z, 90 from +x", o.view.azimuth_deg,
                   -3600, 3600),
         view_flag(o.whole_scene, "--elevation", "DEG", "Angle of the view above the horizon, -90 to 90", o.view.elevation_deg, -90, 90),
         view_flag(o.whole_scene, "--zoom", "N", "Enlarge the view by this factor", o.view.zoom, 1e-3f, 1e3f),
         view_flag(o.fov_given, "--fov", "DEG", "Vertical field of view, 1 to 170", o.view.fov_y_deg, 1, 170),
         {"--view", "front|back|left|right|top|bottom|iso|AZ,EL",
          "View the whole scene from this side; AZ,EL: from this azimuth and elevation, in degrees. All sides have the same distance and "
          "scale. Several, with commas or repeated: one picture for each, as -o '{view}.png'",
          [&o](const std::string& text) {
              o.whole_scene = true;
              return parse_views(text).map([&](const auto& views) { o.film.views.insert(o.film.views.end(), views.begin(), views.end()); });
          },
          true},
         {"--fit", "PIXELS", "Fit the model into the picture with this margin; several views share the scale of the largest",
          [&o](const std::string& text) {
              o.whole_scene = true;
              return assign(o.fit_px, parse_int(text, 0, 1 << 20).map([](auto n) {
                  return PictureSize{static_cast<int>(n), static_cast<int>(n)};
              }));
          }},
         {"--ortho,--orthographic", "", "View the whole scene by parallel rays, without perspective",
          [&o](const std::string&) -> Result<void> {
              o.whole_scene = o.view.orthographic = true;
              return {};
          }},
         {"--camera-position", "X,Y,Z", "Place the camera here", parsed(o.camera_position, parse_point)},
         {"--camera-orbit", "THETA PHI RADIUS",
          "Place the camera around its target, as <model-viewer> does. THETA: angle about the vertical from +z, PHI: angle from straight "
          "above, both in degrees, or as 1rad. RADIUS: distance in the file's unit; cm and mm: hundredths and thousandths of it; auto: the "
          "distance that shows all sides; %: a share of that distance",
          parsed(o.camera_orbit, parse_camera_orbit)},
         {"--camera-target", "X,Y,Z",
          "Point that the camera of --camera-position or --camera-orbit looks at (default: the centre of the scene)",
          parsed(o.camera_target, parse_point)},
         {"--camera-file", "FILE",
          "Read cameras from this file instead of the model: a report of look or render, JSON like its `camera`, transforms.json of NeRF, "
          "COLMAP's images.txt, or a glTF file. Their coordinates and axes are those of the model's file",
          read_text(o.camera_file)},
         of_stage(Stage::load, {"--ground", "", "Add a ground below the scene that shows only shadows", set_to(o.ground)}),
         of_stage(Stage::load,
                  {"--up", form_of(kUpAxisNames),
                   fmt::format("Axis of the model that points up (default {}, and z for STL, 3MF and CAD files). Views, the ground and "
                               "the light from above follow it; coordinates stay those of the file",
                               name_of(UpAxis::y, kUpAxisNames)),
                   [&o](const std::string& text) {
                       UpAxis up{};
                       const auto read = named(up, kUpAxisNames)(plain_axis(text));
                       if (read) o.load.up = up;
                       return read;
                   }})},
        Stage::draw};
}

FlagGroup pose_flags(RenderOptions& o) {
    return {"Pose",
            {{"--animation", "NAME|INDEX|none",
              "Animation of the file that poses the scene (default: the first); none: the pose without animation",
              read_name(o.load.animation, "a name, an index or none")},
             {"--scene", "INDEX|NAME", "Scene of the file (default: the one that the file names, or the first)",
              read_name(o.load.scene, "a name or an index")},
             {"--plate", "N", "Plate of a slicer's project (3MF), from 1 (default 1); 0: all of them", read_int(o.load.plate, 0, 255)},
             {"--variant", "NAME", "Variant of the file's materials (default: the materials without a variant)",
              read_name(o.load.variant, "a name")},
             {"--time", "SECONDS", "Time in the animation (default 0); outside of the animation, its first or last pose is drawn",
              [&o](const std::string& text) {
                  o.film.time_held = true;
                  return assign(o.load.time_s, parse_time(text));
              }}}};
}

FlagGroup part_flags(PartFlags& parts) {
    const auto flag = [](const char* name, const char* help, std::vector<std::string>& target) {
        return Flag{.names = name, .form = "PART", .help = help, .read = append_to(target), .repeated = true};
    };
    return {
        "Parts: what one node of the file places",
        {flag("--only",
              "Draw only this part, and view it: a name, a number from the list of halflit info, or a pattern with * and ?; several with "
              "commas or repeated. The name of a node stands for all parts below it",
              parts.only),
         flag("--hide", "Leave this part out", parts.hide),
         flag("--ghost", "Draw this part translucent and pale, so that you see what lies inside; it casts no shadow", parts.ghost),
         flag("--highlight", "Draw this part in one bright colour, and all others but ghosts in grey", parts.highlight),
         {"--highlight-color", "COLOR", "Colour of --highlight: #rgb, #rrggbb or a name (default #ff8400, orange)",
          parsed(parts.highlight_linear, parse_rgb)}}};
}

FlagGroup section_flags(ContentRequest& o) {
    return {
        "Section",
        {{.names = "--section",
          .form = "AXIS=POS|A,B,C,D",
          .help = "Cut the scene by a plane: x=0.5 keeps what is below 0.5 on the x axis, -x=0.5 what is above, x=50% is the middle, "
                  "A,B,C,D keeps Ax+By+Cz<=D. Axes and coordinates are the file's, as in the measures of `info`. Closed objects get caps; "
                  "the report has their areas",
          .read = appended(o.sections, parse_section),
          .repeated = true},
         {"--section-hatch", form_of(kOffOn), fmt::format("Hatch the caps of the cut with lines (default {})", name_of(o.hatch, kOffOn)),
          named(o.hatch, kOffOn)},
         {"--section-spacing", "N",
          "Distance between the lines of the hatch, in the scene's units (default: a fortieth of the scene's diagonal)",
          number(o.hatch_spacing, 0.0f, std::numeric_limits<float>::max())}}};
}

Result<void> read_ambient(std::optional<Vec3f>& ambient, const std::string& text) {
    const auto rgb = parse_point(text);
    if (!rgb) return tl::unexpected(rgb.error());
    if (rgb->x < 0 || rgb->y < 0 || rgb->z < 0) return fail(ErrorCode::usage, "expected numbers from 0, found '" + text + "'");
    ambient = to_float(*rgb);
    return {};
}

FlagGroup light_flags(LightRequest& o) {
    return {
        "Light",
        {{.names = "--light",
          .form = "TYPE:KEY=VALUE:...",
          .help = "Add a light, as directional:dir=-1,-2,-1:color=#fff:intensity=1; also point (pos, range, radius) and spot (pos, dir, "
                  "cone=IN,OUT, power); size makes shadows soft",
          .read = appended(o.lights, parse_light),
          .repeated = true},
         {"--no-scene-lights", "", "Leave out the scene's own lights and ambient light", set_to(o.scene_lights, false)},
         {"--ambient", "R,G,B", "Ambient light: the same from all directions, linear RGB",
          [&o](const std::string& text) { return read_ambient(o.ambient_linear, text); }}},
        Stage::light};
}

FlagGroup environment_flags(LightRequest& o) {
    return {"Environment",
            {{"--env", "FILE|sky|studio|none",
              "Environment, an image of light from all directions: a picture of floats (.hdr .exr .pfm), or the built-in sky or studio "
              "(default: the studio where the scene has no light; with none, such a scene gets light from above and below)",
              [&o](const std::string& text) -> Result<void> {
                  o.studio = text == "studio" ? StudioUse::always : text == "none" ? StudioUse::never : StudioUse::for_dark;
                  o.environment = text == "studio" || text == "none" ? "" : text;
                  return {};
              }},
             {"--env-rotate", "DEG", "Turn the environment about the vertical, counter-clockwise seen from above",
              number(o.environment_rotate_deg, -3600.0f, 3600.0f)},
             {"--env-sun", form_of(kOffOn),
              fmt::format("Replace suns in the environment by directional lights (default {})", name_of(o.environment_sun, kOffOn)),
              named(o.environment_sun, kOffOn)}},
            Stage::light};
}

FlagGroup shadow_flags(LightRequest& o) {
    return {
        "Shadows",
        {{"--sun-size", "DEG",
          "Soft shadows of directional lights and of the studio: angle from the middle of the light to its rim, 0 to 40 (default 0; the "
          "sun has 0.27)",
          number(o.sun_size_deg, 0.0f, 40.0f)},
         {"--lamp-size", "R", "Soft shadows of point and spot lights: their radius, in the scene's units (default 0)",
          number(o.lamp_size, 0.0f, 1e9f)}},
        Stage::light};
}

FlagGroup surface_flags(RenderOptions& o) {
    return {
        "Surface",
        {of_stage(Stage::draw, {"--lobe", joined(lobe_name_list(), "|"),
                                "Diffuse lobe: how reflected light depends on the angle to the light (default lambert)",
                                [&o](const std::string& text) { return assign(o.lobe_name, Result<std::string>(text)); }}),
         of_stage(Stage::draw,
                  {"--wrap", "W",
                   fmt::format("Wrap, 0 to {}: light reaches surfaces where the cosine between normal and light is above -W", kMaxLobeWrap),
                   number(o.lobe.wrap, 0.0f, kMaxLobeWrap)}),
         of_stage(Stage::draw,
                  {"--power", "N", fmt::format("Exponent of the lobe, 0 to {}", kMaxLobePower), number(o.lobe.power, 0.0f, kMaxLobePower)}),
         of_stage(Stage::draw, {"--normalize", "", "Scale the lobe so that its mean over all light directions is Lambert's",
                                [&o](const std::string&) { return assign(o.lobe.normalize, Result<bool>(true)); }}),
         {"--own-lobes", form_of(kOffOn),
          fmt::format("Let materials that have lobes of their own keep them (default {}); off: --lobe, --wrap and --power apply to all",
                      name_of(o.own_lobes, kOffOn)),
          named(o.own_lobes, kOffOn)},
         {"--kd", "X", "Diffuse factor of all lit materials, 0 to 1; it multiplies their base colour",
          number(o.classic.diffuse, 0.0f, 1.0f)},
         {"--ks", "X",
          "Specular factor of all lit materials, 0 to 1: the reflectance at normal incidence (default 0.04). It multiplies the diffuse "
          "part by "
          "1 - X",
          number(o.classic.specular, 0.0f, 1.0f)},
         {"--shininess", "S",
          fmt::format("Exponent of Blinn's highlight for all lit materials, 0 to {}, instead of their roughness; Phong's is S / 4. Each of "
                      "--kd, --ks and --shininess makes all materials non-metallic",
                      kMaxShininess),
          number(o.classic.exponent, 0.0f, kMaxShininess)},
         {"--crease", "DEG",
          fmt::format(
              "Shade edges up to this angle between triangles as smooth, 0 to 180, in noisy scans up to twice the angle; for models "
              "without normals that are not glTF (default {})",
              o.load.crease_deg),
          number(o.load.crease_deg, 0.0f, 180.0f)}}};
}

Result<void> read_isa(std::optional<Isa>& target, const std::string& text) {
    const auto isa = isa_by_name(text);
    constexpr std::string_view kPlace = "isa: ";  // the flag's own name says it already
    if (!isa) return fail(ErrorCode::usage, isa.error().message.substr(isa.error().message.starts_with(kPlace) ? kPlace.size() : 0));
    target = *isa;
    return {};
}

FlagGroup machine_flags(Execution& e) {
    return {
        "Speed (never changes a pixel)",
        {{"--isa", "NAME", "Instruction set: auto, " + isa_names(), [&e](const std::string& text) { return read_isa(e.isa, text); }},
         {"--threads", "N", "Number of threads, 0 for one per core (default)", read_int(e.threads, 0, 1024)},
         {"--tile", "N", fmt::format("Side of a tile in pixels: 16, 32 or 64 (default {})", e.tile_size), [&e](const std::string& text) {
              static constexpr int kTileSizes[] = {16, 32, 64};
              return read_value(raster::one_of(kTileSizes), text).map([&](double side) { e.tile_size = static_cast<int>(side); });
          }}}};
}

FlagGroup line_flags(SettingsRequest& o) {
    return {"Lines",
            {{"--edge-color", "COLOR", "Colour of the lines: #rgb, #rrggbb or a name (default black)",
              [&o](const std::string& text) {
                  if (!o.has_given("edge_contrast")) o.settings.edge_contrast = false;
                  return assign(o.settings.edge_color_linear, parse_rgb(text));
              }}},
            Stage::draw};
}

}  // namespace

Positional scene_argument(ModelRequest& o, bool required) {
    return {.name = "SCENE",
            .help = fmt::format(
                "A model's file; {}, - for standard input; or a built-in scene: demo, sphere:N (N triangles), lights:N (N point lights)",
                io::detail::list_of_formats(&io::detail::FormatRow::extension)),
            .read = read_text(o.scene),
            .required = required,
            .form = "FILE"};
}

std::vector<FlagGroup> render_flags(RenderOptions& o, PictureSize usual) {
    o.usual_size = usual;
    std::vector<FlagGroup> groups{picture_flags(o),       camera_flags(o), pose_flags(o),        part_flags(o.parts),
                                  section_flags(o),       light_flags(o),  environment_flags(o), shadow_flags(o),
                                  surface_flags(o),       line_flags(o),   {"Accuracy", {}},     machine_flags(o.execution),
                                  untrusted_file_flags(o)};
    for (FlagGroup& group : groups) add_setting_flags(group, o.settings, o.given_settings);
    return groups;
}

Result<RenderOptions> parse_render_flags(std::span<const std::string> words) {
    RenderOptions options;
    if (const auto read = read_flags(render_flags(options, kRenderSize), words); !read) return tl::unexpected(read.error());
    return options;
}

}  // namespace halflit::engine
