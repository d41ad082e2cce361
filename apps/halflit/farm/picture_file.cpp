#include "apps/halflit/farm/picture_file.hpp"
#include "apps/halflit/farm/picture_report.hpp"

#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/stopwatch.hpp"
#include "apps/engine/job/picture_judgement.hpp"
#include "apps/engine/job/render_job.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/progress_line.hpp"
#include "apps/io/files/atomic_file.hpp"
#include "apps/io/platform/errno_text.hpp"
#include "halflit/image.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <utility>

namespace halflit::cli {
namespace {

/// These formats have no alpha.
void warn_of_lost_transparency(const PictureOptions& options, OutputFormat format) {
    const bool transparent = options.background_linear && options.background_linear->w < 1.0f;
    if (transparent && (format == OutputFormat::jpg || format == OutputFormat::hdr || format == OutputFormat::pfm))
        print_warning(options.output +
                      ": this format has no transparency; the picture is shown over black (.png .webp .bmp .tga .exr keep it)");
}

/// Shows the progress of a drawing that takes longer than half a second, unless it is one of many.
Result<RenderReport> draw(RenderJob& job, Image& image, AovPlanes& planes, bool one_of_many) {
    constexpr double kDelayMs = 500;
    std::optional<ProgressLine> line;
    if (!one_of_many) {
        line.emplace(false, kDelayMs);
        job.execution.progress = [&line](double share) { line->show(share); };
    }
    Target target = target_of(job, image);
    planes.add_to(target);
    return Renderer().render(*job.prepared, job.light, job.camera, job.settings, target, job.timed_execution());
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

/// Leaves the shard's rows in the region. Parts are joined by their colours alone, so transparent floats would lose their alpha.
Result<void> take_part(const Shard& shard, OutputFormat format, Settings& settings) {
    const Region whole = settings.region;
    settings.region = shard.rows_of(whole);
    if (settings.region.height == 0)
        return fail(ErrorCode::usage, fmt::format("--shard {}/{}: expected at most {} shards, one for each row of the picture", shard.index,
                                                  shard.count, whole.height));
    if (is_linear(format) && settings.background_linear.w < 1.0f && !settings.background_environment)
        return fail(ErrorCode::usage, "--shard: halflit merge joins no transparent floats; expected .png, .bmp or .tga");
    return {};
}

Result<PictureFile> drawn_and_encoded(PictureOptions& options, bool one_of_many) {
    if (is_folder(options.output))
        return fail(ErrorCode::io, options.output + ": " + platform::errno_text(EISDIR) + " (-o " + options.output + "/ writes into it)");
    const auto format = options.picture_format();
    if (!format) return tl::unexpected(format.error());
    if (const auto checked = check_paths(options); !checked) return tl::unexpected(checked.error());
    std::vector<std::string> paths = options.pictures();
    if (!options.report.empty()) paths.push_back(options.report);
    for (const std::string& path : paths)
        if (const auto checked = check_writable(path); !checked) return tl::unexpected(checked.error());
    warn_of_lost_transparency(options, *format);
    auto job = make_render_job(options);
    if (!job) return tl::unexpected(job.error());
    if (const auto checked = spare_inputs(options, *job); !checked) return tl::unexpected(checked.error());
    std::optional<Region> part_of;
    if (options.shard && !one_of_many) {
        part_of = job->settings.region;
        if (const auto part = take_part(*options.shard, *format, job->settings); !part) return tl::unexpected(part.error());
    }
    Image image = make_image(*job, is_linear(*format));
    AovPlanes planes(options.aovs, *job);
    const auto rendered = draw(*job, image, planes, one_of_many);
    if (!rendered) return fail(rendered.error().code, job->source.name + ": " + rendered.error().message);
    PictureFile picture;
    picture.output = options.output;
    picture.part_of = part_of;
    picture.shard = options.shard;
    picture.place = options.place;
    picture.blank = options.blank_check && is_blank(image, *rendered);
    if (picture.blank) job->warnings.push_back(job->source.name + ": nothing is seen in its picture");
    for (const auto& warnings : {job->warnings, rendered->warnings})
        for (const std::string& warning : warnings) {
            const bool says_which = !one_of_many || warning.starts_with(job->source.name);
            print_warning(says_which ? warning : job->source.name + ": " + warning);
        }

    const Stopwatch encoding;
    auto bytes = encode_image(image, *format);
    if (!bytes) return tl::unexpected(bytes.error());
    picture.bytes = std::move(*bytes);
    picture.file_hash = pixel_hash(picture.bytes);
    if (const auto derived = planes.derive(*job, job->camera); !derived) return tl::unexpected(derived.error());
    auto beside = planes.encode(options.output);
    if (!beside) return tl::unexpected(beside.error());
    picture.beside = std::move(*beside);
    const double encode_ms = encoding.ms();
    // Whatever can fail comes before the picture has its name.
    picture.report = picture_report(picture, *job, *rendered, image, encode_ms, one_of_many);
    print_choices(*job, *rendered, encode_ms);
    return picture;
}

}  // namespace

Result<void> spare_inputs(PictureOptions& options, const RenderJob& job) {
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

std::vector<std::string> PictureOptions::pictures() const {
    std::vector<std::string> paths{output};
    for (std::string& path : aov_paths(output, aovs)) paths.push_back(std::move(path));
    return paths;
}

Result<OutputFormat> PictureOptions::picture_format() const {
    if (format) return *format;
    return output_format_of(output);
}

std::string default_output(const std::string& scene, std::optional<OutputFormat> format) {
    const std::string stem = stem_of(scene);
    const bool file = !scene.empty() && scene != "-" && !stem.empty();
    return (file ? stem.substr(0, stem.find(':')) : "halflit") + "." + std::string(output_format_name(format.value_or(OutputFormat::png)));
}

Result<void> check_report(const std::string& path) {
    if (is_free_or_begins_with(path, '{')) return {};
    return fail(ErrorCode::usage, "--report: expected a new file or an earlier report, found '" + path + "', which is neither");
}

Result<void> check_paths(const PictureOptions& options) {
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
        if (!options.camera_file.empty() && same_file(path, options.camera_file))
            return fail(ErrorCode::io, path + ": is the file of cameras itself and is not overwritten");
        if (!options.environment.empty() && same_file(path, options.environment))
            return fail(ErrorCode::io, path + ": is the environment itself and is not overwritten");
    }
    return check_report(options.report);
}

Result<PictureFile> draw_picture(PictureOptions& options, bool one_of_many) {
    return within_memory(options, [&] { return drawn_and_encoded(options, one_of_many); });
}

Result<void> write_with_aovs(const std::string& output, std::span<const std::uint8_t> bytes, const AovFiles& beside) {
    for (const AovFile& file : beside.files)
        if (const auto written = io::write_file(file.path, file.bytes); !written) return tl::unexpected(written.error());
    if (const auto written = io::write_file(output, bytes); !written) return tl::unexpected(written.error());
    return {};
}

Result<void> write_picture(const PictureFile& picture, bool one_of_many) {
    if (const auto written = write_with_aovs(picture.output, picture.bytes, picture.beside); !written) return written;
    std::string note = "wrote " + picture.output;
    for (const AovFile& file : picture.beside.files) note += ", " + file.path;
    if (picture.output != "-") (one_of_many ? print_detail : print_note)(note);
    return {};
}

}  // namespace halflit::cli
