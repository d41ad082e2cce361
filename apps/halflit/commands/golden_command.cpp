// halflit golden: draws a list of scenes, and compares them with the pictures that are expected.
#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/basics/file_names.hpp"
#include "apps/engine/basics/output_folder.hpp"
#include "apps/engine/request/values.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/golden/report.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "apps/io/platform/files.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace halflit::cli {
namespace {

struct GoldenOptions {
    std::string action, folder;
    std::vector<std::string> names;
    std::string report;  ///< empty: FOLDER/report
    std::string junit;   ///< empty: none
    std::optional<int> max_codes;
    std::optional<double> max_share;
    bool json = false;
    bool reframe = false;  ///< of update
};

Result<int> finish(const std::vector<GoldenResult>& results, const GoldenOptions& options, const std::string& text) {
    Json json = report_head("golden");
    json["action"] = options.action;
    json.update(golden_json(results));
    if (const auto written = write_text("-", options.json ? to_text(json) : text); !written) return tl::unexpected(written.error());
    return exit_code_of({results.begin(), results.end()});
}

Result<int> run_check(const GoldenOptions& options) {
    if (options.reframe) return fail(ErrorCode::usage, "golden check: takes no --reframe, which records cameras");
    const auto list = read_golden_list(options.folder);
    if (!list) return tl::unexpected(list.error());
    const auto scenes = chosen_scenes(*list, options.names);
    if (!scenes) return tl::unexpected(scenes.error());
    if (!is_free_or_begins_with(options.junit, '<'))
        return fail(ErrorCode::usage, "--junit: expected a new file or an earlier report, found '" + printable(options.junit) + "'");
    const std::string folder = options.report.empty() ? path_in(options.folder, "report") : options.report;
    if (options.report.empty() && platform::is_link(folder))
        return fail(ErrorCode::io, printable(folder) + ": is a symbolic link, which may lead out of the folder; -o names another folder");
    if (same_file(folder, options.folder))
        return fail(ErrorCode::usage, "-o: expected another folder than the list's, found '" + printable(folder) + "'");
    if (const auto made = make_folder(folder); !made) return tl::unexpected(made.error());
    const auto results = check_golden(*list, *scenes, {folder, options.max_codes, options.max_share});
    if (!results) return tl::unexpected(results.error());
    const std::string page = path_in(folder, "index.html");
    if (const auto written = write_text(page, golden_page(*list, *results)); !written) return tl::unexpected(written.error());
    print_note("wrote " + page);
    if (!options.junit.empty())
        if (const auto written = write_text(options.junit, golden_junit(*results)); !written) return tl::unexpected(written.error());
    return finish(*results, options, diffs_text({results->begin(), results->end()}, "scene"));
}

/// Summary of an update: one line for each scene that is not as before, and the number of the others.
std::string update_text(const std::vector<GoldenResult>& results) {
    std::string text;
    std::size_t unchanged = 0;
    for (const GoldenResult& result : results) {
        if (result.status == DiffStatus::equal && result.hash == result.expected_hash) {
            ++unchanged;
            continue;
        }
        const std::string numbers =
            result.diff ? fmt::format("  max {}, {} of {} pixels", result.diff->max, result.diff->count, result.diff->pixels) : "";
        const char* what = result.status == DiffStatus::failed ? "failed" : result.status == DiffStatus::missing ? "new" : "changed";
        text += fmt::format("{:<8}  {}{}{}\n", what, result.path, result.status == DiffStatus::missing ? "" : numbers,
                            result.message.empty() ? "" : "  " + printable(result.message));
    }
    return text + fmt::format("{} scene{}, {} unchanged\n", results.size(), results.size() == 1 ? "" : "s", unchanged);
}

Result<int> run_update(const GoldenOptions& options) {
    if (!options.report.empty() || !options.junit.empty() || options.max_codes || options.max_share)
        return fail(ErrorCode::usage, "golden update: takes no -o, --junit, --max or --max-share");
    if (!has_golden_list(options.folder)) {
        if (const auto made = make_golden_list(options.folder); !made) return tl::unexpected(made.error());
        print_note("wrote " + path_in(options.folder, "golden.json"));
    }
    auto list = read_golden_list(options.folder);
    if (!list) return tl::unexpected(list.error());
    const auto scenes = chosen_scenes(*list, options.names);
    if (!scenes) return tl::unexpected(scenes.error());
    const auto before = list->hashes;
    const auto cameras_before = list->cameras;
    auto results = update_golden(*list, *scenes, options.reframe);
    for (const auto& [name, hash] : before)
        if (std::none_of(list->scenes.begin(), list->scenes.end(),
                         [&, &name = name](const GoldenScene& scene) { return scene.name == name; })) {
            list->hashes.erase(name);
            print_note(fmt::format("{} is no longer in the list; {} is left", name, printable(list->picture(name))));
        }
    std::erase_if(list->cameras, [&](const auto& camera) {
        return std::none_of(list->scenes.begin(), list->scenes.end(), [&](const GoldenScene& scene) { return scene.name == camera.first; });
    });
    if (list->hashes != before)
        if (const auto written = write_golden_hashes(*list); !written) return tl::unexpected(written.error());
    if (list->cameras != cameras_before)
        if (const auto written = write_golden_cameras(*list); !written) return tl::unexpected(written.error());
    const std::string text = update_text(results);
    std::vector<DiffedFile> failed;
    std::copy_if(results.begin(), results.end(), std::back_inserter(failed),
                 [](const GoldenResult& result) { return result.status == DiffStatus::failed; });
    const auto done = finish(results, options, text);
    return done ? Result<int>(exit_code_of(failed)) : done;  // a change is what was asked for
}

Result<int> run_golden(const GoldenOptions& options) {
    if (options.action == "check") return run_check(options);
    if (options.action == "update") return run_update(options);
    return fail(ErrorCode::usage, "ACTION: expected check or update, found '" + printable(options.action) + "'");
}

}  // namespace

Command golden_command() {
    const auto options = std::make_shared<GoldenOptions>();
    GoldenOptions& o = *options;
    return {"golden",
            "Compare the scenes of DIR/golden.json with their expected pictures; exit code 1 if one differs",
            {{.name = "ACTION",
              .help = "check: compare; update: write the expected pictures that have changed",
              .read = read_text(o.action),
              .required = true},
             {.name = "DIR",
              .help = "Folder with golden.json; update makes it from all models below DIR if it is missing",
              .read = read_text(o.folder),
              .required = true,
              .form = "DIR"},
             {.name = "NAME", .help = "Scenes of the list; without a name, all of them", .read = append_to(o.names), .repeated = true}},
            {{"Flags", {{"--json", "", "Print one JSON object", set_to(o.json)}}},
             {"Update",
              {{"--reframe", "", "Frame the pictures anew (default: by the cameras that were recorded when they were first drawn)",
                set_to(o.reframe)}}},
             {"Check",
              {{"-o,--output", "DIR", "Folder for index.html and the pictures that differ (default DIR/report)",
                [&o](const std::string& text) { return assign(o.report, parse_folder(text)); }},
               {"--junit", "FILE", "Write the results as JUnit XML", read_text(o.junit)},
               {"--max", "CODES", "Largest difference in any channel that still passes, 0 to 255 (default: the list's, or 0)",
                [&o](const std::string& text) -> Result<void> { return assign(o.max_codes, parse_int(text, 0, 255)); }},
               {"--max-share", "SHARE", "Share of the pixels that may differ by more, such as 0.1% or 0.001 (default: the list's, or 0)",
                [&o](const std::string& text) { return assign(o.max_share, parse_share(text)); }}}}},
            [options] { return run_golden(*options); },
            Command::Listed::by_help,
            {"halflit golden update models", "halflit golden check models", "halflit golden check models -o report --junit report.xml"}};
}

}  // namespace halflit::cli
