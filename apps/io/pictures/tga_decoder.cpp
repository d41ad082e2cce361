// TGA: grey of 8 bits, colour of 24 or 32 bits, plain or with run lengths. Colour maps and other depths are refused.
#include "apps/io/files/little_endian.hpp"
#include "apps/io/pictures/image_decoders.hpp"

#include <fmt/format.h>

namespace halflit::io::detail {
namespace {

constexpr std::size_t kHeader = 18;
constexpr std::uint32_t kColor = 2, kGrey = 3, kRunLengths = 8;
constexpr std::uint32_t kFromRight = 0x10, kFromTop = 0x20;

/// Stored pixels, one after the other: blue, green, red, alpha; or grey.
Result<std::vector<std::uint8_t>> stored_pixels(std::span<const std::byte> bytes, std::size_t pixels, std::size_t size, bool run_lengths) {
    const auto ends = [] { return fail(ErrorCode::bad_input, "TGA: the file ends within the pixels"); };
    std::vector<std::uint8_t> stored;  // grows with what has been read, so that a short file cannot take much memory
    const auto append = [&](std::span<const std::byte> from) {
        for (const std::byte b : from) stored.push_back(std::to_integer<std::uint8_t>(b));
    };
    if (!run_lengths) {
        if (bytes.size() < pixels * size) return ends();
        append(bytes.first(pixels * size));
        return stored;
    }
    for (std::size_t done = 0; done < pixels;) {
        if (bytes.empty()) return ends();
        const std::uint32_t code = byte_at(bytes, 0);
        const std::size_t count = (code & 127) + 1, used = (code & 128) != 0 ? size : count * size;
        bytes = bytes.subspan(1);
        if (count > pixels - done) return fail(ErrorCode::bad_input, "TGA: a run goes past the end of the picture");
        if (bytes.size() < used) return ends();
        for (std::size_t i = 0; i < count * size / used; ++i) append(bytes.first(used));
        bytes = bytes.subspan(used);
        done += count;
    }
    return stored;
}

}  // namespace

Result<DecodedImage> decode_tga(std::span<const std::byte> file, const ImageLimits& limits) {
    if (file.size() < kHeader) return fail(ErrorCode::bad_input, "TGA: the file ends within the header");
    const std::uint32_t type = byte_at(file, 2), bits = byte_at(file, 16), order = byte_at(file, 17), kind = type & ~kRunLengths;
    const bool color = kind == kColor && (bits == 24 || bits == 32), grey = kind == kGrey && bits == 8;
    if (byte_at(file, 1) != 0 || (!color && !grey))
        return fail(
            ErrorCode::bad_input,
            fmt::format("TGA: expected colour of 24 or 32 bits or grey of 8 (types 2, 3, 10, 11), found type {}, {} bits", type, bits));
    const std::size_t width = u16_at(file, 12), height = u16_at(file, 14), size = bits / 8, first = kHeader + byte_at(file, 0);
    if (const auto checked = check_image_size(width, height, limits); !checked) return tl::unexpected(checked.error());
    if (first > file.size()) return fail(ErrorCode::bad_input, "TGA: the file ends within the header");
    const auto stored = stored_pixels(file.subspan(first), width * height, size, (type & kRunLengths) != 0);
    if (!stored) return tl::unexpected(stored.error());
    DecodedImage image{static_cast<int>(width), static_cast<int>(height), {}, {}};
    image.rgba8.reserve(width * height * 4);
    for (std::size_t row = 0; row < height; ++row)
        for (std::size_t column = 0; column < width; ++column) {
            const std::size_t y = (order & kFromTop) != 0 ? row : height - 1 - row,
                              x = (order & kFromRight) != 0 ? width - 1 - column : column;
            const std::uint8_t* pixel = stored->data() + size * (y * width + x);
            for (const std::size_t c : {std::size_t{2}, std::size_t{1}, std::size_t{0}}) image.rgba8.push_back(pixel[grey ? 0 : c]);
            image.rgba8.push_back(size == 4 ? pixel[3] : std::uint8_t{255});
        }
    return image;
}

}  // namespace halflit::io::detail
