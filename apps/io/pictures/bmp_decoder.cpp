// BMP of 24 bits, or of 32 bits with one byte per channel. Palettes, 16 bits and compression are refused.
#include "apps/io/files/little_endian.hpp"
#include "apps/io/pictures/image_decoders.hpp"

#include <fmt/format.h>

#include <array>

namespace halflit::io::detail {
namespace {

constexpr std::size_t kFileHeader = 14, kInfoHeader = 40;
constexpr std::uint32_t kPlain = 0, kBitFields = 3;

struct BmpHeader {
    std::uint32_t width = 0, height = 0;
    bool upwards = true;  ///< row 0 of the file is the lowest
    std::uint32_t bits = 24;
    std::size_t pixels = 0;                   ///< offset of the first row
    std::array<int, 4> byte_of{2, 1, 0, -1};  ///< byte of red, green, blue and alpha in a pixel; -1: none
};

/// The byte that a mask selects; -1 for no bits, -2 for anything but one whole byte.
int byte_of_mask(std::uint32_t mask) {
    if (mask == 0) return -1;
    for (int byte = 0; byte < 4; ++byte)
        if (mask == 0xFFu << (8 * byte)) return byte;
    return -2;
}

Result<BmpHeader> read_header(std::span<const std::byte> file) {
    if (file.size() < kFileHeader + kInfoHeader) return fail(ErrorCode::bad_input, "BMP: the file ends within the header");
    BmpHeader header;
    const std::uint32_t info = u32_at(file, kFileHeader);
    if (info < kInfoHeader) return fail(ErrorCode::bad_input, fmt::format("BMP: expected a header of 40 bytes or more, found {}", info));
    const std::uint32_t height = u32_at(file, kFileHeader + 8), compression = u32_at(file, kFileHeader + 16);
    header.width = u32_at(file, kFileHeader + 4);
    header.upwards = height < 0x80000000u;
    header.height = header.upwards ? height : 0u - height;
    header.bits = u16_at(file, kFileHeader + 14);
    header.pixels = u32_at(file, 10);
    const bool plain = compression == kPlain && (header.bits == 24 || header.bits == 32),
               masks = compression == kBitFields && header.bits == 32;
    if (!plain && !masks)
        return fail(ErrorCode::bad_input, fmt::format("BMP: expected 24 or 32 bits without compression, found {} bits, compression {}",
                                                      header.bits, compression));
    if (masks) {
        constexpr std::size_t kMasks = kFileHeader + kInfoHeader;
        // Headers of 56 bytes and more have a mask of alpha too.
        const std::size_t count = info >= 56 ? 4 : 3;
        if (file.size() < kMasks + 4 * count) return fail(ErrorCode::bad_input, "BMP: the file ends within the header");
        for (std::size_t c = 0; c < count; ++c) {
            header.byte_of[c] = byte_of_mask(u32_at(file, kMasks + 4 * c));
            if (header.byte_of[c] == -2 || (c < 3 && header.byte_of[c] < 0))
                return fail(ErrorCode::bad_input, "BMP: expected one whole byte for each channel");
        }
    }
    return header;
}

}  // namespace

Result<ImageHeader> read_bmp_header(std::span<const std::byte> file, const ImageLimits& limits) {
    const auto header = read_header(file);
    if (!header) return tl::unexpected(header.error());
    if (const auto checked = check_image_size(header->width, header->height, limits); !checked) return tl::unexpected(checked.error());
    return ImageHeader{ImageFormat::bmp, static_cast<int>(header->width), static_cast<int>(header->height), 8};
}

Result<DecodedImage> decode_bmp(std::span<const std::byte> file, const ImageLimits& limits) {
    const auto header = read_header(file);
    if (!header) return tl::unexpected(header.error());
    if (const auto checked = check_image_size(header->width, header->height, limits); !checked) return tl::unexpected(checked.error());
    const std::size_t width = header->width, height = header->height, bytes = header->bits / 8, stride = (width * bytes + 3) / 4 * 4;
    const std::size_t needed = stride * (height - 1) + width * bytes;  // the padding of the last row may be missing
    if (header->pixels > file.size() || file.size() - header->pixels < needed)
        return fail(ErrorCode::bad_input, "BMP: the file ends within the pixels");
    DecodedImage image{static_cast<int>(width), static_cast<int>(height), {}, {}};
    image.rgba8.reserve(width * height * 4);
    for (std::size_t y = 0; y < height; ++y) {
        const auto row = file.subspan(header->pixels + stride * (header->upwards ? height - 1 - y : y), width * bytes);
        for (std::size_t x = 0; x < width; ++x)
            for (const int at : header->byte_of)
                image.rgba8.push_back(at < 0 ? 255 : std::to_integer<std::uint8_t>(row[x * bytes + static_cast<std::size_t>(at)]));
    }
    return image;
}

}  // namespace halflit::io::detail
