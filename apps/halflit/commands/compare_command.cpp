// halflit compare: what changed between two versions of a model, in pictures and numbers.
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/output_folder.hpp"
#include "apps/engine/basics/timeout.hpp"
#include "apps/engine/compare/compare_files.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "apps/io/platform/paths.hpp"
#include "halflit/image.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>
#include <new>

namespace halflit::cli {
namespace {

constexpr const char* kSheetName = "compare.png";

/// The sheet's path as a comment refers to it: relative to the comment's folder.
std::string sheet_for(const CompareOptions& options) {
    namespace fs = std::filesystem;
    if (options.folder.empty()) return "";
    const std::string sheet = path_in(options.folder, kSheetName);
    if (options.markdown == "-") return sheet;
    std::error_code error;
    const fs::path relative =
        fs::proximate(platform::to_path(sheet), fs::absolute(platform::to_path(options.markdown), error).parent_path(), error);
    return error ? sheet : platform::to_name(relative);
}

Result<void> write_reports(const CompareOptions& options, const Comparison& comparison) {
    if (!options.folder.empty()) {
        if (const auto made = make_folder(options.folder); !made) return made;
        const auto sheet = comparison_sheet(comparison);
        if (!sheet) return tl::unexpected(sheet.error());
        if (const auto written = write_image(path_in(options.folder, kSheetName), *sheet); !written) return written;
        const auto page = comparison_page(comparison);
        if (!page) return tl::unexpected(page.error());
        const std::string path = path_in(options.folder, "index.html");
        if (const auto written = write_text(path, *page); !written) return written;
        print_note("wrote " + path);
    }
    if (!options.markdown.empty())
        if (const auto written = write_text(options.markdown, comparison_markdown(comparison, sheet_for(options))); !written)
            return written;
    if (!options.json.empty())
        if (const auto written = write_text(options.json, to_text(comparison_json(comparison))); !written) return written;
    if (options.json != "-" && options.markdown != "-") return write_text("-", comparison_text(comparison));
    return {};
}

Result<void> check_outputs(const CompareOptions& options) {
    if (options.json == "-" && options.markdown == "-") return fail(ErrorCode::usage, "--markdown -: standard output is taken by --json -");
    if (options.a == "-" && options.b == "-") return fail(ErrorCode::usage, "B: expected another input than standard input, which A is");
    for (const std::string& output : {options.json, options.markdown})
        for (const std::string& input : {options.a, options.b})
            if (!output.empty() && output != "-" && same_file(output, input))
                return fail(ErrorCode::io, printable(output) + ": is compared and is not overwritten");
    if (!is_free_or_begins_with(options.json, '{'))
        return fail(ErrorCode::usage, "--json: expected a new file or an earlier report, found '" + printable(options.json) + "'");
    if (!is_free_or_begins_with(options.markdown, '*'))
        return fail(ErrorCode::usage, "--markdown: expected a new file or an earlier comment, found '" + printable(options.markdown) + "'");
    return {};
}

Result<int> run_compare(const CompareOptions& options) {
    if (const auto checked = check_outputs(options); !checked) return tl::unexpected(checked.error());
    try {
        const auto comparison = within_time(options.timeout_s, [&] { return compare_files(options); });
        if (!comparison) return tl::unexpected(comparison.error());
        for (const std::string& warning : comparison->warnings) print_warning(warning);
        if (const auto written = write_reports(options, *comparison); !written) return tl::unexpected(written.error());
        return comparison->differs() ? static_cast<int>(ErrorCode::negative_result) : 0;
    } catch (const std::bad_alloc&) {
        return fail(ErrorCode::limit, "compare: out of memory");
    }
}

}  // namespace

Command compare_command() {
    const auto options = std::make_shared<CompareOptions>();
    CompareOptions& o = *options;
    auto groups = compare_flags(o);
    groups.insert(groups.begin(),
                  {"Comparison",
                   {{"-o,--output", "DIR", "Folder for the result: index.html, a page that holds its pictures, and compare.png",
                     [&o](const std::string& text) { return assign(o.folder, parse_folder(text)); }},
                    {"--json", "FILE", "Write the numbers as one JSON object; - is standard output", read_text(o.json)},
                    {"--markdown", "FILE", "Write a comment for a pull request; it shows the picture of -o; - is standard output",
                     read_text(o.markdown)}}});
    Positional a = scene_argument(o, true), b = scene_argument(o, true);
    a.name = "A", a.help = "The first version: " + a.help, a.read = read_text(o.a);
    b.name = "B", b.help = "The second version", b.read = read_text(o.b);
    return {
        "compare",
        "Compare two versions of a model: pictures by one camera, parts, measures and the distance of the surfaces; exit code 1 if they "
        "differ",
        {std::move(a), std::move(b)},
        std::move(groups),
        [options] { return run_compare(*options); },
        Command::Listed::by_help,
        {"halflit compare old.stl new.stl", "halflit compare old.stl new.stl -o changes --view front,iso",
         "halflit compare old.stl new.stl --json changes.json --markdown comment.md"},
        {"--output", "--json", "--markdown", "--view", "--size", "--up", "--only", "--max"}};
}

}  // namespace halflit::cli
