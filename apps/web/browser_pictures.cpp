#include "apps/web/browser_pictures.hpp"
#include "apps/io/files/optional_libraries.hpp"

#include "apps/io/pictures/image_decoders.hpp"
#include "halflit/target.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace halflit {
namespace {

using Bytes = std::span<const std::byte>;
using Key = std::pair<std::uint64_t, std::size_t>;  // hash and length of the file

std::map<Key, io::DecodedImage> given_pictures;
std::vector<std::vector<std::byte>> wanted;

Key key_of(Bytes file) { return {pixel_hash({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()}), file.size()}; }

#if !HALFLIT_HAS_WEBP

unsigned byte_at(Bytes file, std::size_t at) { return at < file.size() ? std::to_integer<unsigned>(file[at]) : 0u; }

struct Sides {
    unsigned width = 0, height = 0;
};

/// From a JPEG's frame header.
std::optional<Sides> jpeg_sides(Bytes file) {
    for (std::size_t at = 2; at + 9 < file.size();) {
        if (byte_at(file, at) != 0xFF) return std::nullopt;
        const unsigned marker = byte_at(file, at + 1);
        const bool is_fill = marker == 0xFF, stands_alone = marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8);
        if (is_fill || stands_alone) {
            at += is_fill ? 1 : 2;
            continue;
        }
        const bool is_frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
        if (is_frame) return Sides{byte_at(file, at + 7) << 8 | byte_at(file, at + 8), byte_at(file, at + 5) << 8 | byte_at(file, at + 6)};
        at += 2 + (byte_at(file, at + 2) << 8 | byte_at(file, at + 3));
    }
    return std::nullopt;
}

/// From the first chunk of a WebP file: with extensions, without loss, or with it.
std::optional<Sides> webp_sides(Bytes file) {
    if (file.size() < 30) return std::nullopt;
    const auto number = [&](std::size_t at, int bytes) {
        unsigned value = 0;
        for (int i = bytes - 1; i >= 0; --i) value = value << 8 | byte_at(file, at + static_cast<std::size_t>(i));
        return value;
    };
    switch (byte_at(file, 15)) {
        case 'X':
            return Sides{number(24, 3) + 1, number(27, 3) + 1};
        case 'L': {
            const unsigned bits = number(21, 4);
            return Sides{(bits & 0x3FFFu) + 1, (bits >> 14 & 0x3FFFu) + 1};
        }
        default:
            return Sides{number(26, 2) & 0x3FFFu, number(28, 2) & 0x3FFFu};
    }
}

Result<io::ImageHeader> header_of(io::ImageFormat format, const std::optional<Sides>& sides, const io::ImageLimits& limits) {
    if (!sides) return fail(ErrorCode::bad_input, "the picture has no sound header");
    if (const auto size = io::detail::check_image_size(sides->width, sides->height, limits); !size) return tl::unexpected(size.error());
    return io::ImageHeader{format, static_cast<int>(sides->width), static_cast<int>(sides->height), 8};
}

Result<io::DecodedImage> given(Bytes file) {
    if (const auto found = given_pictures.find(key_of(file)); found != given_pictures.end()) {
        if (found->second.width == 0) return fail(ErrorCode::bad_input, "the browser cannot decode this picture");
        return found->second;
    }
    const auto same = [&](const std::vector<std::byte>& other) { return key_of(other) == key_of(file); };
    if (std::none_of(wanted.begin(), wanted.end(), same)) wanted.emplace_back(file.begin(), file.end());
    return fail(ErrorCode::io, "the browser has not decoded this picture yet");
}

#endif

}  // namespace

namespace web {

const std::vector<std::vector<std::byte>>& wanted_pictures() { return wanted; }

void give_picture(std::size_t index, int width, int height, std::vector<std::uint8_t> rgba8) {
    if (index < wanted.size()) given_pictures[key_of(wanted[index])] = io::DecodedImage{width, height, std::move(rgba8), {}};
}

void forget_wanted_pictures() { wanted.clear(); }

void forget_given_pictures() { given_pictures.clear(); }

}  // namespace web

#if !HALFLIT_HAS_WEBP

namespace io {

bool has_webp() { return true; }

namespace detail {

Result<ImageHeader> read_jpeg_header(Bytes file, const ImageLimits& limits) {
    return header_of(ImageFormat::jpeg, jpeg_sides(file), limits);
}

Result<void> decode_jpeg_rows(Bytes file, const ImageLimits& /*limits*/, RowSink& sink) {
    const auto image = given(file);
    if (!image) return tl::unexpected(image.error());
    add_rows(*image, sink);
    return {};
}

Result<ImageHeader> read_webp_header(Bytes file, const ImageLimits& limits) {
    return header_of(ImageFormat::webp, webp_sides(file), limits);
}

Result<DecodedImage> decode_webp(Bytes file, const ImageLimits& /*limits*/) { return given(file); }

}  // namespace detail
}  // namespace io

#endif

}  // namespace halflit
