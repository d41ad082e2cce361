// halflit merge: verifies what shards have drawn, and joins it.
#include "apps/engine/basics/file_names.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/farm/shard_reports.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/io/files/atomic_file.hpp"
#include "apps/io/pictures/float_image.hpp"
#include "apps/io/pictures/picture_reader.hpp"
#include "halflit/image.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>

namespace halflit::cli {
namespace {

struct MergeOptions {
    std::vector<std::string> reports;
    std::string output;  ///< empty: verify alone
    bool dither = false;
};

/// A part or frame as it was drawn; floats in rgba_linear, opaque. Its codes have the report's hash.
Result<Image> decode(const ReportedPicture& picture, std::span<const std::byte> bytes) {
    const int any_side = std::numeric_limits<int>::max();
    const auto prefixed = [&](const Error& error) { return fail(error.code, picture.path + ": " + error.message); };
    Image image;
    if (io::is_float_image(bytes)) {
        auto floats = io::decode_float_image(bytes, {any_side, any_side, static_cast<std::size_t>(kMaxImagePixels)});
        if (!floats) return prefixed(floats.error());
        image = {floats->width, floats->height, {}, {}};
        for (std::size_t i = 0; i < floats->rgb.size(); i += 3)
            image.rgba_linear.insert(image.rgba_linear.end(), {floats->rgb[i], floats->rgb[i + 1], floats->rgb[i + 2], 1.0f});
    } else {
        auto codes = io::decode_picture(bytes, picture.path, {any_side, static_cast<std::size_t>(kMaxImagePixels)});
        if (!codes) return prefixed(codes.error());
        image = std::move(*codes);
        const bool lossy = output_format_of(picture.path).value_or(OutputFormat::png) == OutputFormat::jpg;
        const std::string hash = fmt::format("{:016x}", pixel_hash(image.rgba8));
        if (!lossy && !picture.pixel_hash.empty() && hash != picture.pixel_hash)
            return fail(ErrorCode::negative_result,
                        fmt::format("{}: expected pixels with the hash {}, found {}", picture.path, picture.pixel_hash, hash));
    }
    if (!picture.pixel_hash.empty() && (image.width != picture.region.width || image.height != picture.region.height))
        return fail(ErrorCode::negative_result, fmt::format("{}: expected {}x{} pixels, found {}x{}", picture.path, picture.region.width,
                                                            picture.region.height, image.width, image.height));
    return image;
}

/// Reads every picture, so that each is known to be the one that was drawn; `use` takes it where the output needs it.
template <class Use>
Result<void> for_each_picture(const ReportedRun& run, bool decoded, Use use) {
    for (const ReportedPicture& picture : run.pictures) {
        const auto bytes = read_verified(picture);
        if (!bytes) return tl::unexpected(bytes.error());
        if (!decoded) continue;
        const auto image = decode(picture, *bytes);
        if (!image) return tl::unexpected(image.error());
        if (const auto used = use(picture, *image); !used) return used;
    }
    return {};
}

Result<void> verify(const ReportedRun& run) {
    return for_each_picture(run, false, [](const ReportedPicture&, const Image&) -> Result<void> { return {}; });
}

/// Bands of rows, one below the other.
Result<std::vector<std::uint8_t>> join_parts(const ReportedRun& run, const MergeOptions& options) {
    const auto format = output_format_of(options.output);
    if (!format) return tl::unexpected(format.error());
    const Region& whole = *run.pictures[0].file.part_of;
    Image joined{whole.width, whole.height, {}, {}};
    const auto done = for_each_picture(run, true, [&](const ReportedPicture& part, const Image& image) -> Result<void> {
        if (is_linear(*format) != image.rgba8.empty())
            return fail(ErrorCode::usage, fmt::format("-o {}: expected {}, as the parts are ({})", options.output,
                                                      image.rgba8.empty() ? "a file of floats" : "a file of 8-bit codes", part.path));
        joined.rgba8.insert(joined.rgba8.end(), image.rgba8.begin(), image.rgba8.end());
        joined.rgba_linear.insert(joined.rgba_linear.end(), image.rgba_linear.begin(), image.rgba_linear.end());
        return {};
    });
    if (!done) return tl::unexpected(done.error());
    if (!joined.rgba8.empty()) std::printf("pixel_hash %016llx\n", static_cast<unsigned long long>(pixel_hash(joined.rgba8)));
    return encode_image(joined, *format);
}

Result<std::vector<std::uint8_t>> join_frames(const ReportedRun& run, const MergeOptions& options) {
    const auto format = film::film_format_of(options.output);
    if (!format) return fail(ErrorCode::usage, fmt::format("-o {}: expected a .gif, .apng or .webp file for frames", options.output));
    std::unique_ptr<film::FilmWriter> writer;
    const auto done = for_each_picture(run, true, [&](const ReportedPicture& frame, const Image& image) -> Result<void> {
        if (image.rgba8.empty()) return fail(ErrorCode::usage, frame.path + ": expected a picture of 8-bit codes, found floats");
        const FilmFrame& of = *frame.file.frame;
        if (!writer) {
            auto made =
                film::make_film_writer(*format, {image.width, image.height, run.pictures.size(), of.time, of.opaque, options.dither});
            if (!made) return tl::unexpected(made.error());
            writer = std::move(*made);
        }
        return writer->add(image);
    });
    if (!done) return tl::unexpected(done.error());
    return writer->finish();
}

Result<std::vector<std::uint8_t>> join(const ReportedRun& run, const MergeOptions& options) {
    switch (run.kind) {
        case ReportedRun::Kind::parts:
            return join_parts(run, options);
        case ReportedRun::Kind::film:
            return join_frames(run, options);
        case ReportedRun::Kind::scenes:
            break;
    }
    return fail(ErrorCode::usage, "-o: expected reports of frames or of parts of a picture; those of many scenes are only verified");
}

Result<void> check_output(const MergeOptions& options) {
    if (options.output.empty()) return {};
    if (options.output == "-") return fail(ErrorCode::usage, "-o: expected a file name, found -");
    if (const auto format = film::film_format_of(options.output))
        if (const auto checked = film::check_film_format(options.output, *format); !checked) return checked;
    return check_writable(options.output);
}

/// Names pictures whose file is gone, up to ten. False: none is.
bool tell_lost(const ReportedRun& run) {
    constexpr std::size_t kShown = 10;
    std::size_t lost = 0;
    for (const ReportedPicture& picture : run.pictures) {
        if (is_there(picture.path) || lost++ >= kShown) continue;
        const auto& shard = picture.file.shard;
        print_error(picture.path + " is not there" + (shard ? fmt::format("; of shard {} of {}", shard->index, shard->count) : ""));
    }
    if (lost > kShown) print_error(fmt::format("and {} more", lost - kShown));
    return lost > 0;
}

Result<int> run_merge(const MergeOptions& options) {
    if (const auto checked = check_output(options); !checked) return tl::unexpected(checked.error());
    const auto run = read_reports(options.reports);
    if (!run) return tl::unexpected(run.error());
    for (const std::string& failure : run->failures) print_error(failure);
    if (run->pictures.empty()) return fail(ErrorCode::negative_result, "the reports name no picture");
    const std::string missing = missing_of(*run);
    if (!missing.empty()) print_error(missing);
    const bool lost = tell_lost(*run);
    if (lost || !missing.empty() || !run->failures.empty()) return static_cast<int>(ErrorCode::negative_result);
    if (options.output.empty()) {
        if (const auto verified = verify(*run); !verified) return tl::unexpected(verified.error());
    } else {
        for (const ReportedPicture& picture : run->pictures)
            if (same_file(options.output, picture.path))
                return fail(ErrorCode::io, options.output + ": is read for the output and is not overwritten");
        const auto bytes = join(*run, options);
        if (!bytes) return tl::unexpected(bytes.error());
        if (const auto written = io::write_file(options.output, *bytes); !written) return tl::unexpected(written.error());
    }
    const auto unknown = std::count_if(run->pictures.begin(), run->pictures.end(), [](const auto& p) { return p.file.file_hash == 0; });
    if (unknown > 0)
        print_warning(
            fmt::format("{} of {} pictures were there before their run, so their hashes are not known", unknown, run->pictures.size()));
    print_note(fmt::format("{}{} of {} are complete{}", options.output.empty() ? "" : "wrote " + options.output + ": ",
                           run->pictures.size(), run->pictures.size(), unknown == 0 ? " and have the hashes of their reports" : ""));
    return 0;
}

}  // namespace

Command merge_command() {
    const auto options = std::make_shared<MergeOptions>();
    MergeOptions& o = *options;
    Positional reports{.name = "REPORT",
                       .help = "Reports of halflit render --shard I/N --report FILE",
                       .read = append_to(o.reports),
                       .required = true,
                       .repeated = true,
                       .form = "FILE",
                       .usage = "REPORT..."};
    return {
        "merge",
        "Verify that the pictures of all shards are there and have the hashes of their reports, and join parts or frames; exit code 1 if "
        "not",
        {std::move(reports)},
        {{"Flags",
          {{"-o,--output", "FILE", "Join parts into a picture, or frames into one .gif, .apng or .webp file; without it, verify alone",
            read_text(o.output)},
           {"--dither", "", "GIF: mix its 256 colours by an ordered pattern", set_to(o.dither)}}}},
        [options] { return run_merge(*options); }};
}

}  // namespace halflit::cli
