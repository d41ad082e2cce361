// Texels of a texture, which its copies share, and the boxes that make a mip level from the one above it.
#pragma once

#include "halflit/texture.hpp"
#include "shading/large_block.hpp"

#include <cstdint>
#include <mutex>

namespace halflit {

/// The box that one texel of the next smaller level covers along one axis. Its weights are exact fractions of `total`:
/// an even size halves (1, 1); an odd size 2n+1 becomes n, and the box is 2 + 1/n texels long, so three texels share it.
struct Box {
    std::int64_t first, count;
    std::uint64_t weight[3], total;
};

constexpr Box box_of(int i, int size) {
    if (size == 1) return {0, 1, {1, 0, 0}, 1};
    const std::int64_t first = 2 * std::int64_t{i};
    if (size % 2 == 0) return {first, 2, {1, 1, 0}, 2};
    const auto n = static_cast<std::uint64_t>(size / 2), at = static_cast<std::uint64_t>(i);
    return {first, 3, {n - at, n, at + 1}, 2 * n + 1};
}

/// Computes row y of a level from the rows of the one above it that its box covers: at most three; the rest of `from` is not read. The sums
/// (at most 2^16 * 2^28) are exact, so their order does not matter.
inline void reduce_row(const std::uint16_t* const (&from)[3], const TextureLevel& large, std::uint16_t* to, const TextureLevel& small,
                       int y) {
    const Box rows = box_of(y, large.height);
    for (int x = 0; x < small.width; ++x) {
        const Box columns = box_of(x, large.width);
        std::uint64_t sum[4] = {0, 0, 0, 0};
        for (std::int64_t j = 0; j < rows.count; ++j) {
            const std::uint16_t* texel = from[j] + 4 * columns.first;
            for (std::int64_t i = 0; i < columns.count; ++i, texel += 4) {
                const std::uint64_t weight = rows.weight[j] * columns.weight[i];
                for (int c = 0; c < 4; ++c) sum[c] += weight * texel[c];
            }
        }
        const std::uint64_t total = rows.total * columns.total;
        for (int c = 0; c < 4; ++c) *to++ = static_cast<std::uint16_t>((sum[c] + total / 2) / total);
    }
}

struct Texture::Texels {
    shading::LargeBlock<std::uint16_t> memory;
    std::once_flag least_measured;
    std::array<std::uint16_t, 4> least{};
};

}  // namespace halflit
