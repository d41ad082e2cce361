// Folders that sub-commands fill with files.
#pragma once

#include "halflit/error.hpp"

#include <string>

namespace halflit::engine {

/// The value of `-o DIR`; not empty, and not standard output.
[[nodiscard]] Result<std::string> parse_folder(const std::string& text);

/// Creates the folder and its parents where they are missing.
Result<void> make_folder(const std::string& path);

}  // namespace halflit::engine
