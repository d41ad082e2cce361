// Models and pictures that are too large for the repository.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace halflit::test {

/// Folder that HALFLIT_ASSETS names, or ../shared/assets beside the source tree; nullopt if it does not exist (see HALFLIT_SKIP).
inline std::optional<std::filesystem::path> asset_dir() {
    const char* named = std::getenv("HALFLIT_ASSETS");
    const std::filesystem::path folder = named != nullptr ? named : std::filesystem::path(HALFLIT_SOURCE_DIR) / ".." / "shared" / "assets";
    std::error_code ignored;
    return std::filesystem::is_directory(folder, ignored) ? std::optional(folder) : std::nullopt;
}

}  // namespace halflit::test
