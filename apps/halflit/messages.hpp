// Messages to people: one line each, on standard error. Standard output is for data.
#pragma once

#include "apps/io/text.hpp"

#include <string>
#include <string_view>

namespace halflit::cli {

/// Escapes control characters and bytes that are not UTF-8, in text of any length. So a name from a file cannot control the terminal or
/// forge a second line.
[[nodiscard]] inline std::string printable(std::string_view text) { return io::printable(text, std::string_view::npos); }

/// "halflit: error: MESSAGE". Prints nothing for an empty message.
void print_error(std::string_view message);
/// "halflit: warning: MESSAGE"
void print_warning(std::string_view message);
/// "halflit: MESSAGE"
void print_note(std::string_view message);

}  // namespace halflit::cli
