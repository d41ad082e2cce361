#include "apps/halflit/farm/render_line.hpp"

#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/job/scene_source.hpp"
#include "apps/engine/request/camera_file.hpp"
#include "apps/io/files/file_access.hpp"
#include "apps/io/pictures/picture_reader.hpp"
#include "halflit/image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string_view>

namespace halflit::cli {
namespace {

/// A name with a picture's extension.
using io::is_picture_name;

/// After a word that is neither a scene nor a picture's name.
std::string unknown_format(const std::string& word) {
    const auto format = output_format_of(word);
    return format ? std::string() : format.error().message.substr(word.size());  // begins with the word
}

/// Adds the scenes of a file, one name a line; "-" is standard input.
Result<void> add_listed(const std::string& list, std::vector<std::string>& scenes) {
    constexpr std::size_t kMostBytes = std::size_t{64} << 20;
    const auto bytes = list == "-" ? read_standard_input(kMostBytes, 0.0) : io::read_file(list, kMostBytes);
    if (!bytes) return tl::unexpected(bytes.error());
    std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (line.find_first_not_of(" \t") != std::string_view::npos) scenes.emplace_back(line);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (scenes.empty()) return fail(ErrorCode::usage, "--files-from " + list + ": found no scene");
    return {};
}

/// A folder, or a pattern that no shell has replaced, stands for its models, whose pictures go into a folder.
Result<void> expand(RenderLine& line) {
    auto scenes = with_models_named(line.words);
    if (!scenes) return tl::unexpected(scenes.error());
    if (*scenes == line.words) return {};
    std::string& output = line.output;
    // The words before the first folder or pattern stand for themselves.
    const std::string& named = *std::mismatch(line.words.begin(), line.words.end(), scenes->begin(), scenes->end()).first;
    const std::string names = named + ": stands for " + (scenes->size() == 1 ? "one model" : std::to_string(scenes->size()) + " models");
    if (line.film.wanted()) return fail(ErrorCode::usage, names + ", and a film has one: draw them one after the other");
    if (output.empty()) return fail(ErrorCode::usage, names + ": expected -o FOLDER/ for their pictures");
    if (is_picture_name(output) && !is_folder(output) && !line.format)
        return fail(ErrorCode::usage, names + ", and " + output + " is one picture: expected -o FOLDER/");
    if (!output.ends_with('/') && !is_pattern(output) && !is_picture_name(output)) output += '/';
    line.words = *std::move(scenes);
    return {};
}

/// The names of all formats.
std::string format_names(const char* between, const char* last_between) {
    constexpr int kLast = static_cast<int>(OutputFormat::exr);
    std::string names;
    for (int i = 0; i <= kLast; ++i)
        names.append(i == 0 ? "" : i == kLast ? last_between : between).append(output_format_name(static_cast<OutputFormat>(i)));
    return names;
}

Result<OutputFormat> parse_format(const std::string& text) {
    for (int i = 0; i <= static_cast<int>(OutputFormat::exr); ++i)
        if (text == output_format_name(static_cast<OutputFormat>(i)))
            return output_format_of("picture." + text);  // an error: this build cannot write it
    return fail(ErrorCode::usage, "expected " + format_names(", ", " or ") + ", found '" + text + "'");
}

ReadValue read_path(std::string& path) {
    return [&path](const std::string& text) -> Result<void> {
        if (text.empty()) return fail(ErrorCode::usage, "expected a file name or -, found nothing");
        path = text;
        return {};
    };
}

Result<RenderKind> settle_kind(RenderLine& line) {
    std::vector<std::string>& words = line.words;
    if (line.camera == kAllCameras)
        if (const auto settled = settle_cameras(line); !settled) return tl::unexpected(settled.error());
    if (!line.folder.empty()) {
        if (!line.output.empty()) return fail(ErrorCode::usage, "--out-dir: cannot be combined with -o");
        line.output = line.folder + "/";
    }
    if (words.size() > 1 && (is_picture_name(words.back()) || film::film_format_of(words.back()))) {
        if (!line.output.empty())
            return fail(ErrorCode::usage, "unexpected argument " + words.back() + ": the picture is named by -o " + line.output);
        line.output = words.back();
        words.pop_back();
    }
    const bool has_list = !line.list.empty() && line.list != "-";
    if (has_list && (same_file(line.list, line.output) || same_file(line.list, line.report)))
        return fail(ErrorCode::usage, line.list + ": is the list of --files-from and is not overwritten");
    if (!line.list.empty())
        if (const auto added = add_listed(line.list, words); !added) return tl::unexpected(added.error());
    if (const auto expanded = expand(line); !expanded) return tl::unexpected(expanded.error());
    if (line.film.wanted()) {
        if (words.size() > 1)
            return fail(ErrorCode::usage, "--frames, --turntable and several views: expected one scene, found " + words[1]);
        if (is_folder(line.output) && !line.output.ends_with('/')) line.output += '/';
        const bool names_file = !line.output.empty() && !line.output.ends_with('/') && !film::film_format_of(line.output) && !line.format;
        if (const auto format = output_format_of(line.output); names_file && !format)
            return fail(ErrorCode::usage, format.error().message + " for a file of each frame, or .gif, .apng or .webp for all of them");
        return RenderKind::film;
    }
    if (const auto checked = check_film_options(line.film, line.output); !checked) return tl::unexpected(checked.error());
    if (film::film_format_of(line.output) && !line.format && !output_format_of(line.output))  // .webp holds one picture or many
        return fail(ErrorCode::usage, line.output + ": expected --frames or --turntable, which make many frames, or another extension");
    if (words.size() > 1 && !line.output.ends_with('/') && is_folder(line.output)) line.output += '/';
    const bool many = line.output.ends_with('/') || is_pattern(line.output);
    if (words.size() > 1 && !many && is_picture_name(words.back()))
        return fail(ErrorCode::usage, "two pictures are named, " + words.back() + " and " + line.output + ": expected one");
    if (words.size() > 1 && !many)
        return fail(ErrorCode::usage, "unexpected argument " + words[1] +
                                          (is_scene(words[1]) ? ": several scenes need -o FOLDER/" : unknown_format(words[1])) +
                                          "; see halflit render --help");
    if (many && words.empty()) words.emplace_back();
    if (many) return RenderKind::many;
    if (line.skip_existing) return fail(ErrorCode::usage, "--skip-existing: expected a folder or a pattern as the output (-o FOLDER/)");
    return RenderKind::picture;
}

Result<void> settle_shard(RenderLine& line, RenderKind kind) {
    const Shard& shard = *line.shard;
    if (line.report == "-" || line.output == "-")
        return fail(ErrorCode::usage, "--shard: expected files for the pictures and the report, found -");
    if (!line.report.empty()) line.report = shard.name_of(line.report);
    if (kind == RenderKind::film && film::film_format_of(line.output))
        return fail(ErrorCode::usage, "--shard: expected a file for each frame, as frame_{:04}.png, found '" + line.output +
                                          "'; halflit merge makes one of them");
    if (kind != RenderKind::picture) return {};
    if (!line.aovs.empty()) return fail(ErrorCode::usage, "--aov: cannot be combined with --shard of one picture");
    if (line.blank_check) return fail(ErrorCode::usage, "--blank-check: cannot be combined with --shard of one picture");
    if (line.output.empty()) line.output = default_output(line.words.empty() ? "" : line.words[0], line.format);
    const auto format = line.picture_format();
    if (!format) return tl::unexpected(format.error());
    if (*format == OutputFormat::jpg)
        return fail(ErrorCode::usage, "--shard: halflit merge joins no .jpg, which loses some of each part; expected .png");
    line.output = shard.name_of(line.output);
    if (line.report.empty()) line.report = line.output.substr(0, line.output.rfind('.')) + ".json";
    return {};
}

}  // namespace

Result<RenderKind> settle(RenderLine& line) {
    const auto kind = settle_kind(line);
    if (kind && line.shard)
        if (const auto settled = settle_shard(line, *kind); !settled) return tl::unexpected(settled.error());
    return kind;
}

Command render_table(RenderLine& o) {
    auto groups = render_flags(o, kRenderSize);
    groups.push_back(
        {"Moving pictures",
         {{"--frames", "A-B[:STEP]",
           "Draw these frames, into -o 'frame_{:04}.png' or one .gif, .apng or .webp file. Without --turntable, frame N shows the "
           "animation at N / FPS seconds. A frame's pixels depend on its number alone",
           parsed(o.film.frames, parse_frames)},
          {"--fps", "F",
           "Frames a second, as 24, 23.976 or 30000/1001 (default: 24; 12 for --turntable). With --turntable and --frames, the animation "
           "runs too",
           parsed(o.film.fps, parse_fps)},
          {"--turntable", "N", "Turn the camera once around the scene in N frames; the studio turns with it (default frames: 0 to N - 1)",
           read_int(o.film.turntable, 1, 100000)},
          {"--dither", "", "GIF: mix its 256 colours by an ordered pattern", set_to(o.film.dither)},
          {"--quality", "draft|fast|full",
           "Quality of a film: draft: 95 % of the pixels are within 8 codes of full quality; fast: 99 % within 2, which saves little. It "
           "is measured in three frames, where that repays itself: in films of 16 frames or more, fast 128; others have full quality "
           "(default full)",
           parsed(o.film.quality, parse_quality)},
          {"--share", "PERCENT",
           "Share of a film's pixels that must be within --max-error; measured in three frames, as --quality is, instead of proven",
           parsed(o.film.share, parse_percent)}}});
    groups.push_back(
        {"Output",
         {{"-o,--output", "FILE",
           "A .png, .jpg, .bmp, .tga or .webp file; .exr, .pfm or .hdr for linear floats; - for PNG on standard output; FOLDER/ or "
           "{stem}.png for one picture of each scene; {folder} and {index:04} are known too (default: SCENE's name.png)",
           read_path(o.output)},
          {"--format", format_names("|", "|"), "Format of the picture, whatever its name", parsed(o.format, parse_format)},
          {"--out-dir", "FOLDER", "The same as -o FOLDER/", read_path(o.folder)},
          {"--files-from", "FILE|-", "Also draw the scenes that this file names, one a line; - is standard input", read_path(o.list)},
          {"--shard", "I/N|auto[/N]",
           "Draw part I of N, counted from 0: of the frames, of the scenes, or of one picture's rows; auto takes I from Slurm, Kubernetes, "
           "AWS Batch or GNU parallel. The report's name gets the part's. See halflit merge",
           parsed(o.shard, parse_shard)},
          {"--skip-existing", "", "Keep pictures that exist already, so that a run can be continued", set_to(o.skip_existing)},
          {"--blank-check", "", "Name pictures that show nothing; if there are any, the exit code is 1", set_to(o.blank_check)},
          {"--aov", "NAME,...", aov_help(), parsed(o.aovs, parse_aovs)},
          {"--report", "FILE.json|-", "Write size, hash, times and counts as JSON; on failure, the error. Of several scenes, one line each",
           read_path(o.report)}}});
    Positional scene = scene_argument(o, false);
    scene.help += ". A picture's name after it is the output";
    scene.usage = "SCENE... [PICTURE]";
    scene.read = append_to(o.words);
    scene.repeated = true;
    return {"render",
            "Draw a scene into a picture; without SCENE, the demo scene",
            {std::move(scene)},
            std::move(groups),
            {},
            Command::Listed::by_help,
            {"halflit part.stl", "halflit part.stl --view iso --edges feature --size 800x600 -o part.png",
             "halflit model.glb --turntable 36 --size 320 -o turn.webp"},
            {"--output", "--size", "--view", "--camera", "--up", "--background", "--env", "--edges", "--section", "--turntable"}};
}

}  // namespace halflit::cli
