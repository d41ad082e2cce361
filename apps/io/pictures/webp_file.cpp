// WebP, read and written by libwebp, whose SIMD and plain versions give the same bits. Still pictures only.
#include "apps/io/files/optional_libraries.hpp"
#include "apps/io/pictures/image_decoders.hpp"
#include "apps/io/pictures/webp_encoder.hpp"

#include <fmt/format.h>

// A build may have libwebp's decoder alone.
#ifndef HALFLIT_HAS_WEBP_ENCODER
#define HALFLIT_HAS_WEBP_ENCODER HALFLIT_HAS_WEBP
#endif

#if HALFLIT_HAS_WEBP
#include <webp/decode.h>
#include <webp/encode.h>

#include <memory>
#include <new>
#endif

namespace halflit::io {

bool has_webp() { return HALFLIT_HAS_WEBP != 0; }

namespace detail {

#if HALFLIT_HAS_WEBP

namespace {

tl::unexpected<Error> webp_error(VP8StatusCode code) {
    switch (code) {
        case VP8_STATUS_OUT_OF_MEMORY:
            return fail(ErrorCode::limit, "WebP: out of memory");
        case VP8_STATUS_NOT_ENOUGH_DATA:
            return fail(ErrorCode::bad_input, "WebP: the file is cut off");
        case VP8_STATUS_UNSUPPORTED_FEATURE:
            return fail(ErrorCode::bad_input, "WebP: the file has a feature that libwebp does not know");
        default:
            return fail(ErrorCode::bad_input, "WebP: the file is damaged");
    }
}

const std::uint8_t* bytes_of(std::span<const std::byte> file) { return reinterpret_cast<const std::uint8_t*>(file.data()); }

}  // namespace

Result<ImageHeader> read_webp_header(std::span<const std::byte> file, const ImageLimits& limits) {
    WebPBitstreamFeatures features{};
    if (const VP8StatusCode code = WebPGetFeatures(bytes_of(file), file.size(), &features); code != VP8_STATUS_OK) return webp_error(code);
    if (features.has_animation != 0) return fail(ErrorCode::bad_input, "WebP: the picture is animated, expected a still one");
    const auto size = check_image_size(static_cast<std::uint64_t>(features.width), static_cast<std::uint64_t>(features.height), limits);
    if (!size) return tl::unexpected(size.error());
    return ImageHeader{ImageFormat::webp, features.width, features.height, 8};
}

Result<DecodedImage> decode_webp(std::span<const std::byte> file, const ImageLimits& limits) {
    const auto header = read_webp_header(file, limits);
    if (!header) return tl::unexpected(header.error());
    WebPDecoderConfig config;
    if (WebPInitDecoderConfig(&config) == 0) return fail(ErrorCode::internal, "WebP: the library has another version than its headers");
    DecodedImage image{header->width, header->height, {}, {}};
    image.rgba8.resize(static_cast<std::size_t>(header->width) * static_cast<std::size_t>(header->height) * 4);
    config.output.colorspace = MODE_RGBA;  // alpha is not premultiplied
    config.output.is_external_memory = 1;
    config.output.u.RGBA = {image.rgba8.data(), 4 * header->width, image.rgba8.size()};
    if (const VP8StatusCode code = WebPDecode(bytes_of(file), file.size(), &config); code != VP8_STATUS_OK) return webp_error(code);
    return image;
}

#else

namespace {

tl::unexpected<Error> no_library() { return fail(ErrorCode::bad_input, "WebP pictures need the library libwebp, which this build lacks"); }

}  // namespace

Result<ImageHeader> read_webp_header(std::span<const std::byte>, const ImageLimits&) { return no_library(); }
Result<DecodedImage> decode_webp(std::span<const std::byte>, const ImageLimits&) { return no_library(); }

#endif

}  // namespace detail

#if HALFLIT_HAS_WEBP_ENCODER

Result<std::vector<std::uint8_t>> encode_webp(const Image& image) {
    WebPConfig config;
    WebPPicture picture;
    if (WebPConfigInit(&config) == 0 || WebPPictureInit(&picture) == 0) throw std::bad_alloc();
    const std::unique_ptr<WebPPicture, void (*)(WebPPicture*)> picture_owner(&picture, WebPPictureFree);
    WebPMemoryWriter writer;
    WebPMemoryWriterInit(&writer);
    const std::unique_ptr<WebPMemoryWriter, void (*)(WebPMemoryWriter*)> writer_owner(&writer, WebPMemoryWriterClear);
    config.lossless = 1;
    config.exact = 1;  // keeps colours where alpha is 0
    picture.use_argb = 1;
    picture.width = image.width;
    picture.height = image.height;
    picture.writer = WebPMemoryWrite;
    picture.custom_ptr = &writer;
    if (WebPPictureImportRGBA(&picture, image.rgba8.data(), 4 * image.width) == 0 || WebPEncode(&config, &picture) == 0)
        throw std::bad_alloc();  // the size was checked
    return std::vector<std::uint8_t>(writer.mem, writer.mem + writer.size);
}

#else

Result<std::vector<std::uint8_t>> encode_webp(const Image&) {
    return fail(ErrorCode::usage, "writing WebP pictures needs the library libwebp, which this build lacks");
}

#endif

}  // namespace halflit::io
