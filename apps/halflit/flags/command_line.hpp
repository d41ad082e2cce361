// Splits the command line by the tables of the commands, and reads the values.
#pragma once

#include "apps/engine/request/flags.hpp"
#include "apps/halflit/program/engine.hpp"

#include <span>
#include <string>
#include <vector>

namespace halflit::cli {

struct ParsedLine {
    enum class Wanted { run, help, help_all, version, library_versions, self_test };
    const Command* command = nullptr;  ///< null: none, with help, version or self_test
    Wanted wanted = Wanted::run;
};

/// `arguments` are those after the program's name. An error is one line that names the likely spelling and where to look.
[[nodiscard]] Result<ParsedLine> parse_command_line(std::span<const Command> commands, std::vector<std::string> arguments);

}  // namespace halflit::cli
