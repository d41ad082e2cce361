#include "apps/web/flag_table.hpp"

#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/request/render_options.hpp"
#include "halflit/version.hpp"

#include <nlohmann/json.hpp>

#include <string_view>

namespace halflit::web {
namespace {

/// Flags of processes, folders and cores, which a module has none of.
constexpr std::string_view kOfProcesses[] = {"--threads", "--max-memory", "--allow-external", "--camera-file", "--verbose", "--quiet"};

}  // namespace

std::string flag_table() {
    engine::RenderOptions options;
    std::vector<engine::FlagGroup> groups = engine::render_flags(options, engine::kRenderSize);
    engine::remove_flags(groups, kOfProcesses);
    engine::Json flags = engine::Json::array();
    for (const engine::FlagGroup& group : groups)
        for (const engine::Flag& flag : group.flags)
            flags.push_back({{"names", engine::words_of(flag.names, ',')},
                             {"form", flag.form},
                             {"help", flag.help},
                             {"group", group.title},
                             {"number", engine::takes_number(flag)},
                             {"repeated", flag.repeated}});
    return engine::to_text({{"version", version()}, {"pixel_epoch", kPixelEpoch}, {"flags", std::move(flags)}}, true);
}

}  // namespace halflit::web
