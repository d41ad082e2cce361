// What the program says to people: one line each, on standard error. Standard output is for data.
#pragma once

#include <string>
#include <string_view>

namespace halflit::cli {

/// Control characters as \x1b and the like, so that a name from a file cannot drive the terminal or fake a second line. Bytes from 0x80 on
/// stay when they are well-formed UTF-8 outside of the C1 controls, and are escaped when not.
[[nodiscard]] std::string printable(std::string_view text);

/// "halflit: error: MESSAGE". An empty message says nothing.
void print_error(std::string_view message);
/// "halflit: warning: MESSAGE"
void print_warning(std::string_view message);
/// "halflit: MESSAGE"
void print_note(std::string_view message);

}  // namespace halflit::cli
