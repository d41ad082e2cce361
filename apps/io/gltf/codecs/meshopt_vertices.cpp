#include "apps/io/gltf/codecs/meshopt_vertices.hpp"

#include "apps/io/files/little_endian.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace halflit::io::detail {

namespace {

constexpr std::size_t kGroup = 16;            // elements
constexpr std::size_t kMaxElements = 256;     // of a block
constexpr std::size_t kMaxBlockBytes = 8192;  // of a block, decoded
constexpr std::size_t kLeastTail = 24;        // bytes

enum Control : unsigned { kShort = 0, kLong = 1, kZeros = 2, kLiteral = 3 };
enum Channel : unsigned { kBytes = 0, kWords = 1, kXor = 2 };

/// Reads the data from the front; a read past the end gives false, and nothing.
struct Input {
    std::span<const std::byte> rest;

    bool take(std::size_t size, std::span<const std::byte>& out) {
        if (rest.size() < size) return false;
        out = rest.first(size);
        rest = rest.subspan(size);
        return true;
    }
};

/// 16 deltas of 1, 2 or 4 bits. One with all bits set stands for a whole byte, which follows the group.
bool read_packed(Input& in, unsigned bits, std::uint8_t* out) {
    std::span<const std::byte> packed, whole;
    if (!in.take(kGroup * bits / 8, packed)) return false;
    const unsigned each = 8 / bits, mask = (1u << bits) - 1;
    for (unsigned i = 0; i < kGroup; ++i) {
        const unsigned place = bits == 1 ? i % 8 : (each - 1 - i % each) * bits;  // single bits begin at the lowest
        const unsigned value = byte_at(packed, i / each) >> place & mask;
        if (value == mask && !in.take(1, whole)) return false;
        out[i] = static_cast<std::uint8_t>(value == mask ? byte_at(whole, 0) : value);
    }
    return true;
}

/// Deltas of one byte position: those of a block's elements, in groups. `out` has room for whole groups.
bool read_deltas(Input& in, unsigned control, std::size_t elements, std::uint8_t* out) {
    const std::size_t groups = (elements + kGroup - 1) / kGroup;
    std::fill_n(out, groups * kGroup, std::uint8_t{0});
    if (control == kZeros) return true;
    std::span<const std::byte> bytes;
    if (control == kLiteral) {
        if (!in.take(elements, bytes)) return false;
        for (std::size_t i = 0; i < elements; ++i) out[i] = std::to_integer<std::uint8_t>(bytes[i]);
        return true;
    }
    std::span<const std::byte> header;
    if (!in.take((groups + 3) / 4, header)) return false;
    for (std::size_t g = 0; g < groups; ++g) {
        // Short: 0, 1, 2 or 4 bits a delta; long: 1, 2, 4 or 8.
        const unsigned size = (byte_at(header, g / 4) >> 2 * (g % 4) & 3u) + (control == kLong ? 1 : 0);
        std::uint8_t* const group = out + g * kGroup;
        if (size == 0) continue;
        if (size < 4) {
            if (!read_packed(in, 1u << (size - 1), group)) return false;
            continue;
        }
        if (!in.take(kGroup, bytes)) return false;
        for (std::size_t i = 0; i < kGroup; ++i) group[i] = std::to_integer<std::uint8_t>(bytes[i]);
    }
    return true;
}

std::uint32_t unzigzag(std::uint32_t v) { return (v & 1u) != 0 ? ~(v >> 1) : v >> 1; }

/// Four bytes of an element from those of the element before and their deltas, as little-endian integers.
std::uint32_t next_channel(std::uint32_t before, std::uint32_t delta, unsigned mode) {
    std::uint32_t out = 0;
    switch (mode & 15u) {
        case kBytes:
            for (int shift = 0; shift < 32; shift += 8) out |= (((before >> shift) + unzigzag(delta >> shift & 255u)) & 255u) << shift;
            return out;
        case kWords:
            for (int shift = 0; shift < 32; shift += 16) out |= (((before >> shift) + unzigzag(delta >> shift & 65535u)) & 65535u) << shift;
            return out;
        default:
            return before ^ std::rotr(delta, static_cast<int>(mode >> 4));
    }
}

}  // namespace

bool decode_vertices_1(std::span<const std::byte> from, std::span<std::byte> to, std::size_t stride) {
    const std::size_t channels = stride / 4, tail = stride + channels, padded = std::max(tail, kLeastTail);
    if (from.size() < 1 + padded || from.front() != kVertexCodec1) return false;
    const std::span<const std::byte> baseline = from.last(tail).first(stride), modes = from.last(channels);
    for (std::size_t c = 0; c < channels; ++c)
        if (const unsigned mode = byte_at(modes, c); (mode & 15u) > kXor || ((mode & 15u) != kXor && mode > kWords)) return false;

    std::vector<std::uint32_t> before(channels);
    for (std::size_t c = 0; c < channels; ++c) before[c] = u32_at(baseline, 4 * c);
    Input in{from.subspan(1, from.size() - 1 - padded)};
    const std::size_t block = std::min(kMaxBlockBytes / stride & ~(kGroup - 1), kMaxElements);
    std::array<std::array<std::uint8_t, kMaxElements>, 4> deltas;
    for (std::size_t first = 0, count = to.size() / stride; first < count; first += block) {
        const std::size_t elements = std::min(block, count - first);
        std::span<const std::byte> controls;
        if (!in.take(channels, controls)) return false;
        for (std::size_t c = 0; c < channels; ++c) {
            const unsigned mode = byte_at(modes, c);
            for (std::size_t b = 0; b < 4; ++b)
                if (!read_deltas(in, byte_at(controls, c) >> 2 * b & 3u, elements, deltas[b].data())) return false;
            for (std::size_t i = 0; i < elements; ++i) {
                std::uint32_t delta = 0;
                for (std::size_t b = 0; b < 4; ++b) delta |= std::uint32_t{deltas[b][i]} << 8 * b;
                before[c] = next_channel(before[c], delta, mode);
                for (std::size_t b = 0; b < 4; ++b)
                    to[(first + i) * stride + 4 * c + b] = static_cast<std::byte>(before[c] >> 8 * b & 255u);
            }
        }
    }
    return in.rest.empty();
}

}  // namespace halflit::io::detail
