// The sub-commands, as tables.
#pragma once

#include "apps/engine/request/flags.hpp"
#include "apps/halflit/program/engine.hpp"

namespace halflit::cli {

[[nodiscard]] Command render_command();
[[nodiscard]] Command view_command();
[[nodiscard]] Command bench_command();
[[nodiscard]] Command info_command();
[[nodiscard]] Command explain_command();
[[nodiscard]] Command diff_command();
[[nodiscard]] Command compare_command();
[[nodiscard]] Command sheet_command();
[[nodiscard]] Command look_command();
[[nodiscard]] Command merge_command();
[[nodiscard]] Command golden_command();
[[nodiscard]] Command lobe_command();
[[nodiscard]] Command env_command();
[[nodiscard]] Command trade_command();
[[nodiscard]] Command playground_command();
[[nodiscard]] Command mcp_command();

// Hidden.
[[nodiscard]] Command help_command();
[[nodiscard]] Command man_command();
[[nodiscard]] Command completion_command();
[[nodiscard]] Command flags_command();

/// In the order of the help text.
[[nodiscard]] std::vector<Command> all_commands();
[[nodiscard]] bool is_command(std::string_view name);
/// The command of a line that begins with its name; all of them if it begins with another word. The flags of one take a quarter of a
/// millisecond.
[[nodiscard]] std::vector<Command> commands_for(std::string_view first_word);

}  // namespace halflit::cli
