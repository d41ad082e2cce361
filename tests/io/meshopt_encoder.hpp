// An encoder of version 1 of meshoptimizer's vertex codec, by the text of KHR_meshopt_compression. It chooses among all modes at random.
#pragma once

#include "tests/io/gltf_builder.hpp"

#include <array>
#include <bit>
#include <random>

namespace halflit::test {

class Engine {
public:
    explicit Engine(unsigned seed) : engine_(seed) {}
    std::uint32_t operator()() { return static_cast<std::uint32_t>(engine_()); }

private:
    std::mt19937 engine_;
};

/// Appends deltas of one byte position, chosen at random among the ways that hold them. `deltas` has whole groups.
inline void write_deltas(Bytes& out, Engine& random, unsigned control, const std::vector<std::uint8_t>& deltas, std::size_t elements) {
    if (control == 2) return;
    const auto put = [&](unsigned v) { out.push_back(static_cast<std::byte>(v)); };
    if (control == 3) {
        for (std::size_t i = 0; i < elements; ++i) put(deltas[i]);
        return;
    }
    const std::size_t groups = deltas.size() / 16, header = out.size();
    out.resize(header + (groups + 3) / 4);
    for (std::size_t g = 0; g < groups; ++g) {
        const std::uint8_t* d = &deltas[16 * g];
        const bool zero = std::all_of(d, d + 16, [](std::uint8_t v) { return v == 0; });
        unsigned way = random() % 4;
        if (control == 0 && way == 0 && !zero) way = 1 + random() % 3;
        out[header + g / 4] |= static_cast<std::byte>(way << 2 * (g % 4));
        static constexpr unsigned kBits[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
        const unsigned bits = kBits[control][way], sentinel = (1u << bits) - 1;
        if (bits == 0) continue;
        if (bits == 8) {
            for (int i = 0; i < 16; ++i) put(d[i]);
            continue;
        }
        for (unsigned at = 0; at < 16; at += 8 / bits) {
            unsigned packed = 0;
            for (unsigned k = 0; k < 8 / bits; ++k) {
                const unsigned v = std::min<unsigned>(d[at + k], sentinel);
                packed |= bits == 1 ? v << k : v << (8 - bits * (k + 1));
            }
            put(packed);
        }
        for (int i = 0; i < 16; ++i)
            if (d[i] >= sentinel) put(d[i]);
    }
}

/// An encoder of version 1 of the vertex codec by the text of its specification, which chooses among all modes at random.
inline Bytes encode_vertices_1(const Bytes& data, std::size_t stride, Engine& random) {
    const std::size_t channels = stride / 4, count = data.size() / stride;
    std::vector<unsigned> modes(channels);
    for (unsigned& mode : modes) mode = random() % 3 == 2 ? 2 + 16 * (random() % 16) : random() % 2;
    const auto u32 = [&](std::size_t element, std::size_t channel) {
        std::uint32_t v;
        std::memcpy(&v, &data[element * stride + 4 * channel], 4);
        return v;
    };
    Bytes out = {std::byte{0xa1}};
    const std::size_t block = std::min<std::size_t>(8192 / stride / 16 * 16, 256);
    for (std::size_t first = 0; first < count; first += block) {
        const std::size_t elements = std::min(block, count - first), header = out.size();
        out.resize(header + channels);
        for (std::size_t c = 0; c < channels; ++c) {
            std::vector<std::vector<std::uint8_t>> deltas(4, std::vector<std::uint8_t>((elements + 15) / 16 * 16));
            for (std::size_t i = 0; i < elements; ++i) {
                const std::uint32_t now = u32(first + i, c), before = first + i == 0 ? u32(0, c) : u32(first + i - 1, c);
                std::uint32_t delta = 0;
                if ((modes[c] & 15u) == 2) {
                    delta = std::rotl(now ^ before, static_cast<int>(modes[c] >> 4));
                } else {
                    const int bits = modes[c] == 0 ? 8 : 16;
                    for (int shift = 0; shift < 32; shift += bits) {
                        const std::uint32_t mask = (1u << bits) - 1, d = ((now >> shift) - (before >> shift)) & mask;
                        delta |= ((d >> (bits - 1) != 0 ? ~(d << 1) : d << 1) & mask) << shift;
                    }
                }
                for (std::size_t b = 0; b < 4; ++b) deltas[b][i] = static_cast<std::uint8_t>(delta >> 8 * b);
            }
            for (std::size_t b = 0; b < 4; ++b) {
                const bool zero = std::all_of(deltas[b].begin(), deltas[b].end(), [](std::uint8_t v) { return v == 0; });
                const unsigned control = zero && random() % 2 == 0 ? 2u : static_cast<unsigned>(std::array{0, 1, 3}[random() % 3]);
                out[header + c] |= static_cast<std::byte>(control << 2 * b);
                write_deltas(out, random, control, deltas[b], elements);
            }
        }
    }
    const std::size_t tail = stride + channels;
    out.resize(out.size() + (tail < 24 ? 24 - tail : 0));
    out.insert(out.end(), data.begin(), data.begin() + static_cast<std::ptrdiff_t>(stride));
    for (const unsigned mode : modes) out.push_back(static_cast<std::byte>(mode));
    return out;
}

}  // namespace halflit::test
