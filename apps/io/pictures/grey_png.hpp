// PNG files of whole numbers: one channel of 16 bits, without a colour space.
#pragma once

#include "halflit/error.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace halflit::io {

/// The file of width * height values, the top row first. Throws std::bad_alloc; other failures of the encoder are errors (internal).
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_grey16(int width, int height, std::span<const std::uint16_t> values);

}  // namespace halflit::io
