// halflit diff: the difference of two pictures, in 8-bit codes.
#include "apps/halflit/commands.hpp"
#include "apps/halflit/file_names.hpp"
#include "apps/halflit/picture_diff.hpp"
#include "apps/halflit/run_report.hpp"
#include "apps/halflit/text_file.hpp"
#include "apps/halflit/values.hpp"
#include "apps/io/atomic_file.hpp"
#include "apps/io/file_access.hpp"
#include "apps/io/image_reader.hpp"
#include "halflit/image.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace halflit::cli {
namespace {

struct DiffOptions {
    std::string a, b;
    int max_codes = 0;
    bool json = false;
    std::string output;  ///< empty: no difference image
};

Result<Image> read_picture(const std::string& path) {
    const auto file = io::read_file(path);
    if (!file) return fail(file.error().code, file.error().message + did_you_mean_file(path));
    auto decoded = io::decode_image(*file);
    if (!decoded) return fail(decoded.error().code, path + ": " + decoded.error().message);
    return Image{decoded->width, decoded->height, std::move(decoded->rgba8), {}};
}

Result<void> write_difference(const std::string& path, const Image& a, const Image& b) {
    const auto format = output_format_of(path);
    if (!format) return tl::unexpected(format.error());
    if (is_linear(*format)) return fail(ErrorCode::usage, path + ": expected a picture of 8-bit codes (.png .jpg .bmp .tga)");
    const auto bytes = encode_image(difference_image(a, b), *format);
    if (!bytes) return tl::unexpected(bytes.error());
    return io::write_file(path, *bytes);
}

std::string text_of(const PictureDiff& diff) {
    return fmt::format("max {} codes, mean {:.6g} codes, {} of {} pixels differ, PSNR {}\n", diff.max, diff.mean(), diff.count, diff.pixels,
                       diff.psnr() ? fmt::format("{:.2f} dB", *diff.psnr()) : "infinite");
}

Json json_of(const PictureDiff& diff) {
    const auto psnr = diff.psnr();
    return {{"max", diff.max},
            {"mean", diff.mean()},
            {"count", diff.count},
            {"pixels", diff.pixels},
            {"psnr", psnr ? Json(*psnr) : Json(nullptr)}};
}

Result<int> run_diff(const DiffOptions& options) {
    if (options.output == "-") return fail(ErrorCode::usage, "-o: expected a file name; standard output is for the numbers");
    const auto a = read_picture(options.a);
    if (!a) return tl::unexpected(a.error());
    const auto b = read_picture(options.b);
    if (!b) return tl::unexpected(b.error());
    if (a->width != b->width || a->height != b->height)
        return fail(ErrorCode::bad_input,
                    fmt::format("{}: {}x{}, expected {}x{} as {}", options.b, b->width, b->height, a->width, a->height, options.a));
    const PictureDiff diff = compare_pictures(*a, *b);
    if (!options.output.empty())
        if (const auto written = write_difference(options.output, *a, *b); !written) return tl::unexpected(written.error());
    const std::string text = options.json ? to_text(json_of(diff)) : text_of(diff);
    if (const auto written = write_text("-", text); !written) return tl::unexpected(written.error());
    return diff.max > options.max_codes ? static_cast<int>(ErrorCode::negative_result) : 0;
}

}  // namespace

Command diff_command() {
    const auto options = std::make_shared<DiffOptions>();
    DiffOptions& o = *options;
    return {
        "diff",
        "Compare two PNG or JPEG pictures; exit code 1 if they differ by more than --max",
        {{.name = "A", .help = "The expected picture", .read = read_text(o.a), .required = true, .form = "FILE"},
         {.name = "B", .help = "The picture to compare with it", .read = read_text(o.b), .required = true, .form = "FILE"}},
        {{"Flags",
          {{"--max", "CODES", "Largest difference in any channel that still passes, 0 to 255 (default 0)", read_int(o.max_codes, 0, 255)},
           {"--json", "", "Print one JSON object", set_to(o.json)},
           {"-o,--output", "FILE", "Write the absolute differences as a picture, stretched to the full range", read_text(o.output)}}}},
        [options] { return run_diff(*options); }};
}

}  // namespace halflit::cli
