// Decoding of PNG, JPEG, WebP, BMP, TIFF and KTX2 pictures in memory. Limits are checked on the header, before pixels are decoded.
#pragma once

#include "halflit/error.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace halflit::io {

struct ImageLimits {
    int max_side = 16384;  ///< pixels
    std::size_t max_pixels = std::size_t{64} << 20;
    int max_jpeg_scans = 64;    ///< each scan of a progressive JPEG costs a pass over the picture
    bool keep_damaged = false;  ///< decode_rows adds the rows of a damaged picture that can be read, before it returns the error
};

enum class ImageFormat : std::uint8_t { png, jpeg, webp, bmp, tiff, ktx2 };

struct ImageHeader {
    ImageFormat format = ImageFormat::png;
    int width = 0, height = 0;
    int bits = 8;  ///< per channel: 16 for a PNG of 16 bits, else 8
};

struct DecodedImage {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba8;    ///< width * height * 4, row 0 on top, alpha not premultiplied, as stored (no gamma applied)
    std::vector<std::uint16_t> rgba16;  ///< the same at 16 bits, instead of rgba8, if the file has them and `keep_16_bits`
};

/// Errors: bad_input for other formats and broken headers, limit above `limits`. Messages have no file prefix.
Result<ImageHeader> read_image_header(std::span<const std::byte> file, const ImageLimits& limits = {});

/// Grey, palette and pictures without alpha become RGBA; a cut-off or damaged picture is an error, never half a picture.
/// 16-bit channels are rounded to 8 unless `keep_16_bits`.
Result<DecodedImage> decode_image(std::span<const std::byte> file, const ImageLimits& limits = {}, bool keep_16_bits = false);

using Palette = std::array<std::array<std::uint8_t, 4>, 256>;  ///< RGBA

/// Takes a picture row by row, top to bottom; four channels a pixel, alpha not premultiplied. All rows of a picture come by one function.
class RowSink {
public:
    virtual ~RowSink() = default;
    virtual void add_row(const std::uint8_t* rgba8) = 0;
    virtual void add_row(const std::uint16_t* rgba16) = 0;
    /// Pixels of a palette, which is the same for all rows. If not overridden, adds their colours.
    virtual void add_indexed_row(std::span<const std::uint8_t> indices, const Palette& palette);
};

/// decode_image without memory for the picture where the format allows: PNG that is not interlaced, JPEG and KTX2. After an error, rows may
/// have been added.
Result<void> decode_rows(std::span<const std::byte> file, const ImageLimits& limits, bool keep_16_bits, RowSink& sink);

}  // namespace halflit::io
