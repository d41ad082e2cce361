// Position of an offset in a JSON text, for messages: line and column, and the path of keys.
#pragma once

#include "apps/io/gltf/text/json_scan.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

/// Line and column (both from 1, column in bytes) of an offset.
struct TextPlace {
    std::size_t line = 1, column = 1;
};
[[nodiscard]] TextPlace place_of(std::string_view text, std::size_t offset);
/// "line 3, column 7".
[[nodiscard]] std::string named_place(std::string_view text, std::size_t offset);

/// "accessors[3].byteOffset" for the value (or key) at or before `offset`; empty for the root. Scans the text again, so it is for messages
/// only.
[[nodiscard]] std::string json_path_at(std::string_view text, std::size_t offset, const JsonScanLimits& limits);

/// The paths of several offsets, which rise and are each the first byte of a value or a key, by one scan.
[[nodiscard]] std::vector<std::string> json_paths_at(std::string_view text, std::span<const std::size_t> offsets,
                                                     const JsonScanLimits& limits);

}  // namespace halflit::io::detail
