// halflit render: draws a scene into a picture.
#include "apps/halflit/commands.hpp"
#include "apps/halflit/file_names.hpp"
#include "apps/halflit/heap.hpp"
#include "apps/halflit/interrupt.hpp"
#include "apps/halflit/messages.hpp"
#include "apps/halflit/picture_file.hpp"
#include "apps/halflit/render_film.hpp"
#include "apps/halflit/render_many.hpp"
#include "apps/halflit/run_report.hpp"
#include "apps/halflit/scene_source.hpp"
#include "apps/halflit/text_file.hpp"
#include "apps/io/atomic_file.hpp"
#include "apps/io/file_access.hpp"
#include "apps/io/picture_reader.hpp"
#include "halflit/image.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <string_view>

namespace halflit::cli {
namespace {

struct RenderCommandOptions : PictureOptions {
    std::vector<std::string> words;  ///< scenes, and the picture as the last of several
    std::string folder;              ///< of --out-dir
    std::string list;                ///< of --files-from
    bool skip_existing = false;
};

Result<int> render_scene(PictureOptions options, const std::string& scene) {
    options.scene = scene;
    io::begin_file_set();
    if (options.output.empty() || options.output.ends_with('/')) options.output += default_output(scene, options.format);
    const bool may_report = check_paths(options).has_value();
    if (may_report && !options.report.empty())
        set_last_words([path = options.report, scene](int signal) {
            (void)write_text(path, error_report(scene, 128 + signal, "interrupted by signal " + std::to_string(signal)));
        });
    if (options.max_memory_bytes == 0) prepare_heap();
    Result<PictureFile> done = draw_picture(options);
    if (done)
        if (const auto written = write_picture(*done); !written) done = tl::unexpected(written.error());
    const std::string report = done ? done->report : error_report(scene, static_cast<int>(done.error().code), done.error().message);
    // A path that is an input's or the picture's was refused.
    if (may_report && !options.report.empty()) {
        const Result<void> written = write_text(options.report, report);
        if (!written && done) return tl::unexpected(written.error());
    }
    if (!done) return tl::unexpected(done.error());
    return done->blank ? 1 : 0;
}

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
        if (!line.empty()) scenes.emplace_back(line);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (scenes.empty()) return fail(ErrorCode::usage, "--files-from " + list + ": found no scene");
    return {};
}

Result<int> run_film_command(RenderCommandOptions& options) {
    if (options.words.size() > 1) return fail(ErrorCode::usage, "--frames and --turntable: expected one scene, found " + options.words[1]);
    if (options.skip_existing) return fail(ErrorCode::usage, "--skip-existing: cannot be combined with --frames or --turntable");
    options.scene = options.words.empty() ? "" : options.words[0];
    if (is_folder(options.output) && !options.output.ends_with('/')) options.output += '/';
    return render_film(options);
}

Result<int> run_render(RenderCommandOptions options) {
    std::vector<std::string>& words = options.words;
    if (!options.folder.empty()) {
        if (!options.output.empty()) return fail(ErrorCode::usage, "--out-dir: cannot be combined with -o");
        options.output = options.folder + "/";
    }
    if (words.size() > 1 && (is_picture_name(words.back()) || film::film_format_of(words.back()))) {
        if (!options.output.empty())
            return fail(ErrorCode::usage, "unexpected argument " + words.back() + ": the picture is named by -o " + options.output);
        options.output = words.back();
        words.pop_back();
    }
    if (!options.list.empty())
        if (const auto added = add_listed(options.list, words); !added) return tl::unexpected(added.error());
    if (options.film.wanted()) return run_film_command(options);
    if (const auto checked = check_film_options(options.film, options.output); !checked) return tl::unexpected(checked.error());
    if (film::film_format_of(options.output) && !options.format)
        return fail(ErrorCode::usage, options.output + ": expected --frames or --turntable, which make many frames, or another extension");
    if (words.size() > 1 && !options.output.ends_with('/') && is_folder(options.output)) options.output += '/';
    const bool many = options.output.ends_with('/') || is_pattern(options.output);
    if (words.size() > 1 && !many)
        return fail(ErrorCode::usage, "unexpected argument " + words[1] +
                                          (is_scene(words[1]) ? ": several scenes need -o FOLDER/" : unknown_format(words[1])) +
                                          "; see halflit render --help");
    if (many && words.empty()) words.emplace_back();
    if (many) return render_many({options, words, options.skip_existing});
    if (options.skip_existing) return fail(ErrorCode::usage, "--skip-existing: expected a folder or a pattern as the output (-o FOLDER/)");
    return render_scene(options, words.empty() ? "" : words[0]);
}

Result<OutputFormat> parse_format(const std::string& text) {
    if (std::find(std::begin(kFormatNames), std::end(kFormatNames), text) != std::end(kFormatNames))
        return output_format_of("picture." + text);  // an error: this build cannot write it
    return fail(ErrorCode::usage, "expected png, jpg, bmp, tga, hdr, pfm or exr, found '" + text + "'");
}

ReadValue read_path(std::string& path) {
    return [&path](const std::string& text) -> Result<void> {
        if (text.empty()) return fail(ErrorCode::usage, "expected a file name or -, found nothing");
        path = text;
        return {};
    };
}

}  // namespace

Command render_command() {
    const auto options = std::make_shared<RenderCommandOptions>();
    RenderCommandOptions& o = *options;
    auto groups = render_flags(o, kRenderSize);
    groups.push_back(
        {"Moving pictures",
         {{"--frames", "A-B[:STEP]",
           "Draw these frames, into -o 'frame_{:04}.png' or one .gif, .apng or .webp file; without --turntable, the animation at N / FPS "
           "seconds. A frame depends on its number alone",
           parsed(o.film.frames, parse_frames)},
          {"--fps", "F",
           "Frames a second, as 24, 23.976 or 30000/1001 (default: 24; 12 for --turntable). With --turntable and --frames, the animation "
           "runs too",
           parsed(o.film.fps, parse_fps)},
          {"--turntable", "N", "Turn the camera around the scene, once in N frames, and the studio with it (default frames: 0 to N - 1)",
           read_int(o.film.turntable, 1, 100000)},
          {"--dither", "", "GIF: mix its 256 colours by an ordered pattern", set_to(o.film.dither)}}});
    groups.push_back(
        {"Output",
         {{"-o,--output", "FILE",
           "A .png, .jpg, .bmp or .tga file, or linear floats as .exr, .pfm or .hdr; - for PNG on standard output; FOLDER/ or "
           "{stem}.png for one picture of each scene; {folder} and {index:04} are known too (default: SCENE's name.png)",
           read_path(o.output)},
          {"--format", "png|jpg|bmp|tga|hdr|pfm|exr", "Format of the picture, whatever its name", parsed(o.format, parse_format)},
          {"--out-dir", "FOLDER", "The same as -o FOLDER/", read_path(o.folder)},
          {"--files-from", "FILE|-", "Draw the scenes that a file names too, one a line; - is standard input", read_path(o.list)},
          {"--skip-existing", "", "Leave pictures alone that are there, so that a run can be taken up again", set_to(o.skip_existing)},
          {"--blank-check", "", "Name pictures in which nothing is seen; if there are any, the exit code is 1", set_to(o.blank_check)},
          {"--aov", "NAME,...",
           "Also write files beside the picture, as x.depth.exr for x.png: depth, normal, albedo, position as floats (.exr; .pfm without "
           "OpenEXR); id, coverage, lights as 16-bit PNG",
           parsed(o.aovs, parse_aovs)},
          {"--report", "FILE.json|-", "Write size, hash, times and counts as JSON; on failure, the error. Of several scenes, one line each",
           read_path(o.report)}}});
    Positional scene = scene_argument(o, false);
    scene.help += ". A picture's name after it is the output";
    scene.usage = "SCENE... [PICTURE]";
    scene.read = [&o](const std::string& text) -> Result<void> {
        o.words.push_back(text);
        return {};
    };
    scene.repeated = true;
    return {"render", "Draw a scene into a picture; without one, the demo scene", {std::move(scene)}, std::move(groups), [options] {
                return run_render(*options);
            }};
}

}  // namespace halflit::cli
