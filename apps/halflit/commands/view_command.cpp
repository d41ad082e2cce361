// halflit view: shows a scene in a window, where it can be turned and its settings be changed.
#include "apps/engine/answers/pixel_story_json.hpp"
#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/basics/median.hpp"
#include "apps/engine/basics/spelling.hpp"
#include "apps/engine/job/render_job.hpp"
#include "apps/engine/request/setting_flags.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "apps/io/platform/process.hpp"
#include "apps/viewer/viewer.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <memory>
#include <numeric>

namespace halflit::cli {
namespace {

struct ViewOptions : RenderOptions {
    viewer::ViewerOptions window;
    std::string report;
};

Json view_report(const ViewOptions& options, const viewer::ViewerSummary& summary, const NameOfInstance& name) {
    Json report = report_head("view");
    report["scene"] = options.scene;
    report["size"] = {summary.width, summary.height};
    report["window"] = {summary.window_width, summary.window_height};
    report["first_picture_ms"] = summary.first_picture_ms;
    report["all_samples_ms"] = summary.finished_ms;
    report["worst_loop_ms"] = summary.worst_loop_ms;
    report["frames"] = summary.frame_ms.size();
    if (!summary.frame_ms.empty()) {
        const auto& ms = summary.frame_ms;
        const double total = std::accumulate(ms.begin(), ms.end(), 0.0);
        report["frames_per_second"] = 1000.0 * static_cast<double>(ms.size()) / total;
        report["median_ms"] = median(ms);
        report["worst_ms"] = *std::max_element(ms.begin(), ms.end());
        report["draw_median_ms"] = median(summary.draw_ms);
        report["draw_worst_ms"] = *std::max_element(summary.draw_ms.begin(), summary.draw_ms.end());
        report["largest_divisor"] = *std::max_element(summary.divisors.begin(), summary.divisors.end());
    }
    if (summary.story) report["pixel"] = story_json(*summary.story, name);
    return report;
}

Result<int> run_view(ViewOptions options) {
    if (!viewer::has_viewer())
        return fail(ErrorCode::usage,
                    "view: needs the libraries SDL2 and Dear ImGui (libsdl2-dev and libimgui-dev in Debian; ./dev view "
                    "installs them and builds it), which this build lacks: " +
                        viewer::missing_libraries());
    viewer::RehearsalPlan& rehearsal = options.window.rehearsal;
    rehearsal.wanted = rehearsal.orbit_frames > 0 || rehearsal.click || !options.window.screenshot.empty() || !options.report.empty();
    if (options.max_memory_bytes == 0) platform::prepare_heap();
    if (options.settings.region.width > 0) return fail(ErrorCode::usage, "--region: not in a window");
    options.may_want_reference = true;  // the error of a pixel that is clicked on
    auto job = make_render_job(options);
    if (!job) return tl::unexpected(job.error());
    if (rehearsal.click && (rehearsal.click->x >= job->width || rehearsal.click->y >= job->height))
        return fail(ErrorCode::usage,
                    "--click: expected a pixel of the " + std::to_string(job->width) + "x" + std::to_string(job->height) + " picture");
    for (const std::string& warning : job->warnings) print_warning(warning);
    for (const std::string& choice : job->choices) print_detail(choice);
    const NameOfInstance name = names_of(job->source.parts);
    const auto seen = viewer::run_viewer(std::move(*job), options, options.window);
    if (!seen) return tl::unexpected(seen.error());
    if (options.report.empty()) return 0;
    if (const auto written = write_text(options.report, to_text(view_report(options, *seen, name))); !written)
        return tl::unexpected(written.error());
    return 0;
}

Result<void> read_click(std::optional<viewer::RehearsalPlan::Pixel>& pixel, const std::string& text) {
    const auto place = parse_pixel(text);
    if (!place) return tl::unexpected(place.error());
    pixel = {place->x, place->y};
    return {};
}

Result<void> read_tab(viewer::Tab& tab, const std::string& text) {
    const auto place = read_value(raster::named(viewer::kTabNames), text);
    return place.map([&](double index) { tab = static_cast<viewer::Tab>(static_cast<int>(index)); });
}

}  // namespace

Command view_command() {
    const auto options = std::make_shared<ViewOptions>();
    auto groups = render_flags(*options, kRenderSize);
    constexpr std::string_view kLeftOut[] = {"--region"};
    remove_flags(groups, kLeftOut);
    viewer::ViewerOptions& window = options->window;
    groups.insert(
        groups.begin(),
        {"Window",
         {{"--tab", "plan|report|pixel", "Text in the lower part of the panel at the start (default plan)",
           [&window](const std::string& text) { return read_tab(window.tab, text); }},
          {"--orbit", "N", "Automatic run: turn once around the scene in N pictures, draw all samples, and end",
           read_int(window.rehearsal.orbit_frames, 1, 1000000)},
          {"--click", "X,Y", "Automatic run: then click on this pixel, which tells its triangle, its lights and its error",
           [&window](const std::string& text) { return read_click(window.rehearsal.click, text); }},
          {"--screenshot", "FILE", "Automatic run: at the end, write the window with its panel as a picture", read_text(window.screenshot)},
          {"--report", "FILE", "Automatic run: at the end, write times and the clicked pixel as JSON; - is standard output",
           read_text(options->report)}}});
    return {
        "view",
        "Show a scene in a window: turn it, change light and lobes, click on pixels",
        {scene_argument(*options, false)},
        std::move(groups),
        [options] { return run_view(*options); },
        Command::Listed::by_help,
        {"halflit view model.glb", "halflit view part.stl --view iso --edges feature", "halflit view model.glb --tab pixel --lobe valve"},
        {"--size", "--view", "--camera", "--up", "--background", "--env", "--edges", "--section", "--lobe", "--tab"},
        !viewer::has_viewer()};
}

}  // namespace halflit::cli
