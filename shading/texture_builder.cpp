// Making of textures: texels as they come, and the mip levels.
#include "sh/config.hpp"
#include "sh/fp_environment.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/model/srgb.hpp"
#include "shading/moment_levels.hpp"
#include "shading/out_of_memory.hpp"
#include "shading/texture_texels.hpp"

#include <algorithm>
#include <array>
#include <string>

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

std::vector<TextureLevel> level_layout(int width, int height) {
    std::vector<TextureLevel> levels{{width, height, 0}};
    while (levels.back().width > 1 || levels.back().height > 1) {
        const TextureLevel& last = levels.back();
        levels.push_back({std::max(1, last.width / 2), std::max(1, last.height / 2), last.offset + last.width * last.height});
    }
    return levels;
}

Result<void> check_sides(int width, int height) {
    if (width < 1 || height < 1 || width > kMaxTextureSide || height > kMaxTextureSide)
        return fail(ErrorCode::limit, "texture: " + std::to_string(width) + " x " + std::to_string(height) + " texels, expected 1 to " +
                                          std::to_string(kMaxTextureSide) + " a side");
    return {};
}

Result<void> check_size(int width, int height, std::size_t channel_values) {
    if (auto sides = check_sides(width, height); !sides) return sides;
    const std::size_t expected = std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (channel_values != expected)
        return fail(ErrorCode::bad_input, "texture: " + std::to_string(channel_values) + " channel values, expected " +
                                              std::to_string(expected) + " for " + std::to_string(width) + " x " + std::to_string(height));
    return {};
}

}  // namespace

TextureBuilder::TextureBuilder() = default;
TextureBuilder::TextureBuilder(TextureBuilder&&) noexcept = default;
TextureBuilder& TextureBuilder::operator=(TextureBuilder&&) noexcept = default;
TextureBuilder::~TextureBuilder() = default;

Result<TextureBuilder> TextureBuilder::make(int width, int height, MipRule rule, int skip_levels) {
    if (auto sides = check_sides(width, height); !sides) return tl::unexpected(sides.error());
    try {
        TextureBuilder builder;
        builder.kernels_ = &shading::usual_kernels();
        builder.levels_ = level_layout(width, height);
        const auto skipped = static_cast<std::size_t>(std::clamp(skip_levels, 0, static_cast<int>(builder.levels_.size()) - 1));
        for (std::size_t level = 0; level < skipped; ++level)
            builder.held_.emplace_back(std::size_t{4 * kHeldRows} * static_cast<std::size_t>(builder.levels_[level].width));
        Texture& texture = builder.texture_;
        texture.levels_.assign(builder.levels_.begin() + static_cast<std::ptrdiff_t>(skipped), builder.levels_.end());
        const std::int32_t first = texture.levels_.front().offset;
        for (TextureLevel& level : texture.levels_) level.offset -= first;
        const TextureLevel& last = texture.levels_.back();
        const auto values = std::size_t{4} * static_cast<std::size_t>(last.offset + last.width * last.height);
        texture.texels_ = std::make_shared<Texture::Texels>();
        texture.texels_->memory = shading::make_large_block<std::uint16_t>(values);
        texture.data_ = {texture.texels_->memory.get(), values};
        builder.rows_.assign(builder.levels_.size(), 0);
        texture.rule_ = rule;
        if (rule != MipRule::equal) builder.moments_ = std::make_unique<MomentLevels>(rule, builder.levels_.size(), *builder.kernels_);
        return builder;
    } catch (const std::bad_alloc&) {
        return fail_out_of_memory(
            [&] { return "texture: out of memory for " + std::to_string(width) + " x " + std::to_string(height) + " texels"; });
    }
}

std::uint16_t* TextureBuilder::row(std::size_t level, int y) {
    const auto width = static_cast<std::size_t>(levels_[level].width), at = static_cast<std::size_t>(y);
    if (level < held_.size()) return held_[level].data() + 4 * width * (at % kHeldRows);
    const TextureLevel& kept = texture_.levels_[level - held_.size()];
    return texture_.texels_->memory.get() + 4 * (static_cast<std::size_t>(kept.offset) + at * width);
}

std::uint16_t* TextureBuilder::next_row() {
    if (rows_.empty() || rows_[0] == levels_[0].height) return nullptr;
    return row(0, rows_[0]);
}

void TextureBuilder::add_row(const std::uint8_t* rgba8, ColorSpace space) {
    const FpEnvironment environment_of_host;
    std::uint16_t* const to = next_row();
    if (to == nullptr) return;
    const auto values = std::size_t{4} * static_cast<std::size_t>(levels_[0].width);
    // 257 = 65535 / 255 exactly.
    if (space == ColorSpace::linear)
        for (std::size_t i = 0; i < values; ++i) to[i] = static_cast<std::uint16_t>(rgba8[i] * 257);
    else
        for (std::size_t i = 0; i < values; i += 4) {
            for (std::size_t c = 0; c < 3; ++c) to[i + c] = kLinear16FromSrgb8[rgba8[i + c]];
            to[i + 3] = static_cast<std::uint16_t>(rgba8[i + 3] * 257);
        }
    reduce(0);
}

void TextureBuilder::add_row(const std::uint16_t* rgba16) {
    const FpEnvironment environment_of_host;
    std::uint16_t* const to = next_row();
    if (to == nullptr) return;
    std::copy_n(rgba16, std::size_t{4} * static_cast<std::size_t>(levels_[0].width), to);
    reduce(0);
}

/// Counts a row of a level as done, and makes the rows of smaller levels that need no other.
void TextureBuilder::reduce(std::size_t level) {
    const TextureLevel& large = levels_[level];
    if (level == 0 && texture_.rule_ == MipRule::normal) {
        std::uint16_t* const done = next_row();
        for (int x = 0; x < large.width; ++x) done[4 * x + 3] = 0;
    }
    ++rows_[level];
    if (level + 1 == rows_.size()) return;
    const TextureLevel& small = levels_[level + 1];
    while (rows_[level + 1] < small.height) {
        const int y = rows_[level + 1];
        const Box box = box_of(y, large.height);
        if (box.first + box.count > rows_[level]) return;
        const std::uint16_t* from[3] = {};
        for (std::int64_t j = 0; j < box.count; ++j) from[j] = row(level, static_cast<int>(box.first + j));
        std::uint16_t* const to = row(level + 1, y);
        if (texture_.rule_ != MipRule::alpha) {
            if (large.width % 2 == 0 && large.height % 2 == 0)
                kernels_->halve_texels(from[0], from[1], small.width, to);
            else
                reduce_row(from, large, to, small, y);
        }
        if (moments_ != nullptr) moments_->reduce(from, large, level + 1, small, y, to);
        reduce(level + 1);
    }
}

Texture TextureBuilder::finish() {
    const FpEnvironment environment_of_host;
    while (std::uint16_t* const to = next_row()) {
        const auto values = std::size_t{4} * static_cast<std::size_t>(levels_[0].width);
        if (rows_[0] > 0)
            std::copy_n(row(0, rows_[0] - 1), values, to);
        else
            std::fill_n(to, values, std::uint16_t{0});
        reduce(0);
    }
    rows_.clear();
    return std::move(texture_);
}

Result<Texture> Texture::from_rgba8(std::span<const std::uint8_t> rgba8, int width, int height, ColorSpace space, MipRule rule) {
    const FpEnvironment environment_of_host;
    if (auto size = check_size(width, height, rgba8.size()); !size) return tl::unexpected(size.error());
    auto builder = TextureBuilder::make(width, height, rule);
    if (!builder) return tl::unexpected(builder.error());
    const auto row = std::size_t{4} * static_cast<std::size_t>(width);
    for (std::size_t at = 0; at < rgba8.size(); at += row) builder->add_row(&rgba8[at], space);
    return builder->finish();
}

Result<Texture> Texture::from_rgba16(std::span<const std::uint16_t> rgba16, int width, int height, MipRule rule) {
    const FpEnvironment environment_of_host;
    if (auto size = check_size(width, height, rgba16.size()); !size) return tl::unexpected(size.error());
    auto builder = TextureBuilder::make(width, height, rule);
    if (!builder) return tl::unexpected(builder.error());
    const auto row = std::size_t{4} * static_cast<std::size_t>(width);
    for (std::size_t at = 0; at < rgba16.size(); at += row) builder->add_row(&rgba16[at]);
    return builder->finish();
}

}  // namespace halflit
