// UASTC LDR 4x4: blocks of 16 bytes in 19 modes. Pixels are those of Basis Universal's decoder to RGBA at 8 bits, which expands end points
// by repeated bits for sRGB textures too.
#include "apps/io/pictures/ktx2/bit_reader.hpp"
#include "apps/io/pictures/ktx2/blocks.hpp"

#include <bit>
#include <iterator>

namespace halflit::io::detail {
namespace {

/// Values of end points: `bits` bits, beside a trit or a quint where base is 3 or 5. `scale`, `factor` and `shift` are the numbers by which
/// ASTC makes a byte of both.
struct Range {
    std::uint32_t base, scale, factor, shift;
    int bits;
};
constexpr Range kBits4{1, 0, 0, 0, 4}, kBits5{1, 0, 0, 0, 5}, kBits8{1, 0, 0, 0, 8}, kTrit2{3, 93, 278, 2, 2}, kTrit4{3, 22, 65, 3, 4},
    kTrit6{3, 5, 16, 4, 6}, kQuint3{5, 26, 130, 1, 3}, kQuint5{5, 6, 32, 3, 5};

struct Mode {
    int code, code_bits;
    int hint_bits;                 ///< for other formats, between the code and what follows
    int pattern_bits, plane_bits;  ///< of the pattern of subsets, of the channel that has weights of its own
    int subsets, channels;         ///< 2 channels: luminance and alpha
    bool has_two_planes;
    Range range;
    int weight_bits;
};
constexpr int kSolid = 8;
constexpr Mode kModes[] = {
    {0x01, 4, 15, 0, 0, 1, 3, false, kTrit6, 4}, {0x35, 6, 15, 0, 0, 1, 3, false, kBits8, 2},  {0x1D, 5, 15, 5, 0, 2, 3, false, kBits4, 3},
    {0x03, 5, 15, 4, 0, 3, 3, false, kTrit2, 2}, {0x13, 5, 15, 5, 0, 2, 3, false, kQuint3, 2}, {0x0B, 5, 15, 0, 0, 1, 3, false, kBits8, 3},
    {0x1B, 5, 15, 0, 2, 1, 3, true, kQuint5, 2}, {0x07, 5, 15, 5, 0, 2, 3, false, kQuint3, 2}, {0x17, 5, 0, 0, 0, 1, 4, false, kBits8, 0},
    {0x0F, 5, 23, 5, 0, 2, 4, false, kBits4, 2}, {0x02, 3, 17, 0, 0, 1, 4, false, kTrit4, 4},  {0x00, 2, 17, 0, 2, 1, 4, true, kTrit4, 2},
    {0x06, 3, 17, 0, 0, 1, 4, false, kTrit6, 3}, {0x1F, 5, 23, 0, 2, 1, 4, true, kBits8, 1},   {0x0D, 5, 23, 0, 0, 1, 4, false, kBits8, 2},
    {0x05, 7, 23, 0, 0, 1, 2, false, kBits8, 4}, {0x15, 6, 23, 5, 0, 2, 2, false, kBits8, 2},  {0x25, 6, 23, 0, 0, 1, 2, true, kBits8, 2},
    {0x09, 4, 15, 0, 0, 1, 3, false, kBits5, 5},
};
constexpr std::size_t kModeCount = std::size(kModes);
constexpr int kMostCodeBits = 7;

/// The mode that a block's first bits mean; kModeCount: none.
constexpr auto kModeOf = [] {
    std::array<std::uint8_t, 1 << kMostCodeBits> modes{};
    modes.fill(kModeCount);
    for (std::size_t i = 0; i < kModeCount; ++i)
        for (std::size_t bits = static_cast<std::size_t>(kModes[i].code); bits < modes.size();
             bits += std::size_t{1} << kModes[i].code_bits)
            modes[bits] = static_cast<std::uint8_t>(i);
    return modes;
}();

// Patterns of subsets: a bit, or two, a pixel. Mode 7 has other ones than the rest of those of two subsets.
constexpr std::uint16_t kTwoSubsets[] = {0xCCCC, 0x8888, 0x1111, 0xECC8, 0x377F, 0xFEEC, 0x0137, 0x137F, 0xC800, 0x0013,
                                         0xFE80, 0x17FF, 0x0017, 0x00FF, 0xFFF0, 0x0FFF, 0xFF71, 0x8EFF, 0x08CE, 0x008C,
                                         0x7310, 0xCEFF, 0x7331, 0x088C, 0xCEEF, 0x6666, 0xF00F, 0x5555, 0x0F0F, 0x36C9};
constexpr std::uint16_t kTwoSubsetsOfMode7[] = {0x00F0, 0x4444, 0x0133, 0xCC80, 0xF0FF, 0x2222, 0xFFC8, 0xCCCE, 0x3C03, 0x00EE,
                                                0x7700, 0x3003, 0x00CE, 0xFF80, 0x6FFF, 0x1333, 0x11FF, 0x136C, 0x00EF};
constexpr std::uint32_t kThreeSubsets[] = {0xA5A50000, 0xAA005555, 0xAA000055, 0x0000AA55, 0x25252525, 0x94949494,
                                           0x58585858, 0x56560202, 0x92929292, 0x55AA0055, 0xA05050A0};

constexpr std::size_t kPixels = std::tuple_size_v<Block>;
using Subsets = std::array<std::uint8_t, kPixels>;

/// False: there is no such pattern.
bool find_subsets(std::size_t mode, std::uint32_t pattern, Subsets& subsets) {
    const bool is_three = kModes[mode].subsets == 3;
    const std::span<const std::uint16_t> two = mode == 7 ? std::span<const std::uint16_t>(kTwoSubsetsOfMode7) : kTwoSubsets;
    if (pattern >= (is_three ? std::size(kThreeSubsets) : two.size())) return false;
    for (std::size_t i = 0; i < kPixels; ++i)
        subsets[i] = static_cast<std::uint8_t>(is_three ? kThreeSubsets[pattern] >> (2 * i) & 3 : two[pattern] >> i & 1u);
    return true;
}

/// A byte of a value of the range: `bits` and the trit or quint `high`.
std::uint32_t expand(const Range& range, std::uint32_t bits, std::uint32_t high) {
    if (range.base == 1) {  // repeats the bits
        const std::uint32_t byte = bits << (8 - range.bits);
        return byte | byte >> range.bits;
    }
    const std::uint32_t low = bits >> 1, flip = (bits & 1) != 0 ? 0x1FFu : 0;
    const std::uint32_t value = (high * range.scale + (low * range.factor | low >> range.shift)) ^ flip;
    return (flip & 0x80) | value >> 2;
}

constexpr std::size_t kMostValues = 18;  // mode 3: two end points of three channels for each of three subsets

/// Reads the bytes of end points: of each subset, low and high of each channel in turn.
std::array<std::uint32_t, kMostValues> read_end_points(BitReader& block, const Range& range, std::size_t count) {
    std::array<std::uint32_t, kMostValues> high{}, values{};
    const std::size_t packed = range.base == 3 ? 5 : 3;  // trits of 8 bits, quints of 7
    for (std::size_t at = 0; range.base > 1 && at < count; at += packed) {
        const std::size_t here = std::min(packed, count - at);
        std::uint32_t combinations = 1;
        for (std::size_t i = 0; i < here; ++i) combinations *= range.base;
        std::uint32_t pack = block.get(std::bit_width(combinations - 1));
        for (std::size_t i = 0; i < here; ++i, pack /= range.base) high[at + i] = pack % range.base;
    }
    for (std::size_t i = 0; i < count; ++i) values[i] = expand(range, block.get(range.bits), high[i]);
    return values;
}

/// A weight as a share of 64.
std::uint32_t expand_weight(std::uint32_t weight, int bits) {
    std::uint32_t of_63 = 0;
    for (int shift = 6 - bits; shift > -bits; shift -= bits) of_63 |= shift >= 0 ? weight << shift : weight >> -shift;
    return of_63 > 32 ? of_63 + 1 : of_63;
}

}  // namespace

Block decode_uastc(std::span<const std::byte, kUastcBytes> bytes) {
    Block pixels;
    pixels.fill({255, 0, 255, 255});
    BitReader block(bytes);
    const std::size_t index = kModeOf[byte_at(bytes, 0) & ((1 << kMostCodeBits) - 1)];
    if (index == kModeCount) return pixels;
    const Mode& mode = kModes[index];
    block.get(mode.code_bits);
    if (index == kSolid) {
        Rgba8 color;
        for (std::uint8_t& channel : color) channel = static_cast<std::uint8_t>(block.get(8));
        pixels.fill(color);
        return pixels;
    }
    block.get(mode.hint_bits);
    Subsets subsets{};
    if (const std::uint32_t pattern = block.get(mode.pattern_bits); mode.subsets > 1 && !find_subsets(index, pattern, subsets))
        return pixels;
    const std::uint32_t chosen = block.get(mode.plane_bits);
    const std::size_t apart = !mode.has_two_planes ? 4 : mode.channels == 2 ? 3 : chosen;  // the channel of the second plane

    const auto channels = static_cast<std::size_t>(mode.channels);
    const auto values = read_end_points(block, mode.range, 2 * channels * static_cast<std::size_t>(mode.subsets));
    // The first pixel of each subset has a bit less: its highest one is 0.
    std::uint32_t begun = 0;
    for (std::size_t i = 0; i < kPixels; ++i) {
        const bool is_first = (begun >> subsets[i] & 1) == 0;
        begun |= 1u << subsets[i];
        std::uint32_t weights[2];
        for (int plane = 0; plane <= (mode.has_two_planes ? 1 : 0); ++plane)
            weights[plane] = expand_weight(block.get(mode.weight_bits - (is_first ? 1 : 0)), mode.weight_bits);
        for (std::size_t c = 0; c < 4; ++c) {
            const std::size_t of = channels == 2 ? c / 3 : c;
            if (of >= channels) {
                pixels[i][c] = 255;
                continue;
            }
            const std::size_t at = 2 * (channels * subsets[i] + of);
            const std::uint32_t weight = weights[c == apart ? 1 : 0], low = values[at] * 257, high = values[at + 1] * 257;
            pixels[i][c] = static_cast<std::uint8_t>((low * (64 - weight) + high * weight + 32) >> 14);
        }
    }
    return pixels;
}

}  // namespace halflit::io::detail
