// halflit render: draws a scene into a picture.
#include "apps/halflit/aov.hpp"
#include "apps/halflit/commands.hpp"
#include "apps/halflit/file_names.hpp"
#include "apps/halflit/heap.hpp"
#include "apps/halflit/interrupt.hpp"
#include "apps/halflit/messages.hpp"
#include "apps/halflit/output_folder.hpp"
#include "apps/halflit/progress_line.hpp"
#include "apps/halflit/render_job.hpp"
#include "apps/halflit/run_report.hpp"
#include "apps/halflit/stopwatch.hpp"
#include "apps/halflit/text_file.hpp"
#include "apps/io/atomic_file.hpp"
#include "apps/io/errno_text.hpp"
#include "apps/io/model_files.hpp"
#include "apps/io/picture_reader.hpp"
#include "halflit/image.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <new>
#include <utility>

namespace halflit::cli {
namespace {

struct RenderCommandOptions : RenderOptions {
    std::vector<std::string> words;  ///< scenes, and the picture as the last of several
    std::string output;              ///< empty: named after the scene
    std::string report;              ///< empty: none
    std::vector<Aov> aovs;

    /// The picture, and the files beside it.
    [[nodiscard]] std::vector<std::string> pictures() const {
        std::vector<std::string> paths{output};
        for (const Aov aov : aovs) paths.push_back(aov_path(output, aov));
        return paths;
    }
};

/// The scene's name without folder and extension, as a PNG in the current folder.
std::string default_output(const std::string& scene) {
    const std::string stem = stem_of(scene);
    const bool file = !scene.empty() && scene != "-" && !stem.empty();
    return (file ? stem.substr(0, stem.find(':')) : "halflit") + ".png";
}

/// Refuses output paths that would overwrite the scene, the environment or each other.
Result<void> check_paths(const RenderCommandOptions& options) {
    if (!options.aovs.empty() && options.output == "-")
        return fail(ErrorCode::usage, "--aov: expected a picture with a name, which its files take, found -");
    std::vector<std::string> paths = options.pictures();
    for (const std::string& path : paths)
        if (!options.report.empty() && (options.report == path || (options.report != "-" && same_file(options.report, path))))
            return fail(ErrorCode::usage, "--report: expected another file than the picture's, found '" + options.report + "'");
    paths.push_back(options.report);
    for (const std::string& path : paths) {
        if (path == "-" || path.empty()) continue;
        if (!options.scene.empty() && same_file(path, options.scene))
            return fail(ErrorCode::io, path + ": is the scene itself and is not overwritten");
        if (!options.environment.empty() && same_file(path, options.environment))
            return fail(ErrorCode::io, path + ": is the environment itself and is not overwritten");
    }
    if (!is_free_or_begins_with(options.report, '{'))
        return fail(ErrorCode::usage,
                    "--report: expected a new file or an earlier report, found '" + options.report + "', which is neither");
    return {};
}

/// Refuses to overwrite a file that the scene refers to, such as a texture that has the picture's name. If the report would, it is not
/// written at all: its path is cleared.
Result<void> spare_inputs(RenderCommandOptions& options, const RenderJob& job) {
    if (!job.source.file) return {};
    std::vector<std::string> paths = options.pictures();
    paths.push_back(options.report);
    for (const std::string& path : paths)
        for (const std::string& input : job.source.file->files)
            if (path != "-" && !path.empty() && same_file(path, input)) {
                if (path == options.report) options.report.clear();
                return fail(ErrorCode::io, path + ": the scene refers to it, and it is not overwritten");
            }
    return {};
}

/// These formats have no alpha.
void warn_of_lost_transparency(const RenderCommandOptions& options, OutputFormat format) {
    const Settings& settings = options.settings;
    const bool transparent = settings.background_linear.w < 1.0f && !settings.background_environment;
    if (transparent && (format == OutputFormat::jpg || format == OutputFormat::hdr || format == OutputFormat::pfm))
        print_warning(options.output + ": this format has no transparency; the picture is shown over black (.png .bmp .tga .exr keep it)");
}

/// Shows the progress of a drawing that takes longer than half a second.
Result<RenderReport> draw(RenderJob& job, Image& image, AovPlanes& planes) {
    constexpr double kDelayMs = 500;
    ProgressLine line(false, kDelayMs);
    job.execution.progress = [&line](double share) { line.show(share); };
    Target target = target_of(job, image);
    planes.add_to(target);
    return Renderer().render(*job.prepared, job.camera, job.settings, target, job.timed_execution());
}

void print_choices(const RenderJob& job, const RenderReport& rendered, double encode_ms) {
    if (verbosity() != Verbosity::verbose) return;
    print_detail(fmt::format("scene: {}, {} triangles", job.source.name, rendered.triangles_submitted));
    for (const std::string& choice : job.choices) print_detail(choice);
    print_detail(fmt::format("picture: {}x{}, {} samples, {}, {} threads", job.width, job.height, job.settings.samples,
                             isa_name(rendered.isa), rendered.threads));
    const auto& ms = rendered.ms;
    print_detail(
        fmt::format("ms: load {:.1f}, prepare {:.1f}, plan {:.1f}, shadows {:.1f}, cull {:.1f}, transform {:.1f}, bin {:.1f}, "
                    "tiles {:.1f}, encode {:.1f}",
                    job.load_ms, job.prepare_ms, ms.plan, ms.shadows, ms.cull, ms.transform, ms.bin, ms.tiles, encode_ms));
}

/// Returns the report.
Result<std::string> render_and_write(RenderCommandOptions& options) {
    if (is_folder(options.output))
        return fail(ErrorCode::io, options.output + ": " + io::errno_text(EISDIR) + " (-o " + options.output + "/ writes into it)");
    const auto format = output_format_of(options.output);
    if (!format) return tl::unexpected(format.error());
    if (const auto checked = check_paths(options); !checked) return tl::unexpected(checked.error());
    std::vector<std::string> paths = options.pictures();
    if (!options.report.empty()) paths.push_back(options.report);
    for (const std::string& path : paths)
        if (const auto checked = check_writable(path); !checked) return tl::unexpected(checked.error());
    warn_of_lost_transparency(options, *format);
    if (options.max_memory_bytes == 0) prepare_heap();
    auto job = make_render_job(options, kRenderSize);
    if (!job) return tl::unexpected(job.error());
    if (const auto checked = spare_inputs(options, *job); !checked) return tl::unexpected(checked.error());
    Image image = make_image(*job, is_linear(*format));
    AovPlanes planes(options.aovs, *job);
    const auto rendered = draw(*job, image, planes);
    if (!rendered) return fail(rendered.error().code, job->source.name + ": " + rendered.error().message);
    for (const auto& warnings : {job->warnings, rendered->warnings})
        for (const std::string& warning : warnings) print_warning(warning);

    const Stopwatch encoding;
    const auto bytes = encode_image(image, *format);
    if (!bytes) return tl::unexpected(bytes.error());
    const auto beside = planes.encode(options.output, *job, options.up);
    if (!beside) return tl::unexpected(beside.error());
    const double encode_ms = encoding.ms();
    // Whatever can fail comes before the picture has its name.
    std::string report = picture_report(options.output, *beside, *job, *rendered, image, encode_ms);
    print_choices(*job, *rendered, encode_ms);
    std::string note = "wrote " + options.output;
    for (const AovFile& file : *beside) note += ", " + file.path;
    for (const AovFile& file : *beside)
        if (const auto written = io::write_file(file.path, file.bytes); !written) return tl::unexpected(written.error());
    if (const auto written = io::write_file(options.output, *bytes); !written) return tl::unexpected(written.error());
    if (options.output != "-") print_note(note);
    return report;
}

Result<std::string> render_within_memory(RenderCommandOptions& options) {
    constexpr const char* kOutOfMemory = "out of memory";  // in the libraries' messages too
    Result<std::string> done = fail(ErrorCode::limit, kOutOfMemory);
    try {
        done = render_and_write(options);
    } catch (const std::bad_alloc&) {
        // Keeps the error.
    }
    if (!done && options.max_memory_bytes > 0 && done.error().message.find(kOutOfMemory) != std::string::npos)
        return fail(done.error().code, fmt::format("{} (--max-memory {})", done.error().message, options.max_memory_bytes >> 20));
    return done;
}

Result<int> render_scene(RenderCommandOptions options, const std::string& scene) {
    options.scene = scene;
    io::begin_file_set();
    if (options.output.empty() || options.output.ends_with('/')) options.output += default_output(scene);
    const bool may_report = check_paths(options).has_value();
    if (may_report && !options.report.empty())
        set_last_words([path = options.report](int signal) {
            (void)write_text(path, error_report(128 + signal, "interrupted by signal " + std::to_string(signal)));
        });
    const Result<std::string> done = render_within_memory(options);
    const std::string report = done ? *done : error_report(static_cast<int>(done.error().code), done.error().message);
    // A path that is an input's or the picture's was refused.
    if (may_report && !options.report.empty()) {
        const Result<void> written = write_text(options.report, report);
        if (!written && done) return tl::unexpected(written.error());
    }
    if (!done) return tl::unexpected(done.error());
    return 0;
}

/// Refuses pictures that would overwrite a file which one of the scenes refers to.
Result<void> spare_inputs_of_all(const RenderCommandOptions& options, const std::vector<std::string>& pictures) {
    for (const std::string& scene : options.words) {
        if (!is_file(scene)) continue;
        for (const std::string& input : io::files_named_by(scene, options.load))
            for (const std::string& picture : pictures)
                if (same_file(picture, input))
                    return fail(ErrorCode::io, picture + ": " + scene + " refers to it, and it is not overwritten");
    }
    return {};
}

/// Several scenes, each to a picture of its name. A scene that fails does not stop the others; the exit code is the first failure's.
Result<int> render_all(RenderCommandOptions options) {
    if (!options.report.empty()) return fail(ErrorCode::usage, "--report: expected one scene");
    if (!options.output.ends_with('/')) options.output += '/';
    std::vector<std::string> names;
    for (const std::string& scene : options.words) {
        RenderCommandOptions one = options;
        one.output += default_output(scene);
        for (std::string& name : one.pictures()) {
            if (std::find(names.begin(), names.end(), name) != names.end())
                return fail(ErrorCode::usage, scene + ": another scene has the same picture " + name);
            names.push_back(std::move(name));
        }
    }
    if (const auto checked = spare_inputs_of_all(options, names); !checked) return tl::unexpected(checked.error());
    if (const auto made = make_folder(options.output); !made) return tl::unexpected(made.error());
    int code = 0;
    for (const std::string& scene : options.words) {
        const auto done = render_scene(options, scene);
        if (done) continue;
        print_error(done.error().message);
        if (code == 0) code = static_cast<int>(done.error().code);
    }
    return code;
}

/// A name with a picture's extension.
using io::is_picture_name;

/// After a word that is neither a scene nor a picture's name.
std::string unknown_format(const std::string& word) {
    const auto format = output_format_of(word);
    return format ? std::string() : format.error().message.substr(word.size());  // begins with the word
}

Result<int> run_render(RenderCommandOptions options) {
    std::vector<std::string>& words = options.words;
    if (words.size() > 1 && is_picture_name(words.back())) {
        if (!options.output.empty())
            return fail(ErrorCode::usage, "unexpected argument " + words.back() + ": the picture is named by -o " + options.output);
        options.output = words.back();
        words.pop_back();
    }
    const bool folder = options.output.ends_with('/') || (words.size() > 1 && is_folder(options.output));
    if (words.size() > 1 && !folder)
        return fail(ErrorCode::usage, "unexpected argument " + words[1] +
                                          (is_scene(words[1]) ? ": several scenes need -o FOLDER/" : unknown_format(words[1])) +
                                          "; see halflit render --help");
    if (words.size() > 1) return render_all(options);
    if (folder)
        if (const auto made = make_folder(options.output); !made) return tl::unexpected(made.error());
    return render_scene(options, words.empty() ? "" : words[0]);
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
        {"Output",
         {{"-o,--output", "FILE",
           "A .png, .jpg, .bmp or .tga file, or linear floats as .exr, .pfm or .hdr; - for PNG on standard output; FOLDER/ for one "
           "picture of each scene (default: SCENE's name.png)",
           read_path(o.output)},
          {"--aov", "NAME,...",
           "Also write files beside the picture, as x.depth.exr for x.png: depth, normal, albedo, position as floats (.exr; .pfm without "
           "OpenEXR); id, coverage, lights as 16-bit PNG",
           parsed(o.aovs, parse_aovs)},
          {"--report", "FILE.json|-", "Write size, hash, times and counts as JSON; on failure, the error", read_path(o.report)}}});
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
