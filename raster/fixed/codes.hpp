// Sums and products of codes: red | green << 8 | blue << 16 | alpha << 24.
#pragma once

#include <algorithm>
#include <cstdint>

namespace halflit::raster {

inline constexpr std::uint32_t kRgb = 0xffffff;
inline std::uint32_t channel(std::uint32_t code, int c) { return code >> (8 * c) & 0xffu; }
/// Sums of red, green and blue, at most 255 each.
inline std::uint32_t add_codes(std::uint32_t a, std::uint32_t b) {
    constexpr std::uint32_t kHigh = 0x808080, kLow = 0x7f7f7f;
    const std::uint32_t either = (a ^ b) & kHigh, low = (a & kLow) + (b & kLow);
    const std::uint32_t over = ((a & b) | (either & low)) & kHigh;  // channels above 255
    return ((low ^ either) | ((over << 1) - (over >> 7))) & kRgb;
}
/// a b / 255, rounded.
inline std::uint32_t times(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t product = a * b + 128;
    return (product + (product >> 8)) >> 8;
}
/// A layer over what is behind it: covering it by its alpha, or adding to it.
inline std::uint32_t blended(std::uint32_t over, std::uint32_t under, bool adds) {
    const std::uint32_t alpha = channel(over, 3);
    std::uint32_t out = 0;
    for (int c = 0; c < 3; ++c)
        out |= std::min(times(channel(over, c), alpha) + (adds ? channel(under, c) : times(channel(under, c), 255 - alpha)), 255u)
               << (8 * c);
    return out;
}

}  // namespace halflit::raster
