// halflit render: draws a scene into a picture.
#include "apps/halflit/commands.hpp"
#include "apps/halflit/interrupt.hpp"
#include "apps/halflit/messages.hpp"
#include "apps/halflit/render_job.hpp"
#include "apps/halflit/run_report.hpp"
#include "apps/halflit/stopwatch.hpp"
#include "apps/halflit/text_file.hpp"
#include "apps/io/atomic_file.hpp"
#include "halflit/image.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <new>

namespace halflit::cli {
namespace {

constexpr PictureSize kUsualSize{1280, 720};

struct RenderCommandOptions : RenderOptions {
    std::string output;  ///< empty: named after the scene
    std::string report;  ///< empty: none
};

/// The scene's name without folder and extension, as a PNG in the current folder.
std::string default_output(const std::string& scene) {
    const std::string name = scene.substr(scene.rfind('/') + 1);  // npos + 1 is 0
    const std::string stem = name.substr(0, name.rfind('.'));
    const bool file = !scene.empty() && scene != "-" && !stem.empty();
    return (file ? stem.substr(0, stem.find(':')) : "halflit") + ".png";
}

bool same_file(const std::string& a, const std::string& b) {
    struct stat first {
    }, second{};
    return ::stat(a.c_str(), &first) == 0 && ::stat(b.c_str(), &second) == 0 && first.st_dev == second.st_dev &&
           first.st_ino == second.st_ino;
}

bool is_directory(const std::string& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
}

/// Refuses output paths that would overwrite the scene or each other.
Result<void> check_paths(const RenderCommandOptions& options) {
    if (!options.report.empty() && options.report == options.output)
        return fail(ErrorCode::usage, "--report: expected another file than the picture's, found '" + options.report + "'");
    for (const std::string& path : {options.output, options.report})
        if (path != "-" && !path.empty() && !options.scene.empty() && same_file(path, options.scene))
            return fail(ErrorCode::io, path + ": is the scene itself and is not overwritten");
    return {};
}

/// Returns the report.
Result<std::string> render_and_write(const RenderCommandOptions& options) {
    if (is_directory(options.output)) return fail(ErrorCode::io, options.output + ": " + std::strerror(EISDIR));
    const auto format = output_format_of(options.output);
    if (!format) return tl::unexpected(format.error());
    if (const auto checked = check_paths(options); !checked) return tl::unexpected(checked.error());
    auto job = make_render_job(options, kUsualSize);
    if (!job) return tl::unexpected(job.error());
    Image image = make_image(*job, is_linear(*format));
    const auto rendered = Renderer().render(*job->prepared, job->camera, job->settings, target_of(image), job->execution);
    if (!rendered) return tl::unexpected(rendered.error());
    for (const auto& warnings : {job->warnings, rendered->warnings})
        for (const std::string& warning : warnings) print_warning(warning);

    const Image picture = cropped(std::move(image), job->settings.region);
    const Stopwatch encoding;
    const auto bytes = encode_image(picture, *format);
    if (!bytes) return tl::unexpected(bytes.error());
    const double encode_ms = encoding.ms();
    if (const auto written = io::write_file(options.output, *bytes); !written) return tl::unexpected(written.error());
    if (options.output != "-") print_note("wrote " + options.output);
    return picture_report(options.output, *job, *rendered, picture, encode_ms);
}

Result<std::string> render_within_memory(const RenderCommandOptions& options) {
    try {
        return render_and_write(options);
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::limit, "out of memory");
    }
}

Result<int> run_render(RenderCommandOptions options) {
    if (options.output.empty()) options.output = default_output(options.scene);
    if (!options.report.empty())
        set_last_words([path = options.report](int signal) {
            (void)write_text(path, error_report(128 + signal, "interrupted by signal " + std::to_string(signal)));
        });
    const Result<std::string> done = render_within_memory(options);
    const std::string report = done ? *done : error_report(static_cast<int>(done.error().code), done.error().message);
    // No report is written if its path was refused above because it is the scene's or the picture's.
    if (!options.report.empty() && check_paths(options)) {
        const Result<void> written = write_text(options.report, report);
        if (!written && done) return tl::unexpected(written.error());
    }
    if (!done) return tl::unexpected(done.error());
    return 0;
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
    auto groups = render_flags(o, kUsualSize);
    groups.push_back(
        {"Output",
         {{"-o,--output", "FILE", "A .png, .jpg, .bmp, .tga or .hdr file, or - for PNG on standard output (default: SCENE's name.png)",
           read_path(o.output)},
          {"--report", "FILE.json|-", "Write size, hash, times and counts as JSON; on failure, the error", read_path(o.report)}}});
    return {"render", "Draw a scene into a picture; without one, the demo scene", {scene_argument(o, false)}, std::move(groups), [options] {
                return run_render(*options);
            }};
}

}  // namespace halflit::cli
