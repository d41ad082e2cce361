// halflit explain: what made a pixel.
#include "apps/engine/answers/pixel_stories.hpp"
#include "apps/engine/job/render_job.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"
#include "apps/io/platform/process.hpp"

#include <memory>
#include <vector>

namespace halflit::cli {
namespace {

struct ExplainOptions : RenderOptions {
    std::vector<PixelPlace> pixels;
    bool json = false;
};

Result<int> run_explain(const ExplainOptions& options) {
    if (options.max_memory_bytes == 0) platform::prepare_heap();
    const auto stories = explain(options, options.pixels);
    if (!stories) return tl::unexpected(stories.error());
    for (const std::string& warning : stories->warnings) print_warning(warning);
    for (const std::string& choice : stories->choices) print_detail(choice);
    if (const auto written = write_text("-", options.json ? to_text(stories->report) : stories->text); !written)
        return tl::unexpected(written.error());
    return 0;
}

}  // namespace

Command explain_command() {
    const auto options = std::make_shared<ExplainOptions>();
    auto groups = render_flags(*options, kRenderSize);
    constexpr std::string_view kLeftOut[] = {"--region"};
    remove_flags(groups, kLeftOut);
    groups.insert(groups.begin(),
                  {"Output", {pixel_flag(options->pixels), {"--json", "", "Print one JSON object", set_to(options->json)}}});
    return {"explain",
            "Explain a pixel: its triangle, material and lights, what hides the lights, and what lies before and behind it",
            {scene_argument(*options, true)},
            std::move(groups),
            [options] { return run_explain(*options); },
            Command::Listed::by_help_all,
            {"halflit explain part.stl --pixel 640,360", "halflit explain part.stl --view top --pixel 640,360 --pixel 600,300",
             "halflit explain part.stl --pixel 640,360 --json"},
            {"--pixel", "--json", "--size", "--view", "--camera", "--up", "--section", "--only"}};
}

}  // namespace halflit::cli
