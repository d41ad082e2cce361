// Text of files and callers, as people may see it.
#pragma once

#include "apps/io/files/text.hpp"

#include <string>
#include <string_view>

namespace halflit::engine {

/// Escapes control characters and bytes that are not UTF-8, in text of any length. So a name from a file cannot control the terminal or
/// forge a second line.
[[nodiscard]] inline std::string printable(std::string_view text) { return io::printable(text, std::string_view::npos); }

}  // namespace halflit::engine
