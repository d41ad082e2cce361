#include "raster/passes/splat_order.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace halflit::raster {

/// The leading digits decide nearly always: two passes of a radix sort go by them, and runs of equal ones are sorted by all digits.
void sort_by_distance(std::span<std::uint32_t> numbers, const double* distances, RawBuffer<std::uint64_t>& scratch, StopSignal& stop) {
    constexpr int kDigit = 11, kNumberBits = 32;
    constexpr std::size_t kValues = std::size_t{1} << kDigit, kAtOnce = 4096;
    const std::size_t count = numbers.size();
    if (count < 2) return;
    const auto each = [&](const auto& visit) {
        for (std::size_t i = 0; i < count; ++i) {
            if (i % kAtOnce == 0) stop.check();
            visit(i);
        }
    };
    // Leading digits of the distance, and the number. A power of two, so that few calls need more than the last.
    std::uint64_t* const keys = scratch.reserve(2 * std::bit_ceil(count), stop);
    std::uint64_t* const other = keys + count;
    const auto bits = [&](std::uint32_t number) { return std::bit_cast<std::uint64_t>(distances[number]); };  // ordered as the distances
    std::uint64_t least = ~std::uint64_t{0}, most = 0;
    each([&](std::size_t i) { keys[i] = bits(numbers[i]), least = std::min(least, keys[i]), most = std::max(most, keys[i]); });
    const int drop = std::max(static_cast<int>(std::bit_width(most - least)) - 2 * kDigit, 0);
    std::array<std::uint32_t, kValues> places[2] = {};
    each([&](std::size_t i) {
        const auto leading = static_cast<std::size_t>((keys[i] - least) >> drop);
        ++places[0][leading & (kValues - 1)], ++places[1][leading >> kDigit];
        keys[i] = std::uint64_t{leading} << kNumberBits | numbers[i];
    });
    for (int pass = 0; pass < 2; ++pass) {
        std::uint32_t sum = 0;
        for (std::uint32_t& n : places[pass]) sum += std::exchange(n, sum);
        const std::uint64_t* const from = pass == 0 ? keys : other;
        std::uint64_t* const to = pass == 0 ? other : keys;
        each([&](std::size_t i) { to[places[pass][from[i] >> (kNumberBits + pass * kDigit) & (kValues - 1)]++] = from[i]; });
    }
    std::size_t steps = 0;
    for (std::size_t i = 0; i < count && drop > 0;) {
        std::size_t end = i + 1;
        while (end < count && (keys[end] ^ keys[i]) >> kNumberBits == 0) ++end;
        if (end > i + 1)
            std::sort(keys + i, keys + end, [&](std::uint64_t a, std::uint64_t b) {
                if (++steps % kAtOnce == 0) stop.check();
                const std::uint64_t at_a = bits(static_cast<std::uint32_t>(a)), at_b = bits(static_cast<std::uint32_t>(b));
                return at_a != at_b ? at_a < at_b : a < b;
            });
        i = end;
    }
    each([&](std::size_t i) { numbers[i] = static_cast<std::uint32_t>(keys[i]); });
}

}  // namespace halflit::raster
