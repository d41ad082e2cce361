#include "apps/engine/request/file_flags.hpp"

#include <fmt/format.h>

#include <limits>

namespace halflit::engine {
namespace {

template <class T>
Flag limit_flag(const char* name, T& target, const char* what, std::int64_t max, std::int64_t min = 1) {
    const auto parse = [min, max](const std::string& text) {
        return parse_int(text, min, max).map([](std::int64_t n) { return static_cast<T>(n); });
    };
    return {.names = name, .form = "N", .help = fmt::format("Refuse {} (default {})", what, target), .read = parsed(target, parse)};
}

}  // namespace

Flag timeout_flag(double& seconds, std::string help) {
    return {"--timeout", "SECONDS", std::move(help), parsed(seconds, [](const std::string& text) {
                return parse_float(text, 1e-3f, 1e6f).map([](float s) { return static_cast<double>(s); });
            })};
}

FlagGroup untrusted_file_flags(RenderOptions& o) {
    constexpr std::int64_t kAny = std::numeric_limits<std::int64_t>::max();
    LoadLimits& limits = o.load.limits;
    return {
        std::string(kLastPictureGroup),
        {timeout_flag(o.timeout_s, "Time limit; a scene that is not drawn by then ends with exit code 5"),
         {"--max-memory", "MIB", "Memory limit of the process, at least 32; a scene that needs more ends with exit code 5",
          parsed(o.max_memory_bytes, parse_memory)},
         {"--strict", "", "Refuse a damaged file; without it, what can be read is drawn, with warnings", set_to(o.load.strict)},
         {.names = "--allow-external",
          .form = "DIR",
          .help = "Also allow references to files in this folder",
          .read = append_to(o.load.allow_external),
          .repeated = true},
         {"--detail", "PX",
          "Pixels along the diagonal of a STEP, IGES or BREP model: its triangles are at most a quarter of one from the surfaces, 1 to 1e6 "
          "(default: by the view)",
          [&o](const std::string& text) {
              o.detail_given = true;
              return assign(o.load.detail_px, parse_float(text, 1.0f, 1e6f));
          }},
         {.names = "--importer",
          .form = ".EXT=PROGRAM",
          .help = "Read files with this extension by a program that makes glTF of them",
          .read = appended(o.load.importers, Importer::from),
          .repeated = true},
         {"--no-cache", "", "Do not keep what importers make in ~/.cache/halflit/import, and do not read it there",
          set_to(o.load.import_cache, false)},
         limit_flag("--max-file-bytes", limits.max_file_bytes, "a larger model, buffer or picture file", kAny),
         limit_flag("--max-total-bytes", limits.max_total_bytes, "more bytes in all buffers together", kAny),
         limit_flag("--max-json-depth", limits.max_json_depth, "JSON nested deeper", 1000),
         limit_flag("--max-json-tokens", limits.max_json_tokens, "JSON of more tokens", kAny),
         limit_flag("--max-texture-side", limits.max_texture_side, "textures with longer sides", kMaxTextureSide),
         limit_flag("--max-texture-pixels", limits.max_texture_pixels, "textures of more pixels", std::int64_t{1} << 28),
         limit_flag("--max-texture-bytes", limits.max_texture_bytes,
                    "textures of more pixels in all than this number; textures that need more bytes are made smaller", kAny),
         limit_flag("--max-jpeg-scans", limits.max_jpeg_scans, "JPEG files of more scans", 1 << 20),
         limit_flag("--max-geometry-bytes", limits.max_geometry_bytes, "more memory for vertices and triangles", kAny),
         limit_flag("--max-work", limits.max_work,
                    "files and frames of more work than this estimate, in nanoseconds of one core; 0: 1.7e9, and 1,000 for each byte of "
                    "the files",
                    kAny, 0),
         limit_flag("--max-lights", limits.max_lights, "more lights", 1 << 20)}};
}

}  // namespace halflit::engine
