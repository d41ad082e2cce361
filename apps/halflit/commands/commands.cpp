#include "apps/halflit/commands/commands.hpp"

namespace halflit::cli {

std::vector<Command> all_commands() {
    std::vector<Command> commands;
    for (const auto make :
         {render_command, view_command,       bench_command, info_command,  explain_command, diff_command,       compare_command,
          sheet_command,  look_command,       plan_command,  merge_command, golden_command,  lobe_command,       env_command,
          trade_command,  playground_command, mcp_command,   help_command,  man_command,     completion_command, flags_command})
        commands.push_back(make());
    return commands;
}

}  // namespace halflit::cli
