// The difference of two pictures of the same size, in 8-bit codes over red, green, blue and alpha.
#pragma once

#include "halflit/target.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace halflit::engine {

struct PictureDiff {
    int max = 0;               ///< largest difference of any channel
    std::uint64_t count = 0;   ///< pixels in which any channel differs
    std::uint64_t pixels = 0;  ///< pixels of each picture
    std::uint64_t sum = 0;     ///< sum of absolute differences over all channels
    std::uint64_t sum_squares = 0;
    std::array<std::uint64_t, 256> pixels_by_codes{};  ///< pixels by the largest difference of their channels

    /// Mean absolute difference over all channels of all pixels.
    [[nodiscard]] double mean() const;
    /// 10 log10(255^2 / mean square); empty if the pictures are equal.
    [[nodiscard]] std::optional<double> psnr() const;
    /// Pixels in which a channel differs by more than `codes`.
    [[nodiscard]] std::uint64_t count_above(int codes) const;
};

/// The difference that still passes: at most the share `max_share` of the pixels (0 to 1) may differ by more than `max_codes`.
struct DiffTolerance {
    int max_codes = 0;
    double max_share = 0.0;
};
[[nodiscard]] bool passes(const PictureDiff& diff, const DiffTolerance& tolerance);

[[nodiscard]] PictureDiff compare_pictures(const Image& a, const Image& b);

/// Absolute differences of colour, with that of alpha added to each channel, stretched so that the largest is 255; opaque.
[[nodiscard]] Image difference_image(const Image& a, const Image& b);

}  // namespace halflit::engine
