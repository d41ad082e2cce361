#include "apps/io/pictures/png_filter.hpp"

#include <bit>
#include <cstring>

namespace halflit::io::detail {

namespace {

// Vectors of the compiler: the same operations on every processor, all of them exact integers.
typedef std::int16_t Pair [[gnu::vector_size(16)]];  // two pixels of four channels
typedef std::uint8_t Octets [[gnu::vector_size(16)]];
typedef std::uint32_t Words [[gnu::vector_size(16)]];
typedef std::uint64_t Longs [[gnu::vector_size(16)]];

std::uint32_t load(const std::uint8_t* at) {
    std::uint32_t pixel;
    std::memcpy(&pixel, at, 4);
    return pixel;
}

void store(std::uint8_t* at, std::uint64_t pixel) {
    const auto low = static_cast<std::uint32_t>(pixel);
    std::memcpy(at, &low, 4);
}

Pair widen(std::uint32_t first, std::uint32_t second) {
    const Octets octets = reinterpret_cast<Octets>(Words{first, second, 0, 0}), zero{};
    if constexpr (std::endian::native == std::endian::little)
        return reinterpret_cast<Pair>(__builtin_shufflevector(octets, zero, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23));
    else
        return reinterpret_cast<Pair>(__builtin_shufflevector(zero, octets, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23));
}

/// The low bytes of the eight numbers, whose high ones are 0: a pixel in the low half of each result, on machines of either byte order.
Longs narrow(Pair pair) {
    Words words = reinterpret_cast<Words>(pair);
    words = (words | words >> 8) & 0xFFFF;
    const Longs longs = reinterpret_cast<Longs>(words);
    return longs | longs >> 16;
}

Pair absolute(Pair a) {
    const Pair negative = -a;
    return a > negative ? a : negative;
}
Pair least(Pair a, Pair b) { return a < b ? a : b; }

/// All bits where the pixel's row has this filter.
Pair rows_with(std::uint8_t filter, FilteredRow upper, FilteredRow lower) {
    const auto first = static_cast<std::int16_t>(*upper == filter ? -1 : 0), second = static_cast<std::int16_t>(*lower == filter ? -1 : 0);
    return Pair{first, first, first, first, second, second, second, second};
}

}  // namespace

void undo_png_filters(FilteredRow upper, FilteredRow lower, std::size_t channels, std::size_t width, const std::uint8_t* above,
                      std::uint8_t* upper_pixels, std::uint8_t* lower_pixels) {
    const Pair has_left = rows_with(1, upper, lower), has_up = rows_with(2, upper, lower), has_mean = rows_with(3, upper, lower),
               has_paeth = rows_with(4, upper, lower);
    // Each pixel waits for the one on its left. So two rows are done side by side: the lower one is a pixel behind, and the pixel above its
    // own is the last result of the upper one.
    Pair left{}, up{};
    const auto next = [&](Pair differences, std::uint32_t pixel_above) {
        const Pair left_above = up;
        const Pair loaded = widen(pixel_above, 0);
        up = __builtin_shufflevector(loaded, left, 0, 1, 2, 3, 8, 9, 10, 11);
        const Pair by_up = up - left_above, by_left = left - left_above;
        const Pair to_left = absolute(by_up), to_up = absolute(by_left), to_left_above = absolute(by_up + by_left);
        const Pair smallest = least(to_left_above, least(to_left, to_up));
        const Pair paeth = smallest == to_left ? left : smallest == to_up ? up : left_above;
        const Pair predicted = (left & has_left) | (up & has_up) | (((left + up) >> 1) & has_mean) | (paeth & has_paeth);
        left = (predicted + differences) & 255;
        return narrow(left);
    };
    const std::uint8_t *of_upper = upper + 1, *of_lower = lower + 1;
    store(upper_pixels, next(widen(load(of_upper), 0), load(above))[0]);
    for (std::size_t x = 1; x <= width; ++x) {
        of_upper += channels;
        const Longs pixels = next(widen(load(of_upper), load(of_lower)), load(above + 4 * x));
        of_lower += channels;
        store(upper_pixels + 4 * x, pixels[0]);
        store(lower_pixels + 4 * (x - 1), pixels[1]);
    }
}

}  // namespace halflit::io::detail
