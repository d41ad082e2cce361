// halflit diff: the difference of two pictures, or of two folders of pictures, in 8-bit codes.
#include "apps/engine/answers/picture_compare.hpp"
#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/request/values.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "halflit/image.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace halflit::cli {
namespace {

struct DiffOptions {
    std::string a, b;
    DiffTolerance tolerance;
    bool json = false;
    std::string output;  ///< empty: no difference picture
};

std::string text_of(const PictureDiff& diff) {
    return fmt::format("max {} codes, mean {:.6g} codes, {} of {} pixels differ, PSNR {}\n", diff.max, diff.mean(), diff.count, diff.pixels,
                       diff.psnr() ? fmt::format("{:.2f} dB", *diff.psnr()) : "infinite");
}

Json head_of(const DiffOptions& options) {
    Json head = report_head("diff");
    head["tolerance"] = {{"max_codes", options.tolerance.max_codes}, {"max_share", options.tolerance.max_share}};
    return head;
}

Result<int> run_files(const DiffOptions& options) {
    for (const std::string& path : {options.a, options.b})
        if (is_model_name(path) && is_file(options.a) && is_file(options.b))
            return fail(ErrorCode::usage, printable(path) + ": is a model: halflit compare shows how models differ");
    if (!options.output.empty()) {
        const auto format = output_format_of(options.output);
        if (!format) return tl::unexpected(format.error());
        if (is_linear(*format))
            return fail(ErrorCode::usage, printable(options.output) + ": expected a picture of 8-bit codes (.png .jpg .bmp .tga)");
    }
    const auto file = diff_files(options.a, options.b, options.tolerance, options.b, options.output);
    if (!file) return tl::unexpected(file.error());
    if (file->status == DiffStatus::size)
        return fail(ErrorCode::bad_input, fmt::format("{}: {} as {}", printable(options.b), file->message, printable(options.a)));
    Json json = head_of(options);
    json["passed"] = file->passed();
    json.update(diff_json(*file->diff, options.tolerance));
    if (const auto written = write_text("-", options.json ? to_text(json) : text_of(*file->diff)); !written)
        return tl::unexpected(written.error());
    return file->passed() ? 0 : static_cast<int>(ErrorCode::negative_result);
}

Result<int> run_folders(const DiffOptions& options) {
    const auto files = diff_folders(options.a, options.b, options.tolerance, options.output);
    if (!files) return tl::unexpected(files.error());
    const int code = exit_code_of(*files);
    Json json = head_of(options);
    json["passed"] = code == 0;
    json.update(folders_json(*files, options.tolerance));
    if (const auto written = write_text("-", options.json ? to_text(json) : diffs_text(*files, "file")); !written)
        return tl::unexpected(written.error());
    return code;
}

Result<int> run_diff(const DiffOptions& options) {
    if (options.output == "-") return fail(ErrorCode::usage, "-o: expected a file name; standard output is for the numbers");
    for (const std::string& input : {options.a, options.b})
        if (!options.output.empty() && same_file(options.output, input))
            return fail(ErrorCode::io, printable(options.output) + ": is compared and is not overwritten");
    const bool a = is_folder(options.a), b = is_folder(options.b);
    if (a != b)
        return fail(ErrorCode::usage, fmt::format("{}: expected two files or two folders, found one of each", printable(options.b)));
    return a ? run_folders(options) : run_files(options);
}

}  // namespace

Command diff_command() {
    const auto options = std::make_shared<DiffOptions>();
    DiffOptions& o = *options;
    return {"diff",
            "Compare two pictures, or two folders of them: PNG, JPEG, BMP, TGA, or HDR, PFM, EXR by their sRGB codes; exit code 1 if they "
            "differ by more than --max and --max-share allow",
            {{.name = "A", .help = "The expected picture, or a folder", .read = read_text(o.a), .required = true, .form = "FILE"},
             {.name = "B",
              .help = "What to compare with it; files in folders are paired by their paths",
              .read = read_text(o.b),
              .required = true,
              .form = "FILE"}},
            {{"Flags",
              {{"--max", "CODES", "Largest difference in any channel that still passes, 0 to 255 (default 0)",
                read_int(o.tolerance.max_codes, 0, 255)},
               {"--max-share", "SHARE", "Share of the pixels that may differ by more, such as 0.1% or 0.001 (default 0)",
                [&o](const std::string& text) { return assign(o.tolerance.max_share, parse_share(text)); }},
               {"--json", "", "Print one JSON object", set_to(o.json)},
               {"-o,--output", "FILE|DIR",
                "Write the absolute differences as a picture, stretched to the full range; for folders a folder of such pictures",
                read_text(o.output)}}}},
            [options] { return run_diff(*options); },
            Command::Listed::by_help,
            {"halflit diff old.png new.png", "halflit diff old.png new.png --max 2 -o difference.png",
             "halflit diff expected/ drawn/ --max-share 0.1%"}};
}

}  // namespace halflit::cli
