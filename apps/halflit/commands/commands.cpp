#include "apps/halflit/commands/commands.hpp"

#include "apps/engine/request/render_options.hpp"
#include "apps/halflit/flags/message_flags.hpp"

#include <algorithm>

namespace halflit::cli {

std::vector<Command> all_commands() {
    std::vector<Command> commands;
    for (const auto make :
         {render_command, look_command,       compare_command, info_command, view_command,  diff_command,       golden_command,
          sheet_command,  explain_command,    bench_command,   plan_command, merge_command, lobe_command,       env_command,
          trade_command,  playground_command, mcp_command,     help_command, man_command,   completion_command, flags_command}) {
        Command& command = commands.emplace_back(make());
        // Those that draw a scene have the engine's flags, which say nothing of messages.
        const auto last = std::find_if(command.groups.begin(), command.groups.end(),
                                       [](const FlagGroup& group) { return group.title == kLastPictureGroup; });
        if (last != command.groups.end()) command.groups.insert(last + 1, {"Messages", message_flags()});
    }
    return commands;
}

}  // namespace halflit::cli
