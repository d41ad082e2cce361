#include "apps/halflit/commands.hpp"

namespace halflit::cli {

std::vector<Command> all_commands() {
    std::vector<Command> commands;
    for (const auto make :
         {render_command, bench_command, info_command, diff_command, lobe_command, env_command, figures_command, trade_command})
        commands.push_back(make());
    return commands;
}

}  // namespace halflit::cli
