// The decoders behind image_reader and picture_reader, one per format.
#pragma once

#include "apps/io/pictures/image_reader.hpp"

namespace halflit::io::detail {

Result<ImageHeader> read_png_header(std::span<const std::byte> file, const ImageLimits& limits);
Result<DecodedImage> decode_png(std::span<const std::byte> file, const ImageLimits& limits, bool keep_16_bits);
/// As decode_rows; false: the file is interlaced, whose rows do not come in order, and nothing was added.
Result<bool> decode_png_rows(std::span<const std::byte> file, const ImageLimits& limits, bool keep_16_bits, RowSink& sink);
Result<ImageHeader> read_jpeg_header(std::span<const std::byte> file, const ImageLimits& limits);
Result<DecodedImage> decode_jpeg(std::span<const std::byte> file, const ImageLimits& limits);
/// Fails (bad_input) for a build without libwebp, and for animations.
Result<ImageHeader> read_webp_header(std::span<const std::byte> file, const ImageLimits& limits);
Result<DecodedImage> decode_webp(std::span<const std::byte> file, const ImageLimits& limits);
Result<DecodedImage> decode_bmp(std::span<const std::byte> file, const ImageLimits& limits);
Result<DecodedImage> decode_tga(std::span<const std::byte> file, const ImageLimits& limits);

/// Fails unless width and height are at least 1 and within the limits.
Result<void> check_image_size(std::uint64_t width, std::uint64_t height, const ImageLimits& limits);

}  // namespace halflit::io::detail
