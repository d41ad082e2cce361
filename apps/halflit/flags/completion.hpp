// Scripts by which shells complete commands, flags and their values, made from the tables.
#pragma once

#include "apps/engine/request/flags.hpp"
#include "apps/halflit/program/engine.hpp"

#include <span>
#include <string>

namespace halflit::cli {

[[nodiscard]] std::string bash_completion(std::span<const Command> commands);
[[nodiscard]] std::string zsh_completion(std::span<const Command> commands);
[[nodiscard]] std::string fish_completion(std::span<const Command> commands);

}  // namespace halflit::cli
