// Bytes in base64 (RFC 4648, section 4), with padding: for data: URLs and JSON.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace halflit::engine {

[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace halflit::engine
