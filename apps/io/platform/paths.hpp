// Paths of the standard library from names in UTF-8 and back. On Windows it takes a std::string's bytes for letters of another encoding.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace halflit::platform {

[[nodiscard]] inline std::filesystem::path to_path(std::string_view name) { return std::u8string(name.begin(), name.end()); }

/// With '/' between folders.
[[nodiscard]] inline std::string to_name(const std::filesystem::path& path) {
    const std::u8string name = path.generic_u8string();
    return {name.begin(), name.end()};
}

}  // namespace halflit::platform
