#include "halflit/texture.hpp"

#include "shading/model/srgb.hpp"
#include "shading/out_of_memory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <string>
#include <type_traits>

namespace halflit {
namespace {

/// IEC 61966-2-1: 8-bit sRGB code to linear light in 16 bits, rounded to nearest (no code lies near a tie: texture_test).
constexpr std::array<std::uint16_t, 256> make_decode_table() {
    std::array<std::uint16_t, 256> table{};
    for (int code = 0; code < 256; ++code)
        table[static_cast<std::size_t>(code)] = static_cast<std::uint16_t>(shading::linear_from_srgb(code / 255.0) * 65535.0 + 0.5);
    return table;
}
constexpr std::array<std::uint16_t, 256> kLinear16FromSrgb8 = make_decode_table();

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

/// Computes one level from the one above it, whose texel i is at texel_at(i), rounded to integers or to float. The sums of integers (at
/// most 2^16 * 2^28) are exact, so their order does not matter.
template <class Value, class TexelAt>
void reduce(const TexelAt& texel_at, const TextureLevel& large, Value* to, const TextureLevel& small) {
    using Sum = std::conditional_t<std::is_floating_point_v<Value>, double, std::uint64_t>;
    for (int y = 0; y < small.height; ++y) {
        const Box rows = box_of(y, large.height);
        for (int x = 0; x < small.width; ++x) {
            const Box columns = box_of(x, large.width);
            Sum sum[4] = {0, 0, 0, 0};
            for (std::int64_t j = 0; j < rows.count; ++j) {
                for (std::int64_t i = 0; i < columns.count; ++i) {
                    const std::uint64_t weight = rows.weight[j] * columns.weight[i];
                    const auto* texel = texel_at(static_cast<std::size_t>((rows.first + j) * large.width + columns.first + i));
                    for (int c = 0; c < 4; ++c) sum[c] += static_cast<Sum>(weight) * texel[c];
                }
            }
            const std::uint64_t total = rows.total * columns.total;
            for (int c = 0; c < 4; ++c) {
                if constexpr (std::is_floating_point_v<Value>)
                    *to++ = static_cast<Value>(sum[c] / static_cast<double>(total));
                else
                    *to++ = static_cast<std::uint16_t>((sum[c] + total / 2) / total);
            }
        }
    }
}

/// Channel values of several texels at a time: lane i holds channel i % 4.
constexpr std::size_t kLanes = 32;
using Lanes = std::array<std::uint16_t, kLanes>;

/// `sum` = combine(sum, value(i)) for all i below `values`. Works on a copy on the stack, so that the compiler knows that nothing else
/// changes it.
template <class Combine, class Value>
void accumulate(Lanes& sum, std::size_t values, const Combine& combine, const Value& value) {
    Lanes lanes = sum;
    std::size_t i = 0;
    for (; i + kLanes <= values; i += kLanes)
        for (std::size_t lane = 0; lane < kLanes; ++lane) lanes[lane] = combine(lanes[lane], value(i + lane));
    for (; i < values; ++i) lanes[i % kLanes] = combine(lanes[i % kLanes], value(i));
    sum = lanes;
}

TextureRange range_of(const std::uint16_t* data, const std::vector<TextureLevel>& levels) {
    const auto smaller = [](std::uint16_t a, std::uint16_t b) { return a < b ? a : b; };
    const auto larger = [](std::uint16_t a, std::uint16_t b) { return a > b ? a : b; };
    Lanes least, most{}, step{};
    least.fill(65535);
    const auto add_steps = [&](const std::uint16_t* a, const std::uint16_t* b, std::size_t values) {
        accumulate(step, values, larger,
                   [=](std::size_t i) { return static_cast<std::uint16_t>(larger(a[i], b[i]) - smaller(a[i], b[i])); });
    };
    for (const TextureLevel& level : levels) {
        const std::size_t row = std::size_t{4} * static_cast<std::size_t>(level.width), rows = static_cast<std::size_t>(level.height);
        const std::uint16_t* first = data + std::size_t{4} * static_cast<std::size_t>(level.offset);
        const auto value = [=](std::size_t i) { return first[i]; };
        accumulate(least, row * rows, smaller, value);
        accumulate(most, row * rows, larger, value);
        add_steps(first, first + row, row * (rows - 1));
        add_steps(first, first + row * (rows - 1), row);
        for (std::size_t y = 0; y < rows; ++y) {
            add_steps(first + y * row, first + y * row + 4, row - 4);
            add_steps(first + y * row, first + (y + 1) * row - 4, 4);
        }
    }
    TextureRange range{{65535, 65535, 65535, 65535}, {}, {}};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        range.least[lane % 4] = smaller(range.least[lane % 4], least[lane]);
        range.most[lane % 4] = larger(range.most[lane % 4], most[lane]);
        range.step[lane % 4] = larger(range.step[lane % 4], step[lane]);
    }
    return range;
}

/// The largest difference between the smaller levels as stored and as they would be without rounding, made from the stored level 0; units
/// of 1 / 65535. Levels are kept as float here, which is off by at most 1/256 of that unit a level.
float chain_error(const std::uint16_t* data, std::span<const TextureLevel> levels) {
    std::vector<float> large, small;
    float largest = 0.0f;
    for (std::size_t l = 1; l < levels.size(); ++l) {
        const auto values = std::size_t{4} * static_cast<std::size_t>(levels[l].width) * static_cast<std::size_t>(levels[l].height);
        small.resize(values);
        if (l == 1)
            reduce([=](std::size_t i) { return data + 4 * i; }, levels[0], small.data(), levels[1]);
        else
            reduce([&](std::size_t i) -> const float* { return &large[4 * i]; }, levels[l - 1], small.data(), levels[l]);
        large.swap(small);
        const std::uint16_t* stored = data + std::size_t{4} * static_cast<std::size_t>(levels[l].offset);
        for (std::size_t i = 0; i < values; ++i) largest = std::max(largest, std::fabs(large[i] - static_cast<float>(stored[i])));
    }
    return largest + static_cast<float>(levels.size()) / 256.0f;
}

std::vector<TextureLevel> level_layout(int width, int height) {
    std::vector<TextureLevel> levels{{width, height, 0}};
    while (levels.back().width > 1 || levels.back().height > 1) {
        const TextureLevel& last = levels.back();
        levels.push_back({std::max(1, last.width / 2), std::max(1, last.height / 2), last.offset + last.width * last.height});
    }
    return levels;
}

Result<void> check_size(int width, int height, std::size_t channel_values) {
    if (width < 1 || height < 1 || width > kMaxTextureSide || height > kMaxTextureSide)
        return fail(ErrorCode::limit, "texture: " + std::to_string(width) + " x " + std::to_string(height) + " texels, expected 1 to " +
                                          std::to_string(kMaxTextureSide) + " a side");
    const std::size_t expected = std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (channel_values != expected)
        return fail(ErrorCode::bad_input, "texture: " + std::to_string(channel_values) + " channel values, expected " +
                                              std::to_string(expected) + " for " + std::to_string(width) + " x " + std::to_string(height));
    return {};
}

}  // namespace

template <class ReadTexel>
Result<Texture> Texture::make(int width, int height, ReadTexel read_texel) {
    try {
        Texture texture;
        texture.levels_ = level_layout(width, height);
        const TextureLevel& last = texture.levels_.back();
        texture.data_.resize(std::size_t{4} * static_cast<std::size_t>(last.offset + last.width * last.height));
        const std::size_t texels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        for (std::size_t i = 0; i < texels; ++i) read_texel(i, &texture.data_[4 * i]);
        for (std::size_t l = 1; l < texture.levels_.size(); ++l) {
            const TextureLevel &large = texture.levels_[l - 1], &small = texture.levels_[l];
            const std::uint16_t* from = texture.data_.data() + std::size_t{4} * static_cast<std::size_t>(large.offset);
            reduce([=](std::size_t i) { return from + 4 * i; }, large,
                   texture.data_.data() + std::size_t{4} * static_cast<std::size_t>(small.offset), small);
        }
        texture.range_ = range_of(texture.data_.data(), texture.levels_);
        return texture;
    } catch (const std::bad_alloc&) {
        return fail_out_of_memory(
            [&] { return "texture: out of memory for " + std::to_string(width) + " x " + std::to_string(height) + " texels"; });
    }
}

Result<Texture> Texture::from_rgba8(std::span<const std::uint8_t> rgba8, int width, int height, ColorSpace space) {
    if (auto size = check_size(width, height, rgba8.size()); !size) return tl::unexpected(size.error());
    return make(width, height, [&](std::size_t i, std::uint16_t* texel) {
        for (std::size_t c = 0; c < 4; ++c) {
            const std::uint8_t code = rgba8[4 * i + c];
            // 257 = 65535 / 255 exactly.
            texel[c] = space == ColorSpace::srgb && c < 3 ? kLinear16FromSrgb8[code] : static_cast<std::uint16_t>(code * 257);
        }
    });
}

Result<Texture> Texture::from_rgba16(std::span<const std::uint16_t> rgba16, int width, int height) {
    if (auto size = check_size(width, height, rgba16.size()); !size) return tl::unexpected(size.error());
    return make(width, height, [&](std::size_t i, std::uint16_t* texel) { std::copy_n(&rgba16[4 * i], 4, texel); });
}

float Texture::storage_error() const {
    float known = storage_error_.value.load(std::memory_order_relaxed);
    if (known < 0.0f) {
        // Half a unit for level 0, which the averages of the smaller levels pass on.
        known = 0.5f + chain_error(data_.data(), levels_);
        storage_error_.value.store(known, std::memory_order_relaxed);  // another thread finds the same
    }
    return known;
}

}  // namespace halflit
