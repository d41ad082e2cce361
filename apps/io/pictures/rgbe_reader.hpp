// Reader of Radiance pictures (.hdr, .pic): RGBE pixels, flat or with the old or the new run lengths. It is our own, because common readers
// loop forever on truncated files. Here every step consumes input, and memory grows only with pixels that have been read.
#pragma once

#include "apps/io/pictures/float_image.hpp"

namespace halflit::io {

using RgbeLimits = FloatImageLimits;
using RgbeImage = FloatImage;

/// A component is mantissa * 2^(exponent - 136), and 0 for exponent 0. It is divided by the product of all EXPOSURE lines and of its part
/// of the COLORCORR lines, which gives radiance. Values above 1e30 become 1e30; RGBE cannot hold negative numbers or NaN. All eight pixel
/// orders of the resolution line are converted to that of RgbeImage. Errors: bad_input, and limit above `limits`; messages have no file
/// prefix.
[[nodiscard]] Result<RgbeImage> decode_rgbe(std::span<const std::byte> file, const RgbeLimits& limits = {});

}  // namespace halflit::io
