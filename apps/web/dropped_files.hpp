// Files of the page: what a visitor dropped, in memory. dropped_files.cpp answers apps/io/file_access.hpp from them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace halflit::web {

/// Adds or replaces a file. `name` may have folders before it, with '/'.
void add_file(const std::string& name, std::vector<std::byte> bytes);
void forget_files();

}  // namespace halflit::web
