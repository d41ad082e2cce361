// Data that deflate has packed.
#pragma once

#include <libdeflate.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>

namespace halflit::io::detail {

struct FreeDecompressor {
    void operator()(libdeflate_decompressor* decompressor) const { libdeflate_free_decompressor(decompressor); }
};
using Decompressor = std::unique_ptr<libdeflate_decompressor, FreeDecompressor>;

/// Throws std::bad_alloc.
[[nodiscard]] inline Decompressor make_decompressor() {
    Decompressor made(libdeflate_alloc_decompressor());
    if (!made) throw std::bad_alloc();
    return made;
}

/// Unpacks a zlib stream that fills `to`. False: it is damaged, or of another length.
[[nodiscard]] inline bool unpack_zlib(std::span<const std::byte> from, std::span<std::uint8_t> to) {
    return libdeflate_zlib_decompress(make_decompressor().get(), from.data(), from.size(), to.data(), to.size(), nullptr) ==
           LIBDEFLATE_SUCCESS;
}

/// Unpacks a gzip file (RFC 1952) of one member, whose size at its end is that of `to`. False: it is damaged, or of another length.
[[nodiscard]] inline bool unpack_gzip(std::span<const std::byte> from, std::span<std::byte> to) {
    constexpr std::size_t kHeader = 10, kEnd = 8;
    constexpr unsigned kHeaderSum = 2, kExtra = 4, kName = 8, kComment = 16;
    const auto at = [&](std::size_t i) { return std::to_integer<unsigned>(from[i]); };
    if (from.size() < kHeader + kEnd || at(0) != 0x1F || at(1) != 0x8B || at(2) != 8) return false;
    const unsigned flags = at(3);
    const std::size_t end = from.size() - kEnd;
    std::size_t begin = kHeader;
    if ((flags & kExtra) != 0) begin += begin + 2 <= end ? 2 + (at(begin) | at(begin + 1) << 8) : end;
    for (const unsigned text : {kName, kComment}) {
        if ((flags & text) == 0) continue;
        while (begin < end && at(begin) != 0) ++begin;
        ++begin;
    }
    if ((flags & kHeaderSum) != 0) begin += 2;
    if (begin >= end || to.empty()) return false;
    const unsigned sum = at(end) | at(end + 1) << 8 | at(end + 2) << 16 | at(end + 3) << 24;
    return libdeflate_deflate_decompress(make_decompressor().get(), from.data() + begin, end - begin, to.data(), to.size(), nullptr) ==
               LIBDEFLATE_SUCCESS &&
           libdeflate_crc32(0, to.data(), to.size()) == sum;
}

}  // namespace halflit::io::detail
