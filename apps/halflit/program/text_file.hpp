// Text as a file or on standard output.
#pragma once

#include "halflit/error.hpp"

#include <string>

namespace halflit::cli {

/// Writes to a file, which is replaced in one step, or to standard output ("-").
Result<void> write_text(const std::string& path, const std::string& text);

}  // namespace halflit::cli
