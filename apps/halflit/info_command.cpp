// halflit info: describes a scene, and what drawing it requires.
#include "apps/halflit/cli_support.hpp"
#include "apps/halflit/commands.hpp"
#include "apps/halflit/messages.hpp"
#include "apps/halflit/render_job.hpp"
#include "apps/halflit/run_report.hpp"
#include "apps/halflit/scene_description.hpp"
#include "apps/io/atomic_file.hpp"

#include <memory>

namespace halflit::cli {
namespace {

constexpr PictureSize kUsualSize{1280, 720};

struct InfoOptions : RenderOptions {
    bool json = false;
};

Result<int> run_info(const InfoOptions& options) {
    const auto job = make_render_job(options, kUsualSize);
    if (!job) return tl::unexpected(job.error());
    for (const std::string& warning : job->warnings) print_warning(warning);
    const auto described = describe_scene(*job);
    if (!described) return tl::unexpected(described.error());
    const Json& description = *described;
    const std::string text = options.json ? to_text(description) : description_text(description);
    if (const auto written = io::write_file("-", {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}); !written)
        return tl::unexpected(written.error());
    return 0;
}

}  // namespace

Command add_info_command(CLI::App& root) {
    CLI::App* app = root.add_subcommand("info", "Describe a scene, and what drawing it requires");
    const auto options = std::make_shared<InfoOptions>();
    add_render_options(*app, *options, true, kUsualSize);
    app->add_flag("--json", options->json, "Print one JSON object")->group("Output");
    return {app, [options] { return run_info(*options); }};
}

}  // namespace halflit::cli
