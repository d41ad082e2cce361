#include "apps/halflit/render_options.hpp"

#include "apps/halflit/cli_support.hpp"
#include "raster/scene/exposure.hpp"

#include <fmt/format.h>

#include <limits>

namespace halflit::cli {
namespace {

constexpr float kMax = std::numeric_limits<float>::max();

/// One of a few whole numbers.
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

/// One of a few names.
template <class T>
ReadValue named(T& target, std::vector<std::pair<std::string, T>> names) {
    return [&target, names = std::move(names)](const std::string& text) -> Result<void> {
        std::string known;
        for (const auto& [name, value] : names) {
            if (name == text) {
                target = value;
                return {};
            }
            known += (known.empty() ? "" : ", ") + name;
        }
        return fail(ErrorCode::usage, fmt::format("expected one of {}, found '{}'", known, text));
    };
}

void add_picture_flags(CLI::App& app, RenderOptions& o) {
    constexpr const char* kGroup = "Picture";
    add_value(app, "--size", "WxH", "Size in pixels (default 1280x720, or the shape of the file's camera)", [&o](const std::string& text) {
        return assign(o.size, parse_size(text));
    })->group(kGroup);
    add_value(app, "--region", "X,Y,W,H", "Draw and write only this part of the picture", [&o](const std::string& text) {
        return assign(o.region, parse_region(text));
    })->group(kGroup);
    add_value(app, "--samples", "1|4|8", "Samples a pixel against jagged edges (default 4)", choice(o.samples, {1, 4, 8}))->group(kGroup);
    add_value(app, "--background", "COLOR|environment",
              "transparent, #rgb, #rrggbb, #rrggbbaa or a name (default #3a3f47); environment: what --env names",
              [&o](const std::string& text) -> Result<void> {
                  o.background_environment = text == "environment";
                  if (o.background_environment) return {};
                  return assign(o.background_linear, parse_color(text));
              })
        ->group(kGroup);
    add_value(
        app, "--exposure", "EV|auto", "Light times 2^EV; auto: chosen from the file's lights (default)",
        [&o](const std::string& text) {
            o.exposure.reset();
            if (text == "auto") return Result<void>();
            const auto ev = parse_float(text, -64.0f, 64.0f);
            if (!ev) return Result<void>(fail(ErrorCode::usage, fmt::format("expected auto or a number from -64 to 64, found '{}'", text)));
            o.exposure = raster::exposure_factor(*ev);
            return Result<void>();
        })
        ->group(kGroup);
}

void add_camera_flags(CLI::App& app, RenderOptions& o) {
    constexpr const char* kGroup = "Camera (without one in the file, the whole scene is framed)";
    add_value(app, "--camera", "INDEX|NAME", "Which of the file's cameras (default: the first)", [&o](const std::string& text) {
        o.camera = text;
        return Result<void>();
    })->group(kGroup);
    const auto view_flag = [&](const char* name, const char* form, const char* help, float& target, float min, float max) {
        const auto read = [&o, &target, min, max](const std::string& text) {
            o.own_view = true;
            return assign(target, parse_float(text, min, max));
        };
        add_value(app, name, form, help, read)->group(kGroup);
    };
    view_flag("--azimuth", "DEG", "Frame the scene from this side: 0 is from +z, 90 from +x (default 35)", o.view.azimuth_deg, -3600, 3600);
    view_flag("--elevation", "DEG", "... and from this height, -90 to 90 (default 20)", o.view.elevation_deg, -90, 90);
    view_flag("--zoom", "N", "... that much larger (default 1)", o.view.zoom, 1e-3f, 1e3f);
    view_flag("--fov", "DEG", "... with this vertical angle of view, 1 to 170 (default 35)", o.view.fov_y_deg, 1, 170);
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
           "--no-scene-lights", [&o] { o.scene_lights = false; }, "Leave out the lights and the ambient of the scene")
        ->group(kGroup);
    add_value(app, "--ambient", "R,G,B", "Light from all around, linear", [&o](const std::string& text) -> Result<void> {
        const auto rgb = parse_floats(text, 3);
        if (!rgb) return tl::unexpected(rgb.error());
        if ((*rgb)[0] < 0 || (*rgb)[1] < 0 || (*rgb)[2] < 0) return fail(ErrorCode::usage, "expected numbers from 0, found '" + text + "'");
        o.ambient_linear = Vec3f{(*rgb)[0], (*rgb)[1], (*rgb)[2]};
        return {};
    })->group(kGroup);
}

void add_environment_flags(CLI::App& app, RenderOptions& o) {
    constexpr const char* kGroup = "Environment";
    add_value(app, "--env", "FILE|sky|none", "Light from all around: a Radiance picture (.hdr) or the built-in sky (default none)",
              [&o](const std::string& text) {
                  o.environment = text == "none" ? "" : text;
                  return Result<void>();
              })
        ->group(kGroup);
    add_value(app, "--env-rotate", "DEG", "Turn it about the vertical", [&o](const std::string& text) {
        return assign(o.environment_rotate_deg, parse_float(text, -3600.0f, 3600.0f));
    })->group(kGroup);
    add_value(app, "--env-sun", "on|off", "Take suns out of it as lights of their own (default on)",
              named<bool>(o.environment_sun, {{"on", true}, {"off", false}}))
        ->group(kGroup);
    add_value(app, "--sh-order", "auto|1..10", "Bands of spherical harmonics; auto: as many as half an 8-bit code asks for (default)",
              [&o](const std::string& text) -> Result<void> {
                  o.sh_order = 0;
                  if (text == "auto") return {};
                  const auto order = parse_int(text, 1, sh::kMaxBands);
                  if (!order) return fail(ErrorCode::usage, fmt::format("expected auto or 1 to {}, found '{}'", sh::kMaxBands, text));
                  o.sh_order = static_cast<int>(*order);
                  return {};
              })
        ->group(kGroup);
}

void add_shadow_flags(CLI::App& app, RenderOptions& o) {
    constexpr const char* kGroup = "Shadows";
    using shading::ShadowMode;
    add_value(app, "--shadows", "MODE", "off, hard, or soft-split: wrapped light fades instead of being cut off (default)",
              named<ShadowMode>(o.shadows, {{"off", ShadowMode::off}, {"hard", ShadowMode::hard}, {"soft-split", ShadowMode::soft_split}}))
        ->group(kGroup);
    add_value(app, "--shadow-size", "N", "Side of a shadow map in texels, a power of two from 64 to 4096 (default 2048)",
              choice(o.shadow_size, {64, 128, 256, 512, 1024, 2048, 4096}))
        ->group(kGroup);
    add_value(app, "--shadow-fade", "D", "soft-split: blocker distance where wrapped light is gone (default: from object size and wrap)",
              [&o](const std::string& text) { return assign(o.shadow_fade, parse_float(text, 1e-6f, 1e9f)); })
        ->group(kGroup);
    add_value(app, "--shadow-memory", "MIB", "Halve shadow maps until all fit this many MiB, 1 to 65536 (default 256)",
              [&o](const std::string& text) -> Result<void> {
                  const auto mib = parse_int(text, 1, 65536);
                  if (!mib) return tl::unexpected(mib.error());
                  o.shadow_memory_mib = static_cast<int>(*mib);
                  return {};
              })
        ->group(kGroup);
    add_value(app, "--shadow-terminator", "off|on",
              "Look shadows of coarse meshes up on the smooth surface that their normals tell of (default off)",
              named<bool>(o.shadow_terminator, {{"off", false}, {"on", true}}))
        ->group(kGroup);
}

void add_surface_flags(CLI::App& app, RenderOptions& o) {
    constexpr const char* kGroup = "Surface";
    add_value(app, "--lobe", "NAME", "Diffuse lobe: lambert, green, half-lambert, valve, sloan or mcauley (default lambert)",
              [&o](const std::string& text) {
                  o.lobe_name = text;
                  return Result<void>();
              })
        ->group(kGroup);
    add_value(app, "--wrap", "W", "How far the light reaches round, 0 to 1", [&o](const std::string& text) {
        return assign(o.lobe.wrap, parse_float(text, 0.0f, 1.0f));
    })->group(kGroup);
    add_value(app, "--power", "N", "Exponent of the lobe", [&o](const std::string& text) {
        return assign(o.lobe.power, parse_float(text, 0.0f, 1e4f));
    })->group(kGroup);
    app.add_flag_callback(
           "--normalize", [&o] { o.lobe.normalize = true; }, "Scale the lobe to reflect as much light as Lambert's")
        ->group(kGroup);
    using shading::SpecularModel;
    add_value(app, "--specular", "none|phong|blinn", "Highlights (default blinn)",
              named<SpecularModel>(o.specular, {{"none", SpecularModel::none}, {"phong", SpecularModel::phong}, {"blinn", SpecularModel::blinn}}))
        ->group(kGroup);
    add_value(app, "--specular-normalize", "on|off", "Make sharper highlights brighter (default on)",
              named<bool>(o.normalize_specular, {{"on", true}, {"off", false}}))
        ->group(kGroup);
    using shading::ShadingRate;
    add_value(app, "--shading", "RATE", "Light once a triangle, vertex or pixel: flat, gouraud or pixel (default pixel)",
              named<ShadingRate>(o.rate, {{"flat", ShadingRate::flat}, {"gouraud", ShadingRate::gouraud}, {"pixel", ShadingRate::pixel}}))
        ->group(kGroup);
}

void add_accuracy_flags(CLI::App& app, RenderOptions& o) {
    constexpr const char* kGroup = "Accuracy";
    using shading::Accuracy, shading::TextureDetail;
    add_value(app, "--accuracy", "TIER", "reference (float64, slow), exact (default), display (within one 8-bit code of exact) or fast",
              named<Accuracy>(o.accuracy, {{"reference", Accuracy::reference},
                                           {"exact", Accuracy::exact},
                                           {"display", Accuracy::display},
                                           {"fast", Accuracy::fast}}))
        ->group(kGroup);
    add_value(app, "--max-error", "CODES", "Instead of a tier: the cheapest whose bound, in 8-bit codes, is below this, as 0.5",
              [&o](const std::string& text) -> Result<void> {
                  const auto codes = parse_float(text, 1e-3f, 255.0f);
                  if (!codes) return tl::unexpected(codes.error());
                  o.max_error_codes = static_cast<double>(*codes);
                  return {};
              })
        ->group(kGroup);
    add_value(app, "--texture-filter", "NAME", "full (default), bilinear: no blending of mip levels, or nearest",
              named<TextureDetail>(o.texture_detail, {{"full", TextureDetail::full},
                                                      {"bilinear", TextureDetail::bilinear},
                                                      {"nearest", TextureDetail::nearest}}))
        ->group(kGroup);
}

void add_machine_flags(CLI::App& app, RenderOptions& o) {
    constexpr const char* kGroup = "Speed (never changes a pixel)";
    add_value(app, "--isa", "NAME", "Instruction set: auto, scalar, sse2, sse4.1, avx2, avx512 or neon64",
              [&o](const std::string& text) -> Result<void> {
                  const auto isa = shading::isa_by_name(text);
                  if (isa) o.isa = *isa;
                  constexpr std::string_view kPlace = "isa: ";  // said by the flag's own name
                  if (!isa)
                      return fail(ErrorCode::usage,
                                  isa.error().message.substr(isa.error().message.starts_with(kPlace) ? kPlace.size() : 0));
                  return Result<void>();
              })
        ->group(kGroup);
    add_value(app, "--threads", "N", "Threads, 0 for one a core (default)", [&o](const std::string& text) -> Result<void> {
        const auto threads = parse_int(text, 0, 1024);
        if (!threads) return tl::unexpected(threads.error());
        o.threads = static_cast<int>(*threads);
        return {};
    })->group(kGroup);
    add_value(app, "--tile", "N", "Side of a tile in pixels: 16, 32 or 64 (default 64)", choice(o.tile_size, {16, 32, 64}))->group(kGroup);
}

void add_file_flags(CLI::App& app, RenderOptions& o) {
    constexpr const char* kGroup = "Untrusted files";
    app.add_flag("--lenient", o.load.lenient, "Draw what can be drawn of a damaged file, with warnings")->group(kGroup);
    add_values(app, "--allow-external", "DIR", "Let the file refer to files in this folder too", [&o](const std::string& text) {
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
    io::LoadLimits& limits = o.load.limits;
    limit("--max-file-bytes", limits.max_file_bytes, "a larger model, buffer or picture file", kAny);
    limit("--max-total-bytes", limits.max_total_bytes, "more bytes in all buffers together", kAny);
    limit("--max-json-depth", limits.max_json_depth, "JSON nested deeper", 1000);
    limit("--max-json-tokens", limits.max_json_tokens, "JSON of more tokens", kAny);
    limit("--max-texture-side", limits.max_texture_side, "textures with longer sides", shading::kMaxTextureSide);
    limit("--max-texture-pixels", limits.max_texture_pixels, "textures of more pixels", std::int64_t{1} << 28);
    limit("--max-texture-bytes", limits.max_texture_bytes, "more memory for all textures", kAny);
    limit("--max-jpeg-scans", limits.max_jpeg_scans, "JPEG files of more scans", 1 << 20);
    limit("--max-geometry-bytes", limits.max_geometry_bytes, "more memory for vertices and triangles", kAny);
    limit("--max-lights", limits.max_lights, "more lights", 1 << 20);
}

}  // namespace

Result<std::optional<shading::Lobe>> chosen_lobe(const RenderOptions& o) {
    if (o.lobe_name) {
        auto lobe = io::lobe_from_name(*o.lobe_name, o.lobe);
        if (!lobe) return fail(ErrorCode::usage, "--" + lobe.error().message);  // begins with the parameter, called like its flag
        return *lobe;
    }
    if (o.lobe.wrap || o.lobe.power)
        return shading::Lobe{o.lobe.wrap.value_or(0.0f), o.lobe.power.value_or(1.0f), o.lobe.normalize.has_value()};
    if (o.lobe.normalize) return fail(ErrorCode::usage, "--normalize: expected --lobe, --wrap or --power with it");
    return std::nullopt;
}

void add_render_options(CLI::App& app, RenderOptions& o, bool scene_required) {
    o.samples = 4;
    o.background_linear = *parse_color("#3a3f47");
    CLI::Option* scene =
        app.add_option("SCENE", o.scene, "A .glb or .gltf file, - for standard input, or a built-in scene: demo, sphere:N (N triangles), lights:N (N lamps)");
    scene->type_name("");
    if (scene_required) scene->required();
    add_picture_flags(app, o);
    add_camera_flags(app, o);
    add_light_flags(app, o);
    add_environment_flags(app, o);
    add_shadow_flags(app, o);
    add_surface_flags(app, o);
    add_accuracy_flags(app, o);
    add_machine_flags(app, o);
    add_file_flags(app, o);
}

}  // namespace halflit::cli
