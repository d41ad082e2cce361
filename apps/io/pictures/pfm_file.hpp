// Portable Float Maps (.pfm): a header of three lines, then floats, the bottom row first.
#pragma once

#include "apps/io/pictures/float_image.hpp"

#include <cstdint>

namespace halflit::io {

[[nodiscard]] bool is_pfm(std::span<const std::byte> file);

/// "PF" has three channels, "Pf" one, which becomes grey. The sign of the third line's number gives the order of bytes, its amount is a
/// factor on all values. Errors as of decode_float_image; a file with more or fewer bytes than its header says is bad_input.
[[nodiscard]] Result<FloatImage> decode_pfm(std::span<const std::byte> file, const FloatImageLimits& limits = {});

/// The file of width * height * channels floats, whose row 0 is on top; channels: 1 or 3. Little-endian, factor 1: the same bits.
[[nodiscard]] std::vector<std::uint8_t> encode_pfm(int width, int height, int channels, std::span<const float> values);

}  // namespace halflit::io
