#include "apps/io/pictures/picture_reader.hpp"

#include "apps/io/files/file_access.hpp"
#include "apps/io/files/text.hpp"
#include "apps/io/pictures/float_image.hpp"
#include "apps/io/pictures/image_decoders.hpp"
#include "halflit/image.hpp"
#include "shading/model/srgb.hpp"

#include <algorithm>
#include <array>

namespace halflit::io {
namespace {

bool starts_with(std::span<const std::byte> file, std::string_view prefix) {
    return file.size() >= prefix.size() &&
           std::equal(prefix.begin(), prefix.end(), file.begin(), [](char a, std::byte b) { return std::byte(a) == b; });
}

/// Whatever halflit draws and writes may be read again.
constexpr ImageLimits kOwnPictures{.max_side = 32768, .max_pixels = static_cast<std::size_t>(kMaxImagePixels), .max_jpeg_scans = 64};

/// The 8-bit code nearest to the sRGB encoding of `linear`. The limits between codes are decoded, which needs no C library function, so
/// that the same file gives the same codes everywhere.
std::uint8_t code_of(float linear) {
    static const auto limits = [] {
        std::array<float, 255> middle{};  // between code i and i + 1
        for (std::size_t i = 0; i < middle.size(); ++i)
            middle[i] = static_cast<float>(shading::linear_from_srgb((static_cast<double>(i) + 0.5) / 255.0));
        return middle;
    }();
    return static_cast<std::uint8_t>(std::upper_bound(limits.begin(), limits.end(), linear) - limits.begin());
}

/// Light as 8-bit codes.
Result<Image> decode_light(std::span<const std::byte> file, const ImageLimits& limits) {
    const auto decoded = decode_float_image(file, {limits.max_side, limits.max_side, limits.max_pixels});
    if (!decoded) return tl::unexpected(decoded.error());
    Image image{decoded->width, decoded->height, {}, {}};
    image.rgba8.reserve(decoded->rgb.size() / 3 * 4);
    for (std::size_t i = 0; i < decoded->rgb.size(); i += 3) {
        for (std::size_t c = 0; c < 3; ++c) image.rgba8.push_back(code_of(decoded->rgb[i + c]));
        image.rgba8.push_back(255);
    }
    return image;
}

}  // namespace

Result<Image> decode_picture(std::span<const std::byte> file, std::string_view name, const ImageLimits& limits) {
    if (is_float_image(file)) return decode_light(file, limits);
    const auto format = output_format_of(name);
    const bool tga = format && *format == OutputFormat::tga;
    auto decoded = tga && !starts_with(file, "BM") ? detail::decode_tga(file, limits) : decode_image(file, limits);
    if (!decoded) return tl::unexpected(decoded.error());
    return Image{decoded->width, decoded->height, std::move(decoded->rgba8), {}};
}

Result<Image> read_picture(const std::string& path) {
    const auto file = read_file(path);
    if (!file) return tl::unexpected(file.error());
    auto picture = decode_picture(*file, path, kOwnPictures);
    if (!picture) return fail(picture.error().code, printable(path) + ": " + picture.error().message);
    return picture;
}

bool is_picture_name(std::string_view name) { return name != "-" && output_format_of(name).has_value(); }

}  // namespace halflit::io
