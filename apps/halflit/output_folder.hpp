// Folders that sub-commands fill with files.
#pragma once

#include "shading/result.hpp"

#include <string>

namespace halflit::cli {

/// The value of `-o DIR`; not empty, and not standard output.
[[nodiscard]] Result<std::string> parse_folder(const std::string& text);

/// Makes it, and those above it, where missing.
Result<void> make_folder(const std::string& path);

/// To a file (replaced in one step) or "-".
Result<void> write_text(const std::string& path, const std::string& text);

}  // namespace halflit::cli
