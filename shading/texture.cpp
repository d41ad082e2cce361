// Measures of a texture, for bounds on the error of filtering.
#include "sh/config.hpp"
#include "sh/fp_environment.hpp"
#include "shading/texture_texels.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace halflit {
namespace {

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
        for (std::size_t y = 0; y < rows; ++y) {  // row by row, so that memory is read once
            const std::uint16_t *const at = first + y * row, *const below = first + (y + 1 < rows ? (y + 1) * row : 0);
            const auto value = [=](std::size_t i) { return at[i]; };
            accumulate(least, row, smaller, value);
            accumulate(most, row, larger, value);
            add_steps(at, below, row);
            add_steps(at, at + 4, row - 4);
            add_steps(at, at + row - 4, 4);
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
float chain_error(const std::uint16_t* data, std::span<const TextureLevel> levels, MipRule rule) {
    std::vector<float> large, small;
    float largest = 0.0f;
    for (std::size_t l = 1; l < levels.size(); ++l) {
        const auto values = std::size_t{4} * static_cast<std::size_t>(levels[l].width) * static_cast<std::size_t>(levels[l].height);
        small.resize(values);
        const std::size_t row = std::size_t{4} * static_cast<std::size_t>(levels[l].width);
        for (int y = 0; y < levels[l].height; ++y) {
            float* to = small.data() + row * static_cast<std::size_t>(y);
            const std::size_t large_row = std::size_t{4} * static_cast<std::size_t>(levels[l - 1].width);
            const auto rows_of = [&](const auto* texels, auto& rows) {
                const Box box = box_of(y, levels[l - 1].height);
                for (std::int64_t j = 0; j < box.count; ++j) rows[j] = texels + large_row * static_cast<std::size_t>(box.first + j);
            };
            if (l == 1) {
                const std::uint16_t* rows[3] = {};
                rows_of(data, rows);
                reduce_row(rows, levels[0], to, levels[1], y);
            } else {
                const float* rows[3] = {};
                rows_of(large.data(), rows);
                reduce_row(rows, levels[l - 1], to, levels[l], y);
            }
        }
        large.swap(small);
        const std::uint16_t* stored = data + std::size_t{4} * static_cast<std::size_t>(levels[l].offset);
        for (std::size_t i = 0; i < values; ++i)
            if (i % 4 != 3 || rule == MipRule::equal) largest = std::max(largest, std::fabs(large[i] - static_cast<float>(stored[i])));
    }
    return largest + static_cast<float>(levels.size()) / 256.0f;
}

}  // namespace

const TextureRange& Texture::range() const {
    const FpEnvironment environment_of_host;
    HALFLIT_ASSERT(texels_ != nullptr);
    std::call_once(texels_->range_measured, [&] { texels_->range = range_of(data_.data(), levels_); });
    return texels_->range;
}

float Texture::storage_error() const {
    const FpEnvironment environment_of_host;
    HALFLIT_ASSERT(texels_ != nullptr);
    float known = texels_->storage_error.load(std::memory_order_relaxed);
    if (known < 0.0f) {
        // Half a unit for level 0, which the averages of the smaller levels pass on.
        constexpr float kOnce = 0.51f;  // one rounding, of means in double
        known = 0.5f + (rule_ == MipRule::alpha ? kOnce : chain_error(data_.data(), levels_, rule_));
        if (rule_ == MipRule::normal) known = std::max(known, 0.5f + kOnce);
        texels_->storage_error.store(known, std::memory_order_relaxed);  // another thread finds the same
    }
    return known;
}

}  // namespace halflit
