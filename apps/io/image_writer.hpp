// Encoding of pictures. The bytes depend on the pixels and the format alone: no date, name or version is stored.
#pragma once

#include "raster/framebuffer.hpp"
#include "shading/result.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace halflit::io {

enum class OutputFormat : std::uint8_t { png, bmp, tga, jpg, hdr };

inline constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 28;

/// The format by the path's extension, in any case; "-" (standard output) is PNG. Anything else is a usage error that lists the formats.
[[nodiscard]] Result<OutputFormat> output_format_of(std::string_view path);

/// True for a format that stores linear floats (Image::rgba_linear) instead of sRGB codes (Image::rgba8).
[[nodiscard]] constexpr bool is_linear(OutputFormat format) { return format == OutputFormat::hdr; }

/// Makes the whole file in memory. PNG, BMP and TGA keep alpha; JPG (quality 95) and HDR have none and show the picture over black.
/// HDR holds what RGBE can: [0, 1.7e38], with NaN as 0. The picture may have up to kMaxImagePixels.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_image(const raster::Image& image, OutputFormat format);

}  // namespace halflit::io
