#include "apps/io/pictures/float_image.hpp"

#include "apps/io/pictures/exr_file.hpp"
#include "apps/io/pictures/pfm_file.hpp"
#include "apps/io/pictures/rgbe_reader.hpp"

#include <fmt/format.h>

namespace halflit::io {

Result<void> check_float_image_size(long long width, long long height, const FloatImageLimits& limits) {
    if (width > limits.max_width || height > limits.max_height)
        return fail(ErrorCode::limit,
                    fmt::format("has {}x{} pixels, the limit is {}x{}", width, height, limits.max_width, limits.max_height));
    if (static_cast<std::size_t>(width) * static_cast<std::size_t>(height) > limits.max_pixels)
        return fail(ErrorCode::limit, fmt::format("has {}x{} pixels, the limit is {} in all", width, height, limits.max_pixels));
    return {};
}

Result<void> check_numbers(const FloatImage& image) {
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
        if (image.rgb[i] != image.rgb[i]) {
            const std::size_t pixel = i / 3, width = static_cast<std::size_t>(image.width);
            return fail(ErrorCode::bad_input, fmt::format("pixel {},{}: expected a number, found NaN", pixel % width, pixel / width));
        }
    return {};
}

bool is_float_image(std::span<const std::byte> file) {
    return is_exr(file) || is_pfm(file) || (file.size() >= 2 && file[0] == std::byte{'#'} && file[1] == std::byte{'?'});
}

Result<FloatImage> decode_float_image(std::span<const std::byte> file, const FloatImageLimits& limits) {
    if (is_exr(file)) return decode_exr(file, limits);
    if (is_pfm(file)) return decode_pfm(file, limits);
    return decode_rgbe(file, limits);
}

}  // namespace halflit::io
