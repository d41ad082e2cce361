// The texts of --help, folded to a width.
#pragma once

#include "apps/engine/request/flags.hpp"
#include "apps/halflit/program/engine.hpp"

#include <span>
#include <string>
#include <string_view>

namespace halflit::cli {

inline constexpr const char* kProgramHelp = "Renders models, such as glTF, STL, PLY, OBJ and 3MF, to pictures on the CPU.";
inline constexpr const char* kExitCodesHelp =
    "Exit codes: 0 ok, 1 negative result, 2 usage, 3 bad input, 4 cannot read or write, 5 limit hit, 6 internal error, 128+n signal n.";

/// The program and its commands. `all`: also those that are listed by --help-all.
[[nodiscard]] std::string program_help(std::span<const Command> commands, bool all, std::size_t width);

/// One command. Without `all`, a command with usual flags has a page of these, each with the first part of its explanation.
[[nodiscard]] std::string command_help(const Command& command, bool all, std::size_t width);

/// "halflit render [FLAGS] [SCENE]"
[[nodiscard]] std::string usage_line(const Command& command);

/// "-o, --output FILE"
[[nodiscard]] std::string flag_label(const Flag& flag);

/// "    halflit info part.stl": the examples, one a line, indented by so many columns.
[[nodiscard]] std::string example_lines(std::span<const std::string> examples, std::size_t indent);

/// The first part of an explanation, which is a sentence of its own.
[[nodiscard]] std::string_view first_part(std::string_view help);

}  // namespace halflit::cli
