// The decoders behind image_reader and picture_reader, one per format.
#pragma once

#include "apps/io/pictures/image_reader.hpp"

namespace halflit::io::detail {

/// Keeps all rows; those of 16 bits too. Memory grows with them, not by what a header says.
struct WholePicture : RowSink {
    DecodedImage image;

    WholePicture(int width, int height) : image{width, height, {}, {}} {}
    void add_row(const std::uint8_t* rgba8) override { image.rgba8.insert(image.rgba8.end(), rgba8, rgba8 + row()); }
    void add_row(const std::uint16_t* rgba16) override { image.rgba16.insert(image.rgba16.end(), rgba16, rgba16 + row()); }
    [[nodiscard]] std::size_t row() const { return std::size_t{4} * static_cast<std::size_t>(image.width); }
};

void add_rows(const DecodedImage& image, RowSink& sink);

Result<ImageHeader> read_png_header(std::span<const std::byte> file, const ImageLimits& limits);
Result<DecodedImage> decode_png(std::span<const std::byte> file, const ImageLimits& limits, bool keep_16_bits);
/// As decode_rows; false: the file is interlaced, whose rows do not come in order, and nothing was added. If ImageLimits::keep_damaged,
/// the rows of a file that is cut off within its pixels are added as far as they go.
Result<bool> decode_png_rows(std::span<const std::byte> file, const ImageLimits& limits, bool keep_16_bits, RowSink& sink);
Result<ImageHeader> read_jpeg_header(std::span<const std::byte> file, const ImageLimits& limits);
/// If ImageLimits::keep_damaged, the rows before a damage are added before it is returned; of a file of several scans, all rows, if it is
/// behind the first scan.
Result<void> decode_jpeg_rows(std::span<const std::byte> file, const ImageLimits& limits, RowSink& sink);
/// Fails (bad_input) for a build without libwebp, and for animations.
Result<ImageHeader> read_webp_header(std::span<const std::byte> file, const ImageLimits& limits);
Result<DecodedImage> decode_webp(std::span<const std::byte> file, const ImageLimits& limits);
Result<ImageHeader> read_bmp_header(std::span<const std::byte> file, const ImageLimits& limits);
Result<DecodedImage> decode_bmp(std::span<const std::byte> file, const ImageLimits& limits);
[[nodiscard]] bool is_tiff(std::span<const std::byte> file);
Result<ImageHeader> read_tiff_header(std::span<const std::byte> file, const ImageLimits& limits);
Result<DecodedImage> decode_tiff(std::span<const std::byte> file, const ImageLimits& limits);
/// As decode_jpeg_rows, without scans. Fails (bad_input) for a build without libzstd.
Result<ImageHeader> read_ktx2_header(std::span<const std::byte> file, const ImageLimits& limits);
Result<void> decode_ktx2_rows(std::span<const std::byte> file, const ImageLimits& limits, RowSink& sink);
Result<DecodedImage> decode_tga(std::span<const std::byte> file, const ImageLimits& limits);

/// Fails unless width and height are at least 1 and within the limits.
Result<void> check_image_size(std::uint64_t width, std::uint64_t height, const ImageLimits& limits);

}  // namespace halflit::io::detail
