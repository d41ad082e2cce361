#include "apps/halflit/commands/commands.hpp"

#include "apps/engine/request/render_options.hpp"
#include "apps/halflit/flags/message_flags.hpp"

#include <algorithm>

namespace halflit::cli {
namespace {

struct CommandRow {
    std::string_view name;
    Command (*make)();
};
/// In the order of the help text.
constexpr CommandRow kCommands[] = {
    {"render", render_command},   {"look", look_command},   {"compare", compare_command},       {"info", info_command},
    {"view", view_command},       {"diff", diff_command},   {"golden", golden_command},         {"sheet", sheet_command},
    {"explain", explain_command}, {"bench", bench_command}, {"merge", merge_command},           {"lobe", lobe_command},
    {"env", env_command},         {"trade", trade_command}, {"playground", playground_command}, {"mcp", mcp_command},
    {"help", help_command},       {"man", man_command},     {"completion", completion_command}, {"flags", flags_command}};

const CommandRow* row_of(std::string_view name) {
    const auto* const row =
        std::find_if(std::begin(kCommands), std::end(kCommands), [&](const CommandRow& one) { return one.name == name; });
    return row == std::end(kCommands) ? nullptr : row;
}

Command made(const CommandRow& row) {
    Command command = row.make();
    // Those that draw a scene have the engine's flags, which say nothing of messages.
    const auto last =
        std::find_if(command.groups.begin(), command.groups.end(), [](const FlagGroup& group) { return group.title == kLastPictureGroup; });
    if (last != command.groups.end()) command.groups.insert(last + 1, {"Messages", message_flags()});
    return command;
}

}  // namespace

bool is_command(std::string_view name) { return row_of(name) != nullptr; }

std::vector<Command> commands_for(std::string_view first_word) {
    std::vector<Command> commands;
    if (const CommandRow* const row = row_of(first_word)) {
        commands.push_back(made(*row));
    } else {
        for (const CommandRow& one : kCommands) commands.push_back(made(one));
    }
    return commands;
}

std::vector<Command> all_commands() { return commands_for({}); }

}  // namespace halflit::cli
