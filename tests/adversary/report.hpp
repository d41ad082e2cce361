// The findings of a search, in words.
#pragma once

#include "tests/adversary/search.hpp"

#include <string>

namespace halflit::adversary {

/// One line: ratio, error, where, and the bound with its parts.
[[nodiscard]] std::string text_of(const Verdict& verdict);
/// Numbers of scenes, and the worst ratio for each part of the bound, a line each.
[[nodiscard]] std::string text_of(const SearchResult& result);
/// Writes the trial as FOLDER/NAME.glb. Returns the command lines that show it, or why it is not written.
[[nodiscard]] std::string written(const Trial& trial, const std::string& folder, const std::string& name);

}  // namespace halflit::adversary
