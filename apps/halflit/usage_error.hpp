// The message for a wrong command line: one line with the error and the likely spelling.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace halflit::cli {

/// Names the most similar flag or sub-command if an unknown one was given.
[[nodiscard]] std::string usage_message(const CLI::App& root, const CLI::ParseError& error);

}  // namespace halflit::cli
