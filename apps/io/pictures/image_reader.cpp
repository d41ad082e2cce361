#include "apps/io/pictures/image_reader.hpp"

#include "apps/io/pictures/image_decoders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string>

namespace halflit::io {

namespace {

bool starts_with(std::span<const std::byte> file, std::span<const std::uint8_t> prefix) {
    return file.size() >= prefix.size() && std::equal(prefix.begin(), prefix.end(), file.begin(),
                                                      [](std::uint8_t a, std::byte b) { return a == static_cast<std::uint8_t>(b); });
}

constexpr const char* kExpected = "PNG, JPEG, WebP, BMP, TIFF or KTX2";

Result<ImageFormat> format_of(std::span<const std::byte> file) {
    static constexpr std::uint8_t kPng[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'}, kJpeg[] = {0xFF, 0xD8, 0xFF};
    static constexpr std::uint8_t kRiff[] = {'R', 'I', 'F', 'F'}, kWebp[] = {'W', 'E', 'B', 'P'},
                                  kKtx2[] = {0xAB, 'K', 'T', 'X', ' ', '2', '0', 0xBB, '\r', '\n', 0x1A, '\n'},
                                  kGif[] = {'G', 'I', 'F', '8'}, kBmp[] = {'B', 'M'};
    if (starts_with(file, kPng)) return ImageFormat::png;
    if (starts_with(file, kJpeg)) return ImageFormat::jpeg;
    if (starts_with(file, kRiff) && file.size() >= 12 && starts_with(file.subspan(8), kWebp)) return ImageFormat::webp;
    if (starts_with(file, kBmp)) return ImageFormat::bmp;
    if (detail::is_tiff(file)) return ImageFormat::tiff;
    if (starts_with(file, kKtx2)) return ImageFormat::ktx2;
    if (starts_with(file, kGif)) return fail(ErrorCode::bad_input, fmt::format("expected a {} picture, found GIF", kExpected));
    if (file.empty()) return fail(ErrorCode::bad_input, fmt::format("expected a {} picture, found nothing", kExpected));
    std::string bytes;
    for (const std::byte b : file.first(std::min<std::size_t>(file.size(), 4))) bytes += fmt::format(" {:02x}", static_cast<unsigned>(b));
    return fail(ErrorCode::bad_input, fmt::format("expected a {} picture, found bytes{}", kExpected, bytes));
}

}  // namespace

namespace detail {

Result<void> check_image_size(std::uint64_t width, std::uint64_t height, const ImageLimits& limits) {
    if (width == 0 || height == 0) return fail(ErrorCode::bad_input, fmt::format("the picture is {}x{} pixels", width, height));
    const std::uint64_t side = static_cast<std::uint64_t>(limits.max_side);
    if (width > side || height > side)
        return fail(ErrorCode::limit,
                    fmt::format("the picture is {}x{} pixels, the limit is {} a side (max_texture_side)", width, height, limits.max_side));
    if (width * height > limits.max_pixels)
        return fail(ErrorCode::limit,
                    fmt::format("the picture has {} pixels, the limit is {} (max_texture_pixels)", width * height, limits.max_pixels));
    return {};
}

void add_rows(const DecodedImage& image, RowSink& sink) {
    const std::size_t row = std::size_t{4} * static_cast<std::size_t>(image.width);
    for (std::size_t at = 0; at < image.rgba8.size(); at += row) sink.add_row(&image.rgba8[at]);
    for (std::size_t at = 0; at < image.rgba16.size(); at += row) sink.add_row(&image.rgba16[at]);
}

}  // namespace detail

void RowSink::add_indexed_row(std::span<const std::uint8_t> indices, const Palette& palette) {
    std::vector<std::uint8_t> rgba(4 * indices.size());
    for (std::size_t x = 0; x < indices.size(); ++x) std::memcpy(&rgba[4 * x], palette[indices[x]].data(), 4);
    add_row(rgba.data());
}

Result<ImageHeader> read_image_header(std::span<const std::byte> file, const ImageLimits& limits) {
    const auto format = format_of(file);
    if (!format) return tl::unexpected(format.error());
    if (*format == ImageFormat::webp) return detail::read_webp_header(file, limits);
    if (*format == ImageFormat::bmp) return detail::read_bmp_header(file, limits);
    if (*format == ImageFormat::tiff) return detail::read_tiff_header(file, limits);
    if (*format == ImageFormat::ktx2) return detail::read_ktx2_header(file, limits);
    return *format == ImageFormat::png ? detail::read_png_header(file, limits) : detail::read_jpeg_header(file, limits);
}

Result<DecodedImage> decode_image(std::span<const std::byte> file, const ImageLimits& limits, bool keep_16_bits) {
    const auto format = format_of(file);
    if (!format) return tl::unexpected(format.error());
    if (*format == ImageFormat::webp) return detail::decode_webp(file, limits);
    if (*format == ImageFormat::bmp) return detail::decode_bmp(file, limits);
    if (*format == ImageFormat::tiff) return detail::decode_tiff(file, limits);
    if (*format == ImageFormat::png) return detail::decode_png(file, limits, keep_16_bits);
    const auto header = read_image_header(file, limits);
    if (!header) return tl::unexpected(header.error());
    detail::WholePicture whole(header->width, header->height);
    if (auto done = decode_rows(file, limits, keep_16_bits, whole); !done) return tl::unexpected(done.error());
    return std::move(whole.image);
}

Result<void> decode_rows(std::span<const std::byte> file, const ImageLimits& limits, bool keep_16_bits, RowSink& sink) {
    const auto format = format_of(file);
    if (!format) return tl::unexpected(format.error());
    if (*format == ImageFormat::png) {
        const auto added = detail::decode_png_rows(file, limits, keep_16_bits, sink);
        if (!added) return tl::unexpected(added.error());
        if (*added) return {};
    }
    if (*format == ImageFormat::jpeg) return detail::decode_jpeg_rows(file, limits, sink);
    if (*format == ImageFormat::ktx2) return detail::decode_ktx2_rows(file, limits, sink);
    const auto image = decode_image(file, limits, keep_16_bits);
    if (!image) return tl::unexpected(image.error());
    detail::add_rows(*image, sink);
    return {};
}

}  // namespace halflit::io
