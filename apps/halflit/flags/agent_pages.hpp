// Pages for agents, made from the tables: how to use the program (docs/SKILL.md), and an index of the documentation (llms.txt).
#pragma once

#include "apps/engine/request/flags.hpp"
#include "apps/halflit/program/engine.hpp"

#include <span>
#include <string>

namespace halflit::cli {

/// A name with one line about it.
struct NamedHelp {
    std::string name, help;
};

/// docs/SKILL.md. tools: of `halflit mcp`.
[[nodiscard]] std::string skill_page(std::span<const Command> commands, std::span<const NamedHelp> tools);

/// llms.txt, as llmstxt.org describes it.
[[nodiscard]] std::string llms_page(std::span<const Command> commands);

}  // namespace halflit::cli
