// halflit explain: what made a pixel.
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/program/heap.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "apps/halflit/render/render_job.hpp"
#include "apps/halflit/report/pixel_story_json.hpp"
#include "apps/halflit/report/pixel_story_text.hpp"
#include "apps/halflit/report/run_report.hpp"
#include "halflit/explain.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace halflit::cli {
namespace {

struct ExplainOptions : RenderOptions {
    std::vector<PixelPlace> pixels;
    bool json = false;
};

Result<int> run_explain(ExplainOptions options) {
    if (options.pixels.empty()) return fail(ErrorCode::usage, "explain: expected --pixel X,Y");
    if (options.max_memory_bytes == 0) prepare_heap();
    options.may_want_reference = true;  // for the error
    const auto job = make_render_job(options, kRenderSize);
    if (!job) return tl::unexpected(job.error());
    for (const auto [x, y] : options.pixels)
        if (x >= job->width || y >= job->height)
            return fail(ErrorCode::usage,
                        fmt::format("--pixel: expected a pixel of the {}x{} picture, found {},{}", job->width, job->height, x, y));
    for (const std::string& warning : job->warnings) print_warning(warning);
    for (const std::string& choice : job->choices) print_detail(choice);
    const NameOfInstance name = names_of(job->source.parts);
    Renderer renderer;
    Json report = report_head("explain"), pixels = Json::array();
    std::string text;
    for (const auto [x, y] : options.pixels) {
        const auto story = explain_pixel(renderer, *job->prepared, job->light, job->camera, job->settings, {job->width, job->height}, x, y,
                                         job->timed_execution());
        if (!story) return tl::unexpected(story.error());
        if (options.json)
            pixels.push_back(story_json(*story, name));
        else
            text += (text.empty() ? "" : "\n") + story_text(*story, name);
    }
    if (options.json) {
        report["scene"] = job->source.name;
        report["size"] = {job->width, job->height};
        report["pixels"] = std::move(pixels);
        text = to_text(report);
    }
    if (const auto written = write_text("-", text); !written) return tl::unexpected(written.error());
    return 0;
}

}  // namespace

Command explain_command() {
    const auto options = std::make_shared<ExplainOptions>();
    auto groups = render_flags(*options, kRenderSize);
    constexpr std::string_view kLeftOut[] = {"--region"};
    remove_flags(groups, kLeftOut);
    const auto read_pixel = [&pixels = options->pixels](const std::string& text) -> Result<void> {
        const auto place = parse_pixel(text);
        if (!place) return tl::unexpected(place.error());
        pixels.push_back(*place);
        return {};
    };
    groups.insert(groups.begin(), {"Output",
                                   {{.names = "--pixel",
                                     .form = "X,Y",
                                     .help = "The pixel, from the upper left corner of the picture; may be given several times",
                                     .read = read_pixel,
                                     .repeated = true},
                                    {"--json", "", "Print one JSON object", set_to(options->json)}}});
    return {"explain",
            "Tell what made a pixel: its triangle, material and lights, what hides them, and what lies before and behind it",
            {scene_argument(*options, true)},
            std::move(groups),
            [options] { return run_explain(*options); }};
}

}  // namespace halflit::cli
