// The terminal that messages go to.
#pragma once

#include <cstddef>

namespace halflit::cli {

/// Columns for help on standard output: those that COLUMNS says, or the terminal's, up to 120; 80 if it is not a terminal.
[[nodiscard]] std::size_t help_width();

}  // namespace halflit::cli
