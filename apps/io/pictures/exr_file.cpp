#include "apps/io/pictures/exr_file.hpp"

#include "apps/io/codecs/codec_libraries.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/pictures/exr_header.hpp"
#include "halflit/image.hpp"
#include "sh/time_limit.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace halflit {

bool has_exr() { return HALFLIT_HAS_OPENEXR != 0; }

namespace io {

namespace {

constexpr float kLargestHalf = 65504.0f;

/// The functions of OpenEXR.
Result<const detail::CodecLibraries*> open_exr() {
    if (!has_exr()) return fail(ErrorCode::usage, "EXR files need the library OpenEXR, which this build lacks");
    return detail::codec_libraries();
}

/// Messages of the library may have several lines, and words of the file.
template <class T>
Result<T> in_one_line(Result<T> result) {
    if (result) return result;
    std::replace(result.error().message.begin(), result.error().message.end(), '\n', ' ');
    return fail(result.error().code, printable(result.error().message));
}

}  // namespace

bool is_exr(std::span<const std::byte> file) {
    constexpr std::byte kMark[] = {std::byte{0x76}, std::byte{0x2f}, std::byte{0x31}, std::byte{0x01}};
    return file.size() >= 4 && std::equal(std::begin(kMark), std::end(kMark), file.begin());
}

Result<FloatImage> decode_exr(std::span<const std::byte> file, const FloatImageLimits& limits) {
    const auto library = open_exr();
    if (!library) return tl::unexpected(library.error());
    const auto header = detail::read_exr_header(file, limits);
    if (!header) return tl::unexpected(header.error());
    auto pixels =
        in_one_line((*library)->decode_exr(file, static_cast<int>(header->width), static_cast<int>(header->height), [] { check_time(); }));
    if (!pixels) return tl::unexpected(pixels.error());
    FloatImage image{static_cast<int>(header->width), static_cast<int>(header->height), std::move(pixels->rgb)};
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        const float value = light_of(image.rgb[i]);
        image.rgb[i] = pixels->is_half[i % 3] && value > kLargestHalf ? kLargestHalf : value;
    }
    if (auto ok = check_numbers(image); !ok) return tl::unexpected(ok.error());
    return image;
}

Result<std::vector<std::uint8_t>> encode_exr(int width, int height, std::span<const ExrChannel> channels) {
    const auto library = open_exr();
    if (!library) return tl::unexpected(library.error());
    return in_one_line((*library)->encode_exr(width, height, channels));
}

}  // namespace io
}  // namespace halflit
