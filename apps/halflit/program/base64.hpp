// Bytes as text.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace halflit::cli {

/// Bytes in base64, for a data: URL.
[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace halflit::cli
