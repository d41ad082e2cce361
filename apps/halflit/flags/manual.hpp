// Manual pages (roff) and the flags' page of the documentation (Markdown), made from the tables.
#pragma once

#include "apps/engine/request/flags.hpp"
#include "apps/halflit/program/engine.hpp"

#include <span>
#include <string>

namespace halflit::cli {

/// halflit(1)
[[nodiscard]] std::string program_manual(std::span<const Command> commands);
/// halflit-COMMAND(1)
[[nodiscard]] std::string command_manual(const Command& command);

/// A row of a table of two columns: a label as code, and text.
[[nodiscard]] std::string markdown_row(const std::string& label, const std::string& help);

/// docs/flags.md
[[nodiscard]] std::string markdown_page(std::span<const Command> commands);

}  // namespace halflit::cli
