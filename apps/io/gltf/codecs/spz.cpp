// SPZ: columns of small numbers. Versions 1 to 3 are one gzip stream, or plain; of version 4, Zstandard packs each column by itself.
#include "apps/io/gltf/codecs/spz.hpp"

#include "apps/io/files/deflate.hpp"
#include "apps/io/files/little_endian.hpp"
#include "apps/io/files/load_failure.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#if HALFLIT_HAS_KTX2
#include <zstd.h>
#endif

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace halflit::io::detail {
namespace {

using Bytes = std::span<const std::byte>;
enum Column : std::size_t { kPositions, kAlphas, kColors, kScales, kRotations, kHarmonics, kColumns };
constexpr std::size_t kHeader = 16, kHeader4 = 32, kEntry = 16;

[[noreturn]] void fail_cut_off() { refuse("", "its Gaussians are cut off, or damaged"); }

/// A number of half precision.
double half_of(std::uint32_t bits) {
    const std::uint32_t exponent = bits >> 10 & 31u, fraction = bits & 1023u;
    const double size = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, static_cast<int>(exponent) - 25);
    return (bits & 0x8000u) != 0 ? -size : size;
}

/// False: the bytes are damaged, or more or fewer.
bool unpack_zstd([[maybe_unused]] Bytes from, [[maybe_unused]] std::span<std::byte> to) {
#if HALFLIT_HAS_KTX2
    return ZSTD_decompress(to.data(), to.size(), from.data(), from.size()) == to.size();
#else
    refuse("", "SPZ 4 needs the library libzstd, which this build lacks");
#endif
}

/// The columns, each of `bytes_of_one` for each of `count` splats, and what else a file holds. Throws LoadFailure.
struct Columns {
    std::array<Bytes, kColumns> of{};
    Bytes extensions;

    Columns(Bytes file, std::uint64_t count, const std::array<std::uint64_t, kColumns>& bytes_of_one) {
        std::uint64_t at = kHeader;
        for (std::size_t c = 0; c < kColumns; at += of[c++].size()) {
            if (count * bytes_of_one[c] > file.size() - at) fail_cut_off();
            of[c] = file.subspan(at, count * bytes_of_one[c]);
        }
        extensions = file.subspan(at);
    }
    /// Version 4. Colours that change with the view may be cut off: then their column is empty.
    Columns(Bytes file, std::uint64_t count, const std::array<std::uint64_t, kColumns>& bytes_of_one, Document& document) {
        constexpr std::uint64_t kMostByZstd = 32768;  // bytes of one
        const std::uint64_t table = file.size() < kHeader4 ? 0 : u32_at(file, 16), streams = byte_at(file, 15);
        std::uint64_t at = table + kEntry * streams;
        if (table < kHeader4 || at > file.size()) fail_cut_off();
        extensions = file.subspan(kHeader4, table - kHeader4);
        for (std::size_t c = 0, stream = 0; c < kColumns; ++c) {
            const std::uint64_t size = count * bytes_of_one[c];
            if (size == 0) continue;
            if (stream == streams) fail_cut_off();
            const std::uint64_t entry = table + kEntry * stream++, packed = u64_at(file, entry);
            const bool is_there = packed <= file.size() - at;
            if (!is_there && c == kHarmonics) return;
            if (!is_there || u64_at(file, entry + 8) != size || size / kMostByZstd > packed) fail_cut_off();
            document.geometry.take(size);
            check_time();
            unpacked_[c].resize(size);
            if (!unpack_zstd(file.subspan(at, packed), unpacked_[c])) fail_cut_off();
            of[c] = unpacked_[c];
            at += packed;
        }
    }

private:
    std::array<std::vector<std::byte>, kColumns> unpacked_;
};

/// The axes that an extension names.
std::uint32_t axes_of(Bytes extensions, Document& document) {
    constexpr std::uint32_t kAxes = 0xADBE0003;
    for (std::size_t at = 0; extensions.size() - at >= 12;) {
        const std::uint32_t size = u32_at(extensions, at + 4), axes = u32_at(extensions, at + 8);
        if (size > extensions.size() - at - 8) break;
        if (u32_at(extensions, at) == kAxes && size >= 4) {
            if (axes >= 1 && axes <= kMostAxes) return axes;
            document.warn(fmt::format("its axes have the number {}, expected 1 to {}; y points up", axes, kMostAxes));
        }
        at += 8 + std::size_t{size};
    }
    return kRightUpBack;
}

}  // namespace

std::optional<SplatCloud> read_spz(Bytes file, Document& document) {
    constexpr std::uint32_t kMark = 0x5053474e;  // NGSP
    std::vector<std::byte> unpacked;
    const bool is_gzip = file.size() > 18 && u16_at(file, 0) == 0x8B1F;
    if (is_gzip) {
        // The size stands at the end, modulo 2^32. Deflate packs at most 1032 bytes into one.
        const std::uint64_t size = u32_at(file, file.size() - 4);
        if (size / 1032 > file.size()) return std::nullopt;
        document.geometry.take(size);
        unpacked.resize(size);
        if (!unpack_gzip(file, unpacked)) return std::nullopt;
        file = unpacked;
    }
    if (file.size() < kHeader || u32_at(file, 0) != kMark) return std::nullopt;
    const std::uint32_t version = u32_at(file, 4), flags = byte_at(file, 14);
    if (version < 1 || version > 4) refuse("", fmt::format("is SPZ of version {}, expected 1 to 4", version));
    const std::uint64_t count = u32_at(file, 8);
    int degree = static_cast<int>(byte_at(file, 12));
    const int fraction = static_cast<int>(byte_at(file, 13));
    if (degree > 4) refuse("", fmt::format("degree {} of the spherical harmonics, expected 0 to 4", degree));
    const std::array<std::uint64_t, kColumns> bytes_of_one{version == 1 ? 6u : 9u,    1u, 3u, 3u, version < 3 ? 3u : 4u,
                                                           3 * rest_of_degree(degree)};
    const Columns columns = version == 4 && !is_gzip ? Columns(file, count, bytes_of_one, document) : Columns(file, count, bytes_of_one);
    if (columns.of[kHarmonics].empty() && degree > 0 && count > 0) {
        document.go_on_without({{ErrorCode::bad_input, "it was cut off"}}, "drawn without colours that change with the view");
        degree = 0;
    }
    const std::size_t rest = 3 * rest_of_degree(degree);
    const auto code = [&](Column column, std::size_t at) { return byte_at(columns.of[column], at); };
    SplatCloud cloud;
    cloud.reserve(document, count, degree);
    if ((flags & 1u) != 0) cloud.splats.reference = SplatReference::inria_aa;
    if ((flags & 2u) != 0) cloud.axes = axes_of(columns.extensions, document);
    for (std::size_t i = 0; i < count; ++i) {
        if (i % 4096 == 0) check_time();
        std::array<double, 3> position{}, others{}, scale{};
        const std::uint32_t packed = version < 3 ? 0u : u32_at(columns.of[kRotations], 4 * i);
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t at = 3 * i + c;
            if (version == 1) {
                position[c] = half_of(u16_at(columns.of[kPositions], 2 * at));
            } else {
                const std::uint32_t bits = u16_at(columns.of[kPositions], 3 * at) << 8 | code(kPositions, 3 * at + 2) << 24;
                position[c] = std::ldexp(static_cast<std::int32_t>(bits) >> 8, -fraction);
            }
            const std::uint32_t one = packed >> (20 - 10 * c);
            const double size = 0.70710678118654752 * (one & 511u) / 511.0;
            others[c] = version < 3 ? code(kRotations, at) / 127.5 - 1.0 : (one >> 9 & 1u) != 0 ? -size : size;
            scale[c] = scale_of_log(code(kScales, at) / 16.0 - 10.0);
        }
        cloud.add(position, rotation_of(others, version < 3 ? 3 : packed >> 30, false), scale, code(kAlphas, i) / 255.0);
        for (std::size_t c = 0; c < 3; ++c) cloud.add_color((code(kColors, 3 * i + c) / 255.0 - 0.5) / 0.15);
        for (std::size_t k = 0; k < rest; ++k) cloud.add_color((code(kHarmonics, rest * i + k) - 128.0) / 128.0);
    }
    return cloud;
}

}  // namespace halflit::io::detail
