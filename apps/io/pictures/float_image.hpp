// Decoding of pictures of linear floats: Radiance (.hdr), Portable Float Map (.pfm) and OpenEXR (.exr).
#pragma once

#include "halflit/error.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace halflit::io {

struct FloatImageLimits {
    int max_width = 16384, max_height = 8192;  ///< limits of the picture as it is shown
    std::size_t max_pixels = ~std::size_t{0};
};

struct FloatImage {
    int width = 0, height = 0;
    std::vector<float> rgb;  ///< linear, three floats per pixel in [0, 1e30], row 0 on top, column 0 at the left
};

/// Largest value of a decoded picture. Larger ones become this.
inline constexpr float kLargestLight = 1e30f;

/// True if the file begins as one of the three formats does.
[[nodiscard]] bool is_float_image(std::span<const std::byte> file);

/// Decodes the format that the first bytes tell; others fail as a Radiance picture. Errors: bad_input for broken files, limit above
/// `limits`, which is checked on the header; usage for an EXR file where the library is built without OpenEXR. Messages have no file
/// prefix.
[[nodiscard]] Result<FloatImage> decode_float_image(std::span<const std::byte> file, const FloatImageLimits& limits = {});

/// Fails above the limits.
[[nodiscard]] Result<void> check_float_image_size(long long width, long long height, const FloatImageLimits& limits);

/// A stored value as light: negative values, as filters leave them, become 0, and values above kLargestLight become that. A NaN stays.
[[nodiscard]] inline float light_of(float stored) {
    if (stored < 0.0f) return 0.0f;
    return stored > kLargestLight ? kLargestLight : stored;
}

/// Fails if a value is a NaN, and names its pixel.
[[nodiscard]] Result<void> check_numbers(const FloatImage& image);

}  // namespace halflit::io
