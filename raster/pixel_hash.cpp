// XXH64 by Yann Collet, from its published description, seed 0. Bytes are read in little-endian order on every machine.
#include "halflit/target.hpp"

#include <bit>

namespace halflit {

namespace {

constexpr std::uint64_t kPrime1 = 0x9E3779B185EBCA87u;
constexpr std::uint64_t kPrime2 = 0xC2B2AE3D27D4EB4Fu;
constexpr std::uint64_t kPrime3 = 0x165667B19E3779F9u;
constexpr std::uint64_t kPrime4 = 0x85EBCA77C2B2AE63u;
constexpr std::uint64_t kPrime5 = 0x27D4EB2F165667C5u;

/// Little-endian number of kBytes bytes; compilers make one load of it.
template <int kBytes>
std::uint64_t read(const std::uint8_t* p) {
    std::uint64_t value = 0;
    for (int i = 0; i < kBytes; ++i) value |= static_cast<std::uint64_t>(p[i]) << (8 * i);
    return value;
}

std::uint64_t mix(std::uint64_t lane, std::uint64_t input) { return std::rotl(lane + input * kPrime2, 31) * kPrime1; }

std::uint64_t merge(std::uint64_t hash, std::uint64_t lane) { return (hash ^ mix(0, lane)) * kPrime1 + kPrime4; }

}  // namespace

std::uint64_t pixel_hash(std::span<const std::uint8_t> bytes) {
    const std::uint8_t* p = bytes.data();
    std::size_t left = bytes.size();
    std::uint64_t hash = kPrime5;

    if (left >= 32) {
        std::uint64_t lane[4] = {kPrime1 + kPrime2, kPrime2, 0, 0 - kPrime1};
        for (; left >= 32; left -= 32, p += 32)
            for (int i = 0; i < 4; ++i) lane[i] = mix(lane[i], read<8>(p + 8 * i));
        hash = std::rotl(lane[0], 1) + std::rotl(lane[1], 7) + std::rotl(lane[2], 12) + std::rotl(lane[3], 18);
        for (const std::uint64_t value : lane) hash = merge(hash, value);
    }
    hash += bytes.size();

    for (; left >= 8; left -= 8, p += 8) hash = std::rotl(hash ^ mix(0, read<8>(p)), 27) * kPrime1 + kPrime4;
    if (left >= 4) {
        hash = std::rotl(hash ^ (read<4>(p) * kPrime1), 23) * kPrime2 + kPrime3;
        left -= 4;
        p += 4;
    }
    for (; left > 0; --left, ++p) hash = std::rotl(hash ^ (*p * kPrime5), 11) * kPrime1;

    hash = (hash ^ (hash >> 33)) * kPrime2;
    hash = (hash ^ (hash >> 29)) * kPrime3;
    return hash ^ (hash >> 32);
}

}  // namespace halflit
