// halflit info: describes a scene, and what drawing it requires.
#include "apps/engine/answers/scene_description.hpp"
#include "apps/engine/basics/timeout.hpp"
#include "apps/engine/job/render_job.hpp"
#include "apps/halflit/commands/commands.hpp"
#include "apps/halflit/program/messages.hpp"
#include "apps/halflit/program/text_file.hpp"

#include <memory>

namespace halflit::cli {
namespace {

struct InfoOptions : RenderOptions {
    bool json = false, measure_parts = false;
};

Result<int> describe(const InfoOptions& options) {
    const auto job = make_measured_job(options);
    if (!job) return tl::unexpected(job.error());
    for (const std::string& warning : job->warnings) print_warning(warning);
    const auto described = describe_scene(*job, options.json, options.measure_parts);
    if (!described) return tl::unexpected(described.error());
    if (const auto written = write_text("-", *described); !written) return tl::unexpected(written.error());
    return 0;
}

Result<int> run_info(const InfoOptions& options) {
    return within_time(options.timeout_s, [&] { return describe(options); });
}

}  // namespace

Command info_command() {
    const auto options = std::make_shared<InfoOptions>();
    auto groups = render_flags(*options, kRenderSize);
    groups.push_back({"Output", {{"--json", "", "Print one JSON object", set_to(options->json)}, parts_flag(options->measure_parts)}});
    return {"info",
            "Describe a scene, and what drawing it requires",
            {scene_argument(*options, true)},
            std::move(groups),
            [options] { return run_info(*options); },
            Command::Listed::by_help,
            {"halflit info model.glb", "halflit info part.stl --parts", "halflit info model.glb --json --strict"},
            {"--json", "--parts", "--up", "--scene", "--animation", "--size", "--strict", "--timeout", "--max-memory"}};
}

}  // namespace halflit::cli
