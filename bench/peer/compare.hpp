// Comparison of two pictures, and statistics of measurements.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace halflit::peer {

/// Differences of two pictures of equal size, four bytes a pixel, alpha included.
struct PictureDifference {
    int largest = 0;           ///< codes, over all channels
    double share_above_2 = 0;  ///< part of the pixels with a channel that differs by more than 2 codes
};
[[nodiscard]] PictureDifference difference(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b);

/// Middle and quarters of some numbers, and the least.
struct Spread {
    double least = 0, first_quarter = 0, median = 0, third_quarter = 0;
};
[[nodiscard]] Spread spread_of(std::vector<double> values);

}  // namespace halflit::peer
