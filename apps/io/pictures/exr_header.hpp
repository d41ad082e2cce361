// The attributes of an EXR file that decide how much memory its pixels take, read before the library sees the file.
#pragma once

#include "apps/io/pictures/float_image.hpp"

namespace halflit::io::detail {

struct ExrHeader {
    long long width = 0, height = 0;            ///< of the data window
    long long tile_width = 0, tile_height = 0;  ///< 0: scan lines
    std::size_t channels = 0;
};

/// Errors as of decode_float_image. Refuses deep and multi-part files, and cube maps.
[[nodiscard]] Result<ExrHeader> read_exr_header(std::span<const std::byte> file, const FloatImageLimits& limits);

}  // namespace halflit::io::detail
