// OpenEXR pictures (.exr), by the library OpenEXR. It is optional: a build without it refuses these files by name.
#pragma once

#include "apps/io/codecs/codec_libraries.hpp"
#include "apps/io/pictures/float_image.hpp"

#include <cstdint>

namespace halflit::io {

[[nodiscard]] bool is_exr(std::span<const std::byte> file);

/// One part of scan lines or tiles (level 0), with the channels R, G and B, or one alone, which becomes grey; floats, halves or integers,
/// in any compression. The data window is the picture. A half that is infinite becomes the largest half. The header's sizes are checked
/// before the library sees the file. Errors as of decode_float_image.
[[nodiscard]] Result<FloatImage> decode_exr(std::span<const std::byte> file, const FloatImageLimits& limits = {});

/// 32-bit floats, the bits as they are, in scan lines with ZIP compression. Fails (usage) without OpenEXR, and (limit) without memory.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_exr(int width, int height, std::span<const ExrChannel> channels);

}  // namespace halflit::io
