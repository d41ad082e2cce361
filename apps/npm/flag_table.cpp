#include "apps/npm/flag_table.hpp"

#include "apps/halflit/render/render_options.hpp"
#include "apps/halflit/report/run_report.hpp"
#include "halflit/version.hpp"

#include <nlohmann/json.hpp>

#include <string_view>

namespace halflit::npm {
namespace {

/// Flags of processes, folders and cores, which a module has none of.
constexpr std::string_view kOfProcesses[] = {"--threads", "--max-memory", "--allow-external", "--camera-file", "--verbose", "--quiet"};

}  // namespace

std::string flag_table() {
    cli::RenderOptions options;
    std::vector<cli::FlagGroup> groups = cli::render_flags(options, cli::kRenderSize);
    cli::remove_flags(groups, kOfProcesses);
    cli::Json flags = cli::Json::array();
    for (const cli::FlagGroup& group : groups)
        for (const cli::Flag& flag : group.flags)
            flags.push_back({{"names", cli::words_of(flag.names, ',')},
                             {"form", flag.form},
                             {"help", flag.help},
                             {"group", group.title},
                             {"repeated", flag.repeated}});
    return cli::to_text({{"version", version()}, {"pixel_epoch", kPixelEpoch}, {"flags", std::move(flags)}}, true);
}

}  // namespace halflit::npm
