// What the program says to people: one line each, on standard error. Standard output is for data.
#pragma once

#include "apps/io/text.hpp"

#include <string>
#include <string_view>

namespace halflit::cli {

/// Text of any length with control characters and what is not UTF-8 escaped, so that a name from a file cannot drive the terminal or fake a
/// second line.
[[nodiscard]] inline std::string printable(std::string_view text) { return io::printable(text, std::string_view::npos); }

/// "halflit: error: MESSAGE". An empty message says nothing.
void print_error(std::string_view message);
/// "halflit: warning: MESSAGE"
void print_warning(std::string_view message);
/// "halflit: MESSAGE"
void print_note(std::string_view message);

}  // namespace halflit::cli
