#include "apps/halflit/program/terminal.hpp"

#include "apps/io/platform/streams.hpp"

#include <algorithm>
#include <cstdlib>

namespace halflit::cli {

std::size_t help_width() {
    constexpr long kLeast = 60, kMost = 120, kUsual = 80;
    long columns = 0;
    if (const char* text = std::getenv("COLUMNS")) columns = std::strtol(text, nullptr, 10);
    if (columns <= 0) columns = platform::terminal_columns();
    return static_cast<std::size_t>(columns <= 0 ? kUsual : std::clamp(columns, kLeast, kMost));
}

}  // namespace halflit::cli
