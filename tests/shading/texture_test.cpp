// Creation of textures: decoding, levels, limits.
#include "halflit/texture.hpp"

#include "floats.hpp"
#include "shading/kernels/shade_kernels.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace halflit;
using namespace halflit::shading;

namespace {

std::vector<std::uint8_t> constant_picture(int width, int height, std::uint8_t code) {
    return std::vector<std::uint8_t>(static_cast<std::size_t>(width * height * 4), code);
}

double texel_value(const Texture& texture, std::size_t level, int x, int y, int channel) {
    const TextureLevel& l = texture.levels()[level];
    return texture.data()[static_cast<std::size_t>(4 * (l.offset + y * l.width + x) + channel)];
}

}  // namespace

TEST_CASE("texture: sRGB codes decode to the nearest 16-bit value, alpha stays linear", "[shading][texture]") {
    std::vector<std::uint8_t> ramp;
    for (int code = 0; code < 256; ++code) ramp.insert(ramp.end(), 4, static_cast<std::uint8_t>(code));
    const Texture texture = Texture::from_rgba8(ramp, 256, 1, ColorSpace::srgb).value();
    for (int code = 0; code < 256; ++code) {
        const long double c = static_cast<long double>(code) / 255.0L;
        const long double linear = 65535.0L * (c <= 0.04045L ? c / 12.92L : std::pow((c + 0.055L) / 1.055L, 2.4L));
        INFO("code " << code);
        CHECK(static_cast<long double>(texel_value(texture, 0, code, 0, 0)) == std::floor(linear + 0.5L));
        // No value is near a tie, so the rounding does not depend on the last bit of the arithmetic.
        CHECK(std::fabs(static_cast<double>(linear - std::floor(linear)) - 0.5) > 1e-6);
        CHECK(texel_value(texture, 0, code, 0, 3) == code * 257);
    }
}

TEST_CASE("texture: all 256 sRGB codes survive decoding and encoding", "[shading][texture][color]") {
    std::vector<std::uint8_t> ramp;
    for (int code = 0; code < 256; ++code) ramp.insert(ramp.end(), 4, static_cast<std::uint8_t>(code));
    const Texture texture = Texture::from_rgba8(ramp, 256, 1, ColorSpace::srgb).value();
    std::vector<float> color(256), alpha(256);
    for (int code = 0; code < 256; ++code) {
        color[static_cast<std::size_t>(code)] = static_cast<float>(texel_value(texture, 0, code, 0, 0) / 65535.0);
        alpha[static_cast<std::size_t>(code)] = static_cast<float>(texel_value(texture, 0, code, 0, 3) / 65535.0);
    }
    for (const Isa isa : built_isas()) {
        if (!isa_available(isa)) continue;
        std::vector<std::uint32_t> out(256);
        shade_kernels(isa).encode_srgb8(color.data(), color.data(), color.data(), alpha.data(), 1.0f, out.data(), 256);
        for (std::uint32_t code = 0; code < 256; ++code) {
            INFO(isa_name(isa) << ", code " << code);
            CHECK(out[code] == code * 0x01010101u);
        }
    }
}

TEST_CASE("texture: levels by alpha have the colour of what shows, the mean alpha, and one rounding", "[shading][texture]") {
    // A leaf of one green over black that is transparent: every level is that green wherever it is anything.
    std::vector<std::uint8_t> leaf;
    for (int i = 0; i < 64; ++i) {
        const bool inside = (i % 8 - 3) * (i % 8 - 3) + (i / 8 - 3) * (i / 8 - 3) < 9;
        leaf.insert(leaf.end(), {0, static_cast<std::uint8_t>(inside ? 180 : 0), 0, static_cast<std::uint8_t>(inside ? 255 : 0)});
    }
    const Texture green = Texture::from_rgba8(leaf, 8, 8, ColorSpace::srgb, MipRule::alpha).value();
    const Texture equal = Texture::from_rgba8(leaf, 8, 8, ColorSpace::srgb).value();
    const double full = texel_value(green, 0, 3, 3, 1);
    CHECK(texel_value(green, 3, 0, 0, 1) == full);
    CHECK(texel_value(green, 1, 0, 1, 1) == full);
    CHECK(texel_value(equal, 3, 0, 0, 1) < 0.5 * full);
    CHECK(texel_value(green, 3, 0, 0, 3) == texel_value(equal, 3, 0, 0, 3));
    // Noise, with sides that are no powers of two: level by level in long double from level 0.
    std::vector<std::uint16_t> noise;
    std::uint64_t state = 7;
    for (int i = 0; i < 4 * 13 * 22; ++i) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        noise.push_back(static_cast<std::uint16_t>(i % 4 == 3 && state >> 62 == 0 ? 0 : state >> 48));
    }
    const Texture made = Texture::from_rgba16(noise, 13, 22, MipRule::alpha).value();
    std::vector<long double> above;  // colour times alpha, and alpha
    for (std::size_t i = 0; i < noise.size(); i += 4)
        for (std::size_t c = 0; c < 4; ++c) above.push_back(c == 3 ? noise[i + 3] : static_cast<long double>(noise[i + c]) * noise[i + 3]);
    double worst = 0;
    for (std::size_t l = 1; l < made.levels().size(); ++l) {
        const TextureLevel &large = made.levels()[l - 1], &small = made.levels()[l];
        std::vector<long double> mean;
        for (int y = 0; y < small.height; ++y)
            for (int x = 0; x < small.width; ++x)
                for (std::size_t c = 0; c < 4; ++c) {
                    // The share of each texel that lies in the box, by the lengths of the overlaps.
                    const long double w = static_cast<long double>(large.width) / small.width;
                    const long double h = static_cast<long double>(large.height) / small.height;
                    const auto overlap = [](int i, long double from, long double size) {
                        return std::max(0.0L, std::min(i + 1.0L, from + size) - std::max(static_cast<long double>(i), from)) / size;
                    };
                    long double sum = 0;
                    for (int j = 0; j < large.height; ++j)
                        for (int i = 0; i < large.width; ++i)
                            sum +=
                                overlap(i, x * w, w) * overlap(j, y * h, h) * above[4 * static_cast<std::size_t>(j * large.width + i) + c];
                    mean.push_back(sum);
                }
        for (std::size_t i = 0; i < mean.size(); i += 4)
            for (std::size_t c = 0; c < 4; ++c) {
                const int at = static_cast<int>(i / 4);
                const long double want = c == 3 ? mean[i + 3] : mean[i + c] / mean[i + 3];
                worst = std::max(worst, std::fabs(texel_value(made, l, at % small.width, at / small.width, static_cast<int>(c)) -
                                                  static_cast<double>(want)));
            }
        above = std::move(mean);
    }
    CHECK(worst < 0.5001);
}

TEST_CASE("texture: levels of a normal map have what the mean of its normals lost in alpha, and level 0 has nothing",
          "[shading][texture]") {
    std::vector<std::uint8_t> map;
    std::uint64_t state = 3;
    for (int i = 0; i < 32 * 16; ++i) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        const bool flat = i % 32 < 8;
        map.insert(map.end(), {static_cast<std::uint8_t>(flat ? 128 : 96 + (state >> 58)),
                               static_cast<std::uint8_t>(flat ? 128 : 96 + (state >> 40 & 63)), 240, 77});
    }
    const Texture made = Texture::from_rgba8(map, 32, 16, ColorSpace::linear, MipRule::normal).value();
    const Texture equal = Texture::from_rgba8(map, 32, 16, ColorSpace::linear).value();
    CHECK(made.rule() == MipRule::normal);
    CHECK(equal.rule() == MipRule::equal);
    double worst = 0, most = 0;
    for (std::size_t l = 0; l < made.levels().size(); ++l) {
        const TextureLevel& level = made.levels()[l];
        const int wide = 32 / level.width, high = 16 / level.height;
        for (int y = 0; y < level.height; ++y)
            for (int x = 0; x < level.width; ++x) {
                for (int c = 0; c < 3; ++c) CHECK(texel_value(made, l, x, y, c) == texel_value(equal, l, x, y, c));
                long double mean[3] = {};
                for (int j = y * high; j < (y + 1) * high; ++j)
                    for (int i = x * wide; i < (x + 1) * wide; ++i) {
                        long double n[3], length = 0;
                        for (int c = 0; c < 3; ++c) n[c] = 2 * texel_value(made, 0, i, j, c) / 65535.0L - 1, length += n[c] * n[c];
                        for (int c = 0; c < 3; ++c) mean[c] += n[c] / std::sqrt(length) / (wide * high);
                    }
                const long double length = std::sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]);
                const long double lost = l == 0 ? 0.0L : std::sqrt(std::max(0.0L, 2 * (1 - length) / length));
                worst = std::max(worst, std::fabs(texel_value(made, l, x, y, 3) - static_cast<double>(65535 * lost)));
                most = std::max(most, texel_value(made, l, x, y, 3));
            }
    }
    CHECK(worst < 0.51);
    CHECK(most > 10000);
    CHECK(texel_value(made, 2, 0, 0, 3) == 0);  // where the map is flat
}

TEST_CASE("texture: rows beyond the last are ignored, missing ones are as the last one", "[shading][texture]") {
    const auto row = constant_picture(4, 1, 255);
    const std::vector<std::uint16_t> row16(16, 65535);
    TextureBuilder builder = TextureBuilder::make(4, 3).value();
    for (int y = 0; y < 10; ++y) {
        builder.add_row(row.data(), ColorSpace::srgb);
        builder.add_row(row16.data());
    }
    const Texture whole = builder.finish();
    CHECK(std::vector<std::uint16_t>(whole.data().begin(), whole.data().end()) == std::vector<std::uint16_t>(4 * (12 + 2 + 1), 65535));
    builder.add_row(row.data(), ColorSpace::srgb);
    CHECK(builder.finish().data().empty());

    TextureBuilder started = TextureBuilder::make(4, 4).value();
    started.add_row(row16.data());
    const Texture part = started.finish();
    for (int level = 0; level < 3; ++level) CHECK(texel_value(part, static_cast<std::size_t>(level), 0, 0, 2) == 65535);
    CHECK(texel_value(part, 0, 3, 3, 2) == 65535);
    CHECK(texel_value(TextureBuilder::make(4, 4)->finish(), 0, 3, 3, 2) == 0);
}

TEST_CASE("texture: levels that are skipped leave the others as they are, by every rule", "[shading][texture]") {
    for (const MipRule rule : {MipRule::equal, MipRule::alpha, MipRule::normal})
        for (const auto& [width, height] : {std::pair{64, 64}, {37, 21}, {1, 50}, {3, 2}}) {
            std::vector<std::uint16_t> row(static_cast<std::size_t>(4 * width));
            TextureBuilder whole_builder = TextureBuilder::make(width, height, rule).value();
            std::vector<TextureBuilder> builders;
            for (int skip = 0; skip < 9; ++skip) builders.push_back(TextureBuilder::make(width, height, rule, skip).value());
            for (int y = 0; y < height; ++y) {
                for (std::size_t i = 0; i < row.size(); ++i)
                    row[i] = static_cast<std::uint16_t>((i * 7919u + static_cast<unsigned>(y) * 104729u) % 65536u);
                whole_builder.add_row(row.data());
                for (TextureBuilder& builder : builders) builder.add_row(row.data());
            }
            const Texture whole = whole_builder.finish();
            for (std::size_t skip = 0; skip < builders.size(); ++skip) {
                const Texture part = builders[skip].finish();
                const std::size_t first = std::min(skip, whole.levels().size() - 1);
                REQUIRE(part.levels().size() == whole.levels().size() - first);
                CHECK(part.width() == whole.levels()[first].width);
                CHECK(std::equal(part.data().begin(), part.data().end(),
                                 whole.data().end() - static_cast<std::ptrdiff_t>(part.data().size())));
            }
        }
}

TEST_CASE("texture: a level is half the one above, rounded down, to 1 x 1", "[shading][texture]") {
    const Texture texture = Texture::from_rgba8(constant_picture(13, 6, 9), 13, 6, ColorSpace::linear).value();
    const int widths[] = {13, 6, 3, 1}, heights[] = {6, 3, 1, 1};
    REQUIRE(texture.levels().size() == 4);
    int offset = 0;
    for (std::size_t l = 0; l < 4; ++l) {
        CHECK(texture.levels()[l].width == widths[l]);
        CHECK(texture.levels()[l].height == heights[l]);
        CHECK(texture.levels()[l].offset == offset);
        offset += widths[l] * heights[l];
    }
    CHECK(texture.data().size() == static_cast<std::size_t>(4 * offset));
}

TEST_CASE("texture: a constant picture is constant on every level, at any size", "[shading][texture]") {
    for (const auto& [width, height] : {std::pair{1, 1}, {2, 2}, {7, 5}, {31, 1}, {1, 33}, {64, 17}, {127, 129}}) {
        const Texture texture = Texture::from_rgba8(constant_picture(width, height, 201), width, height, ColorSpace::linear).value();
        for (const std::uint16_t value : texture.data())
            if (value != 201 * 257) FAIL(width << " x " << height << ": " << value);
    }
    SUCCEED();
}

TEST_CASE("texture: every level has the picture's mean, at odd sizes too", "[shading][texture]") {
    testing::FloatMaker make(1);
    for (const auto& [width, height] : {std::pair{8, 8}, {7, 5}, {13, 1}, {3, 64}, {101, 57}}) {
        std::vector<std::uint16_t> texels;
        for (int i = 0; i < width * height * 4; ++i) texels.push_back(static_cast<std::uint16_t>(make.below(65536)));
        const Texture texture = Texture::from_rgba16(texels, width, height).value();
        for (int channel = 0; channel < 4; ++channel) {
            double mean = 0;
            for (int i = 0; i < width * height; ++i) mean += texels[static_cast<std::size_t>(4 * i + channel)];
            mean /= width * height;
            for (std::size_t l = 1; l < texture.levels().size(); ++l) {
                const TextureLevel& level = texture.levels()[l];
                double level_mean = 0;
                for (int y = 0; y < level.height; ++y)
                    for (int x = 0; x < level.width; ++x) level_mean += texel_value(texture, l, x, y, channel);
                INFO(width << " x " << height << ", level " << l);
                // Each level's rounding moves the mean by at most half a unit.
                CHECK(level_mean / (level.width * level.height) == Approx(mean).margin(0.5 * static_cast<double>(l)));
            }
        }
    }
}

TEST_CASE("texture: an odd size shrinks by boxes of equal width", "[shading][texture]") {
    // 5 texels to 2: each covers 2.5, so the weights are (2, 2, 1) / 5 and (1, 2, 2) / 5.
    std::vector<std::uint16_t> texels;
    for (const int v : {1000, 2000, 10000, 40000, 60000}) texels.insert(texels.end(), 4, static_cast<std::uint16_t>(v));
    const Texture texture = Texture::from_rgba16(texels, 5, 1).value();
    CHECK(texel_value(texture, 1, 0, 0, 0) == (2 * 1000 + 2 * 2000 + 10000) / 5);
    CHECK(texel_value(texture, 1, 1, 0, 0) == (10000 + 2 * 40000 + 2 * 60000) / 5);
}

TEST_CASE("texture: each texel of a level is the rounded mean of the area it covers", "[shading][texture]") {
    std::uint32_t state = 1;
    for (const auto& [width, height] : {std::pair{16, 8}, {6, 5}, {7, 6}, {1, 8}, {12, 1}, {9, 9}, {10, 20}}) {
        std::vector<std::uint16_t> texels(std::size_t{4} * static_cast<std::size_t>(width * height));
        for (std::uint16_t& v : texels) v = static_cast<std::uint16_t>((state = state * 1664525u + 1013904223u) >> 16);
        const Texture texture = Texture::from_rgba16(texels, width, height).value();
        std::int64_t wrong = 0;
        for (int l = 1; l < static_cast<int>(texture.levels().size()); ++l) {
            const TextureLevel &large = texture.levels()[static_cast<std::size_t>(l - 1)],
                               &small = texture.levels()[static_cast<std::size_t>(l)];
            // Texel i of m covers [i n, (i + 1) n) of n texels of length m.
            const auto overlap = [](int i, int n, int m, int k) {
                return std::uint64_t(std::max(0, std::min((i + 1) * n, (k + 1) * m) - std::max(i * n, k * m)));
            };
            for (int y = 0; y < small.height; ++y)
                for (int x = 0; x < small.width; ++x)
                    for (int c = 0; c < 4; ++c) {
                        std::uint64_t sum = 0;
                        for (int j = 0; j < large.height; ++j)
                            for (int i = 0; i < large.width; ++i)
                                sum += overlap(y, large.height, small.height, j) * overlap(x, large.width, small.width, i) *
                                       static_cast<std::uint64_t>(texel_value(texture, static_cast<std::size_t>(l - 1), i, j, c));
                        const auto total = static_cast<std::uint64_t>(large.width * large.height);
                        wrong += static_cast<std::uint64_t>(texel_value(texture, static_cast<std::size_t>(l), x, y, c)) !=
                                 (2 * sum + total) / (2 * total);
                    }
        }
        INFO(width << " x " << height);
        CHECK(wrong == 0);
    }
}

TEST_CASE("texture: copies share their texels", "[shading][texture]") {
    Texture first = Texture::from_rgba8(constant_picture(4, 4, 9), 4, 4, ColorSpace::linear).value();
    const Texture copy = first;
    CHECK(copy.data().data() == first.data().data());
    const Texture moved = std::move(first);
    CHECK(first.data().empty());  // NOLINT(bugprone-use-after-move): a texture without levels
    CHECK(moved.data()[0] == 9 * 257);
    CHECK(copy.least()[0] == 9 * 257);
}

TEST_CASE("texture: a checkerboard is averaged in linear light", "[shading][texture]") {
    std::vector<std::uint8_t> checker;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) checker.insert(checker.end(), 4, static_cast<std::uint8_t>((x + y) % 2 == 0 ? 255 : 0));
    const Texture texture = Texture::from_rgba8(checker, 4, 4, ColorSpace::srgb).value();
    CHECK(texel_value(texture, 1, 0, 0, 0) == 32768);  // (0 + 65535) / 2, halves rounded up; code 188, not 128
    CHECK(texel_value(texture, 2, 0, 0, 0) == 32768);
}

TEST_CASE("texture: sizes out of range and data of the wrong length are errors", "[shading][texture]") {
    const std::vector<std::uint8_t> data = constant_picture(4, 4, 0);
    CHECK(Texture::from_rgba8(data, 0, 4, ColorSpace::srgb).error().code == ErrorCode::limit);
    CHECK(Texture::from_rgba8(data, 4, -1, ColorSpace::srgb).error().code == ErrorCode::limit);
    CHECK(Texture::from_rgba8(data, kMaxTextureSide + 1, 1, ColorSpace::srgb).error().code == ErrorCode::limit);
    CHECK(Texture::from_rgba8(data, 4, 3, ColorSpace::srgb).error().code == ErrorCode::bad_input);
    CHECK(Texture::from_rgba16({}, 1, 1).error().code == ErrorCode::bad_input);
    CHECK(Texture::from_rgba8(data, 4, 4, ColorSpace::srgb).has_value());
}

TEST_CASE("texture: the longest side has fifteen levels", "[shading][texture]") {
    const Texture texture = Texture::from_rgba8(constant_picture(kMaxTextureSide, 1, 1), kMaxTextureSide, 1, ColorSpace::linear).value();
    CHECK(texture.levels().size() == 15);
    CHECK(texture.levels().size() <= kMaxTextureLevels);
}
