#include "apps/halflit/render_options.hpp"

#include "apps/halflit/cli_support.hpp"
#include "apps/halflit/plan_names.hpp"
#include "halflit/scene.hpp"

#include <fmt/format.h>

#include <limits>

namespace halflit::cli {
namespace {

constexpr std::string_view kOffOn[] = {"off", "on"};
constexpr const char* kUsualBackground = "#3a3f47";

/// Reads one of the allowed whole numbers.
ReadValue choice(int& target, std::initializer_list<int> allowed) {
    return [&target, choices = std::vector<int>(allowed)](const std::string& text) -> Result<void> {
        const auto value = parse_int(text, 1, std::numeric_limits<int>::max());
        for (const int one : choices)
            if (value && *value == one) {
                target = one;
                return {};
            }
        return fail(ErrorCode::usage, fmt::format("expected one of {}, found '{}'", fmt::join(choices, ", "), text));
    };
}

/// Reads one of the names; the value is the name's index in the list.
template <class T, std::size_t N>
ReadValue named(T& target, const std::string_view (&names)[N]) {
    return [&target, &names](const std::string& text) -> Result<void> {
        for (std::size_t i = 0; i < N; ++i)
            if (names[i] == text) {
                target = static_cast<T>(i);
                return {};
            }
        return fail(ErrorCode::usage, fmt::format("expected one of {}, found '{}'", fmt::join(names, ", "), text));
    };
}

/// "a|b|c", the form of a flag that takes one of these.
template <std::size_t N>
std::string form_of(const std::string_view (&names)[N]) {
    return fmt::format("{}", fmt::join(names, "|"));
}

template <class T, std::size_t N>
std::string_view name_of(T value, const std::string_view (&names)[N]) {
    return names[static_cast<std::size_t>(value)];
}

void add_picture_flags(CLI::App& app, RenderOptions& o, PictureSize usual) {
    constexpr const char* kGroup = "Picture";
    Settings& s = o.settings;
    add_value(app, "--size", "WxH",
              fmt::format("Size in pixels (default {}x{}, reduced to the aspect ratio of the file's camera)", usual.width, usual.height),
              [&o](const std::string& text) { return assign(o.size, parse_size(text)); })
        ->group(kGroup);
    add_value(app, "--region", "X,Y,W,H", "Draw and write only this part of the picture", [&s](const std::string& text) {
        return assign(s.region, parse_region(text));
    })->group(kGroup);
    add_value(app, "--samples", "1|4|8", fmt::format("Samples per pixel, which smooth edges (default {})", s.samples),
              choice(s.samples, {1, 4, 8}))
        ->group(kGroup);
    add_value(
        app, "--background", "COLOR|environment",
        fmt::format("transparent, #rgb, #rrggbb, #rrggbbaa or a name (default {}); environment: the image of --env", kUsualBackground),
        [&s](const std::string& text) -> Result<void> {
            s.background_environment = text == "environment";
            if (s.background_environment) return {};
            return assign(s.background_linear, parse_color(text));
        })
        ->group(kGroup);
    add_value(
        app, "--exposure", "EV|auto", "Multiply all light by 2^EV; auto: chosen from the file's lights or the environment (default)",
        [&o](const std::string& text) {
            o.exposure.reset();
            if (text == "auto") return Result<void>();
            const auto ev = parse_float(text, -64.0f, 64.0f);
            if (!ev) return Result<void>(fail(ErrorCode::usage, fmt::format("expected auto or a number from -64 to 64, found '{}'", text)));
            o.exposure = exposure_factor(*ev);
            return Result<void>();
        })
        ->group(kGroup);
}

void add_camera_flags(CLI::App& app, RenderOptions& o) {
    constexpr const char* kGroup = "Camera (default: the file's first camera, or a view of the whole scene)";
    add_value(app, "--camera", "INDEX|NAME", "Use this camera of the file (default: the first)", [&o](const std::string& text) {
        o.camera = text;
        return Result<void>();
    })->group(kGroup);
    const auto view_flag = [&](const char* name, const char* form, const char* help, float& target, float min, float max) {
        const auto read = [&o, &target, min, max](const std::string& text) {
            o.own_view = true;
            return assign(target, parse_float(text, min, max));
        };
        add_value(app, name, form, fmt::format("{} (default {})", help, target), read)->group(kGroup);
    };
    view_flag("--azimuth", "DEG", "View the whole scene from this side: 0 is from +z, 90 from +x", o.view.azimuth_deg, -3600, 3600);
    view_flag("--elevation", "DEG", "View it from this angle above the horizon, -90 to 90", o.view.elevation_deg, -90, 90);
    view_flag("--zoom", "N", "Enlarge it by this factor", o.view.zoom, 1e-3f, 1e3f);
    view_flag("--fov", "DEG", "Vertical field of view, 1 to 170", o.view.fov_y_deg, 1, 170);
}

void add_light_flags(CLI::App& app, RenderOptions& o) {
    constexpr const char* kGroup = "Light";
    add_values(app, "--light", "TYPE:KEY=VALUE:...",
               "Add a light, as directional:dir=-1,-2,-1:color=#fff:intensity=1; also point (pos, range, "
               "radius) and spot (pos, dir, cone=IN,OUT, power)",
               [&o](const std::string& text) -> Result<void> {
                   const auto light = parse_light(text);
                   if (!light) return tl::unexpected(light.error());
                   o.lights.push_back(*light);
                   return {};
               })
        ->group(kGroup);
    app.add_flag_callback(
           "--no-scene-lights", [&o] { o.scene_lights = false; }, "Leave out the scene's own lights and ambient light")
        ->group(kGroup);
    add_value(app, "--ambient", "R,G,B", "Ambient light: the same from all directions, linear RGB",
              [&o](const std::string& text) -> Result<void> {
                  const auto rgb = parse_floats(text, 3);
                  if (!rgb) return tl::unexpected(rgb.error());
                  if ((*rgb)[0] < 0 || (*rgb)[1] < 0 || (*rgb)[2] < 0)
                      return fail(ErrorCode::usage, "expected numbers from 0, found '" + text + "'");
                  o.ambient_linear = Vec3f{(*rgb)[0], (*rgb)[1], (*rgb)[2]};
                  return {};
              })
        ->group(kGroup);
}

void add_environment_flags(CLI::App& app, RenderOptions& o) {
    constexpr const char* kGroup = "Environment";
    add_value(app, "--env", "FILE|sky|none",
              "Environment, an image of light from all directions: a Radiance picture (.hdr) or the built-in sky (default none)",
              [&o](const std::string& text) {
                  o.environment = text == "none" ? "" : text;
                  return Result<void>();
              })
        ->group(kGroup);
    add_value(app, "--env-rotate", "DEG", "Turn the environment about the vertical, counter-clockwise seen from above",
              [&o](const std::string& text) { return assign(o.environment_rotate_deg, parse_float(text, -3600.0f, 3600.0f)); })
        ->group(kGroup);
    add_value(app, "--env-sun", form_of(kOffOn),
              fmt::format("Replace suns in the environment by directional lights (default {})", name_of(o.environment_sun, kOffOn)),
              named(o.environment_sun, kOffOn))
        ->group(kGroup);
    int& order = o.settings.shading.environment_bands;
    add_value(app, "--sh-order", fmt::format("auto|1..{}", sh::kMaxBands),
              "Bands of spherical harmonics for the environment; auto: as few as keep the error within 1/510 of white (default)",
              [&order](const std::string& text) -> Result<void> {
                  order = 0;
                  if (text == "auto") return {};
                  const auto bands = parse_int(text, 1, sh::kMaxBands);
                  if (!bands) return fail(ErrorCode::usage, fmt::format("expected auto or 1 to {}, found '{}'", sh::kMaxBands, text));
                  order = static_cast<int>(*bands);
                  return {};
              })
        ->group(kGroup);
}

void add_shadow_flags(CLI::App& app, Settings& s) {
    constexpr const char* kGroup = "Shadows";
    constexpr std::size_t kMib = 1u << 20;
    add_value(app, "--shadows", form_of(kShadowModeNames),
              fmt::format("hard: shadows cut off wrapped light; soft-split: it fades with the distance to the blocker (default {})",
                          name_of(s.shadows, kShadowModeNames)),
              named(s.shadows, kShadowModeNames))
        ->group(kGroup);
    add_value(app, "--shadow-size", "N",
              fmt::format("Side of a shadow map in texels, a power of two from 64 to 4096 (default {})", s.shadow_size),
              choice(s.shadow_size, {64, 128, 256, 512, 1024, 2048, 4096}))
        ->group(kGroup);
    add_value(app, "--shadow-fade", "D",
              "soft-split: distance to the blocker from which on no wrapped light is left (default: from object size and wrap)",
              [&s](const std::string& text) { return assign(s.shadow_fade, parse_float(text, 1e-6f, 1e9f)); })
        ->group(kGroup);
    add_value(app, "--shadow-memory", "MIB",
              fmt::format("Memory limit of all shadow maps, 1 to 65536 MiB: they are halved in size until they fit (default {})",
                          s.shadow_memory_limit / kMib),
              [&s](const std::string& text) -> Result<void> {
                  const auto mib = parse_int(text, 1, 65536);
                  if (!mib) return tl::unexpected(mib.error());
                  s.shadow_memory_limit = static_cast<std::size_t>(*mib) * kMib;
                  return {};
              })
        ->group(kGroup);
    add_value(app, "--shadow-terminator", form_of(kOffOn),
              fmt::format("Look shadows of coarse meshes up on the smooth surface given by the vertex normals (default {})",
                          name_of(s.shadow_terminator_offset, kOffOn)),
              named(s.shadow_terminator_offset, kOffOn))
        ->group(kGroup);
}

void add_surface_flags(CLI::App& app, RenderOptions& o) {
    constexpr const char* kGroup = "Surface";
    ShadingSettings& s = o.settings.shading;
    add_value(app, "--lobe", "NAME",
              fmt::format("Diffuse lobe, reflected light over the angle to the light: {} (default lambert)", lobe_names()),
              [&o](const std::string& text) {
                  o.lobe_name = text;
                  return Result<void>();
              })
        ->group(kGroup);
    add_value(app, "--wrap", "W", fmt::format("Wrap, 0 to {}: light reaches surfaces whose cosine to the light is above -W", kMaxLobeWrap),
              [&o](const std::string& text) { return assign(o.lobe.wrap, parse_float(text, 0.0f, kMaxLobeWrap)); })
        ->group(kGroup);
    add_value(app, "--power", "N", fmt::format("Exponent of the lobe, 0 to {}", kMaxLobePower), [&o](const std::string& text) {
        return assign(o.lobe.power, parse_float(text, 0.0f, kMaxLobePower));
    })->group(kGroup);
    app.add_flag_callback(
           "--normalize", [&o] { o.lobe.normalize = true; }, "Scale the lobe so that its mean over all light directions is Lambert's")
        ->group(kGroup);
    add_value(app, "--specular", form_of(kSpecularNames),
              fmt::format("Model of the highlights (default {})", name_of(s.specular, kSpecularNames)), named(s.specular, kSpecularNames))
        ->group(kGroup);
    add_value(app, "--specular-normalize", form_of(kOffOn),
              fmt::format("Make sharper highlights brighter (default {})", name_of(s.normalize_specular, kOffOn)),
              named(s.normalize_specular, kOffOn))
        ->group(kGroup);
    add_value(app, "--shading", form_of(kRateNames),
              fmt::format("Compute light once per triangle (flat), vertex (gouraud) or pixel (default {})", name_of(s.rate, kRateNames)),
              named(s.rate, kRateNames))
        ->group(kGroup);
}

void add_accuracy_flags(CLI::App& app, ShadingSettings& s) {
    constexpr const char* kGroup = "Accuracy";
    add_value(app, "--accuracy", form_of(kAccuracyNames),
              fmt::format(
                  "reference: float64, slow; exact: float32; display: at most one 8-bit code from exact; fast: larger errors (default {})",
                  name_of(s.accuracy, kAccuracyNames)),
              named(s.accuracy, kAccuracyNames))
        ->group(kGroup);
    add_value(app, "--max-error", "CODES",
              "Instead of --accuracy: the cheapest computation with a proven error below this many 8-bit codes, such as 0.5",
              [&s](const std::string& text) -> Result<void> {
                  const auto codes = parse_float(text, 1e-3f, 255.0f);
                  if (!codes) return tl::unexpected(codes.error());
                  s.max_error_codes = static_cast<double>(*codes);
                  return {};
              })
        ->group(kGroup);
    add_value(app, "--texture-filter", form_of(kTextureDetailNames),
              fmt::format("full: as the file asks; bilinear: one mip level; nearest: one texel of it (default {})",
                          name_of(s.texture_detail, kTextureDetailNames)),
              named(s.texture_detail, kTextureDetailNames))
        ->group(kGroup);
}

void add_machine_flags(CLI::App& app, Execution& e) {
    constexpr const char* kGroup = "Speed (never changes a pixel)";
    add_value(app, "--isa", "NAME", "Instruction set: auto, " + isa_names(), [&e](const std::string& text) -> Result<void> {
        const auto isa = isa_by_name(text);
        constexpr std::string_view kPlace = "isa: ";  // the flag's own name says it already
        if (!isa) return fail(ErrorCode::usage, isa.error().message.substr(isa.error().message.starts_with(kPlace) ? kPlace.size() : 0));
        e.isa = *isa;
        return {};
    })->group(kGroup);
    add_value(app, "--threads", "N", "Number of threads, 0 for one per core (default)", [&e](const std::string& text) -> Result<void> {
        const auto threads = parse_int(text, 0, 1024);
        if (!threads) return tl::unexpected(threads.error());
        e.threads = static_cast<int>(*threads);
        return {};
    })->group(kGroup);
    add_value(app, "--tile", "N", fmt::format("Side of a tile in pixels: 16, 32 or 64 (default {})", e.tile_size),
              choice(e.tile_size, {16, 32, 64}))
        ->group(kGroup);
}

void add_file_flags(CLI::App& app, RenderOptions& o) {
    constexpr const char* kGroup = "Untrusted files";
    app.add_flag("--lenient", o.load.lenient, "Draw what can be drawn of a damaged file, with warnings")->group(kGroup);
    add_values(app, "--allow-external", "DIR", "Also allow references to files in this folder", [&o](const std::string& text) {
        o.load.allow_external.push_back(text);
        return Result<void>();
    })->group(kGroup);
    const auto limit = [&]<class T>(const char* name, T& target, const char* what, std::int64_t max) {
        const std::string help = fmt::format("Refuse {} (default {})", what, target);
        const auto read = [&target, max](const std::string& text) -> Result<void> {
            const auto value = parse_int(text, 1, max);
            if (!value) return tl::unexpected(value.error());
            target = static_cast<T>(*value);
            return {};
        };
        add_value(app, name, "N", help, read)->group(kGroup);
    };
    constexpr std::int64_t kAny = std::numeric_limits<std::int64_t>::max();
    LoadLimits& limits = o.load.limits;
    limit("--max-file-bytes", limits.max_file_bytes, "a larger model, buffer or picture file", kAny);
    limit("--max-total-bytes", limits.max_total_bytes, "more bytes in all buffers together", kAny);
    limit("--max-json-depth", limits.max_json_depth, "JSON nested deeper", 1000);
    limit("--max-json-tokens", limits.max_json_tokens, "JSON of more tokens", kAny);
    limit("--max-texture-side", limits.max_texture_side, "textures with longer sides", kMaxTextureSide);
    limit("--max-texture-pixels", limits.max_texture_pixels, "textures of more pixels", std::int64_t{1} << 28);
    limit("--max-texture-bytes", limits.max_texture_bytes, "more memory for all textures", kAny);
    limit("--max-jpeg-scans", limits.max_jpeg_scans, "JPEG files of more scans", 1 << 20);
    limit("--max-geometry-bytes", limits.max_geometry_bytes, "more memory for vertices and triangles", kAny);
    limit("--max-lights", limits.max_lights, "more lights", 1 << 20);
}

}  // namespace

Result<std::optional<Lobe>> chosen_lobe(const RenderOptions& o) {
    if (o.lobe_name) {
        auto lobe = io::lobe_from_name(*o.lobe_name, o.lobe);
        if (!lobe) return fail(ErrorCode::usage, "--" + lobe.error().message);  // begins with the parameter's name, which is the flag's
        return *lobe;
    }
    if (o.lobe.wrap || o.lobe.power) return Lobe{o.lobe.wrap.value_or(0.0f), o.lobe.power.value_or(1.0f), o.lobe.normalize.has_value()};
    if (o.lobe.normalize) return fail(ErrorCode::usage, "--normalize: expected together with --lobe, --wrap or --power");
    return std::nullopt;
}

void add_render_options(CLI::App& app, RenderOptions& o, bool scene_required, PictureSize usual) {
    CLI::Option* scene =
        app.add_option("SCENE", o.scene,
                       "A .glb or .gltf file, - for standard input, or a built-in scene: demo, sphere:N (N triangles), lights:N (N lamps)");
    scene->type_name("");
    if (scene_required) scene->required();
    add_picture_flags(app, o, usual);
    add_camera_flags(app, o);
    add_light_flags(app, o);
    add_environment_flags(app, o);
    add_shadow_flags(app, o.settings);
    add_surface_flags(app, o);
    add_accuracy_flags(app, o.settings.shading);
    add_machine_flags(app, o.execution);
    add_file_flags(app, o);
}

}  // namespace halflit::cli
