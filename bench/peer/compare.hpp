// Comparison of two pictures, and statistics of measurements.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace halflit::peer {

/// Differences of pairs of pictures of equal size, four bytes a pixel, alpha included.
struct PictureDifference {
    int largest = 0;                       ///< codes, over all channels
    std::int64_t pixels = 0, above_2 = 0;  ///< above_2: pixels with a channel that differs by more than 2 codes

    void add(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b);
    [[nodiscard]] double share_above_2() const { return pixels > 0 ? static_cast<double>(above_2) / static_cast<double>(pixels) : 0; }
};

/// Middle and quarters of some numbers, and the least.
struct Spread {
    double least = 0, first_quarter = 0, median = 0, third_quarter = 0;
};
[[nodiscard]] Spread spread_of(std::vector<double> values);

}  // namespace halflit::peer
