// One line that says what is wrong with a command line, and what was probably meant.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace halflit::cli {

/// For a flag or sub-command that does not exist, the nearest one that does is named.
[[nodiscard]] std::string usage_message(const CLI::App& root, const CLI::ParseError& error);

}  // namespace halflit::cli
