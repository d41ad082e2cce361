// PNG by stb_image, in place of libspng and libdeflate. Gamma and colour profiles are ignored, as there; checksums are not checked.
#include "apps/io/pictures/image_decoders.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Weverything"
#include <stb/stb_image.h>
#pragma clang diagnostic pop

namespace halflit::io::detail {
namespace {

using Bytes = std::span<const std::byte>;

constexpr std::size_t kHeaderEnd = 33;  // signature, and IHDR with its checksum
constexpr const char* kOtherSize = "PNG: the size differs from the header's";
constexpr unsigned kHeaderName = 0x49484452u;  // "IHDR"

unsigned png_number(Bytes file, std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | std::to_integer<unsigned>(file[i]);
    return value;
}

template <class T>
using Pixels = std::unique_ptr<T, decltype([](T* pixels) { stbi_image_free(pixels); })>;

tl::unexpected<Error> png_fault() { return fail(ErrorCode::bad_input, fmt::format("PNG: {}", stbi_failure_reason())); }

}  // namespace

Result<ImageHeader> read_png_header(Bytes file, const ImageLimits& limits) {
    if (file.size() < kHeaderEnd) return fail(ErrorCode::bad_input, "PNG: the file ends in its header");
    // stb_image steps over a CgBI chunk, after which the numbers below would be of something else.
    if (png_number(file, 12) != kHeaderName) return fail(ErrorCode::bad_input, "PNG: expected the chunk IHDR first");
    const unsigned width = png_number(file, 16), height = png_number(file, 20);
    if (const auto size = check_image_size(width, height, limits); !size) return tl::unexpected(size.error());
    return ImageHeader{ImageFormat::png, static_cast<int>(width), static_cast<int>(height), std::to_integer<int>(file[24]) == 16 ? 16 : 8};
}

Result<DecodedImage> decode_png(Bytes file, const ImageLimits& limits, bool keep_16_bits) {
    const auto header = read_png_header(file, limits);
    if (!header) return tl::unexpected(header.error());
    const auto* const data = reinterpret_cast<const stbi_uc*>(file.data());
    const int size = static_cast<int>(file.size());
    const auto values = std::size_t{4} * static_cast<std::size_t>(header->width) * static_cast<std::size_t>(header->height);
    DecodedImage image{header->width, header->height, {}, {}};
    int width = 0, height = 0, channels = 0;
    const auto as_in_header = [&] { return width == header->width && height == header->height; };
    if (header->bits != 16) {
        const Pixels<stbi_uc> pixels(stbi_load_from_memory(data, size, &width, &height, &channels, 4));
        if (!pixels) return png_fault();
        if (!as_in_header()) return fail(ErrorCode::bad_input, kOtherSize);
        image.rgba8.assign(pixels.get(), pixels.get() + values);
        return image;
    }
    const Pixels<stbi_us> pixels(stbi_load_16_from_memory(data, size, &width, &height, &channels, 4));
    if (!pixels) return png_fault();
    if (!as_in_header()) return fail(ErrorCode::bad_input, kOtherSize);
    image.rgba16.assign(pixels.get(), pixels.get() + values);
    if (keep_16_bits) return image;
    image.rgba8.reserve(values);
    for (const std::uint16_t value : image.rgba16) image.rgba8.push_back(static_cast<std::uint8_t>((value * 255u + 32767u) / 65535u));
    image.rgba16 = {};
    return image;
}

/// All at once, as interlaced files are decoded natively.
Result<bool> decode_png_rows(Bytes /*file*/, const ImageLimits& /*limits*/, bool /*keep_16_bits*/, RowSink& /*sink*/) { return false; }

}  // namespace halflit::io::detail
