// Hashes as reports and lists write them: 16 hexadecimal digits.
#pragma once

#include "halflit/target.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <span>
#include <string>

namespace halflit::engine {

[[nodiscard]] inline std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }
[[nodiscard]] inline std::string hash_text(std::span<const std::uint8_t> bytes) { return hash_text(pixel_hash(bytes)); }

}  // namespace halflit::engine
