// halflit compare: what changed between two versions of a model, in pictures and numbers.
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/compare/comparison.hpp"
#include "apps/halflit/program/file_names.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/output_folder.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "apps/halflit/program/timeout.hpp"
#include "apps/halflit/report/measures_json.hpp"
#include "halflit/image.hpp"
#include "sh/vec3d.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>
#include <new>

namespace halflit::cli {
namespace {

constexpr const char* kSheetName = "compare.png";

/// Draws each view of both, and compares them.
Result<void> compare_views(ModelPair& pair, Comparison& out) {
    SeenTriangles seen_a(pair.a.scene()), seen_b(pair.b.scene());
    Renderer renderer;
    const ShotPlanes planes{.picture = true, .depth = true, .normal = true};
    for (std::size_t i = 0; i < pair.cameras.size(); ++i) {
        const Camera& camera = pair.cameras[i];
        auto a = draw_shot(pair.a, renderer, pair.view_names[i], camera, planes);
        if (!a) return tl::unexpected(a.error());
        auto b = draw_shot(pair.b, renderer, pair.view_names[i], camera, planes);
        if (!b) return tl::unexpected(b.error());
        seen_a.add(a->instance, a->triangle), seen_b.add(b->instance, b->triangle);
        const Vec4f &eye = camera.world_from_camera.c[3], &back = camera.world_from_camera.c[2];
        const Vec3d middle = pair.bounds.empty ? Vec3d{} : to_double(pair.bounds.center());
        const double distance = dot(Vec3d{eye.x, eye.y, eye.z} - middle, Vec3d{back.x, back.y, back.z});
        out.views.push_back(compare_shots(std::move(*a), std::move(*b), out.max_codes, distance));
    }
    out.models.a.unseen_area = seen_a.unseen_area();
    out.models.b.unseen_area = seen_b.unseen_area();
    return {};
}

Result<Comparison> compare_files(const CompareOptions& options) {
    auto pair = load_pair(options);
    if (!pair) return tl::unexpected(pair.error());
    Comparison out;
    out.a = options.a, out.b = options.b;
    out.unit = unit_name(pair->a.source);
    out.max_codes = options.max_codes;
    out.scale = pair->scale();
    out.warnings = pair->warnings;
    if (unit_name(pair->b.source) != out.unit) {
        out.warnings.push_back("only one of the files has a unit of length; both are compared by their numbers");
        out.unit.clear();
    }
    auto models = compare_models(*pair);
    if (!models) return tl::unexpected(models.error());
    out.models = std::move(*models);
    if (const auto compared = compare_views(*pair, out); !compared) return tl::unexpected(compared.error());
    return out;
}

/// The sheet's path as a comment refers to it: relative to the comment's folder.
std::string sheet_for(const CompareOptions& options) {
    namespace fs = std::filesystem;
    if (options.folder.empty()) return "";
    const std::string sheet = path_in(options.folder, kSheetName);
    if (options.markdown == "-") return sheet;
    std::error_code error;
    const fs::path relative = fs::proximate(sheet, fs::absolute(options.markdown, error).parent_path(), error);
    return error ? sheet : relative.generic_string();
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
    auto groups = render_flags(o, kCompareSize);
    constexpr std::string_view kLeftOut[] = {"--region",  "--camera",    "--camera-position", "--camera-target",
                                             "--azimuth", "--elevation", "--ortho",           "--orthographic"};
    remove_flags(groups, kLeftOut);
    groups.insert(
        groups.begin(),
        {"Comparison",
         {{"-o,--output", "DIR", "Folder for index.html, a page that holds its pictures, and compare.png",
           [&o](const std::string& text) { return assign(o.folder, parse_folder(text)); }},
          {"--json", "FILE", "Write the numbers as one JSON object; - is standard output", read_text(o.json)},
          {"--markdown", "FILE", "Write a comment for a pull request, with the picture of -o; - is standard output", read_text(o.markdown)},
          {"--max", "CODES", "Largest difference of a colour's channel that is no change, 0 to 255 (default 2)",
           read_int(o.max_codes, 0, 255)}}});
    Positional a = scene_argument(o, true), b = scene_argument(o, true);
    a.name = "A", a.help = "The first version: " + a.help, a.read = read_text(o.a);
    b.name = "B", b.help = "The second version", b.read = read_text(o.b);
    return {
        "compare",
        "Compare two versions of a model: pictures by one camera, parts, measures and the distance of the surfaces; exit code 1 if they "
        "differ",
        {std::move(a), std::move(b)},
        std::move(groups),
        [options] { return run_compare(*options); }};
}

}  // namespace halflit::cli
