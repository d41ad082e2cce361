// Reader of Radiance pictures (.hdr, .pic): RGBE pixels, flat or with the old or the new run lengths. It is our own, because common readers
// loop forever on truncated files. Here every step consumes input, and memory grows only with pixels that have been read.
#pragma once

#include "halflit/error.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace halflit::io {

struct RgbeLimits {
    int max_width = 16384, max_height = 8192;  ///< limits of the picture as it is shown
    std::size_t max_pixels = ~std::size_t{0};
};

struct RgbeImage {
    int width = 0, height = 0;
    std::vector<float> rgb;  ///< linear, three floats per pixel, row 0 on top, column 0 at the left
};

/// A component is mantissa * 2^(exponent - 136), and 0 for exponent 0. It is divided by the product of all EXPOSURE lines and of its part
/// of the COLORCORR lines, which gives radiance. Values above 1e30 become 1e30; RGBE cannot hold negative numbers or NaN. All eight pixel
/// orders of the resolution line are converted to that of RgbeImage. Errors: bad_input, and limit above `limits`; messages have no file
/// prefix.
[[nodiscard]] Result<RgbeImage> decode_rgbe(std::span<const std::byte> file, const RgbeLimits& limits = {});

}  // namespace halflit::io
