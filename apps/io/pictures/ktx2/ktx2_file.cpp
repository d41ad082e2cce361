// KTX2 textures, by the KTX specification 2.0: the largest level of the first layer and face, of plain 8-bit channels or of Basis Universal
// (ETC1S, UASTC LDR), as they are or compressed by BasisLZ, Zstandard or zlib. A build without libzstd reads none, so that what it reads
// does not depend on how a texture was compressed.
#include "apps/io/files/optional_libraries.hpp"
#include "apps/io/pictures/image_decoders.hpp"

#include <fmt/format.h>

#if HALFLIT_HAS_KTX2
#include "apps/io/files/deflate.hpp"
#include "apps/io/files/little_endian.hpp"
#include "apps/io/pictures/ktx2/blocks.hpp"
#include "sh/time_limit.hpp"

#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <new>
#include <optional>
#include <string_view>
#endif

namespace halflit::io {

bool has_ktx2() { return HALFLIT_HAS_KTX2 != 0; }

namespace detail {

#if HALFLIT_HAS_KTX2

namespace {

template <class... Args>
tl::unexpected<Error> damaged(fmt::format_string<Args...> what, Args&&... args) {
    return fail(ErrorCode::bad_input, "KTX2: " + fmt::format(what, std::forward<Args>(args)...));
}

enum class Scheme : std::uint32_t { none, basis_lz, zstd, zlib };
constexpr std::uint32_t kEtc1sModel = 163, kUastcModel = 166;  ///< of the data format descriptor

/// A plain format of Vulkan: the numbers of its forms UNORM and SRGB.
struct Plain {
    std::uint32_t unorm, srgb;
    std::size_t channels;
    bool is_bgr;
};
constexpr Plain kPlains[] = {{9, 15, 1, false}, {16, 22, 2, false}, {23, 29, 3, false},
                             {30, 36, 3, true}, {37, 43, 4, false}, {44, 50, 4, true}};

struct Ktx2 {
    std::size_t width = 0, height = 0;
    std::uint32_t model = 0;  ///< kEtc1sModel or kUastcModel, if not plain
    std::optional<Plain> plain;
    Scheme scheme = Scheme::none;
    std::uint64_t unpacked = 0;  ///< bytes of the level without compression, as the file says
    std::span<const std::byte> level, globals;
    std::array<std::uint8_t, 4> channels{0, 1, 2, 3};  ///< of a plain picture: which one each of RGBA is; 4 is 0, and 5 is 1
};

/// As much of a part as the file has.
std::span<const std::byte> part(std::span<const std::byte> file, std::uint64_t at, std::uint64_t size) {
    const auto rest = file.subspan(static_cast<std::size_t>(std::min<std::uint64_t>(at, file.size())));
    return rest.first(static_cast<std::size_t>(std::min<std::uint64_t>(size, rest.size())));
}

/// Which channels a plain picture is to be seen with, by its key KTXswizzle. Viewers do not ask that of Basis textures.
void read_swizzle(std::span<const std::byte> pairs, Ktx2& ktx) {
    constexpr std::string_view kKey("KTXswizzle", 11), kLetters = "rgba01";  // the key ends with a 0
    while (pairs.size() > 4) {
        const std::size_t size = u32_at(pairs, 0);
        const auto pair = part(pairs, 4, size);
        if (pair.size() >= kKey.size() + 4 && std::memcmp(pair.data(), kKey.data(), kKey.size()) == 0) {
            for (std::size_t c = 0; c < 4; ++c)
                if (const std::size_t found = kLetters.find(static_cast<char>(pair[kKey.size() + c])); found != std::string_view::npos)
                    ktx.channels[c] = static_cast<std::uint8_t>(found);
            return;
        }
        pairs = part(pairs, 4 + (std::uint64_t{size} + 3) / 4 * 4, pairs.size());
    }
}

Result<Ktx2> read_ktx2(std::span<const std::byte> file, const ImageLimits& limits) {
    constexpr std::size_t kHeader = 104;  // with the place of one level
    if (file.size() < kHeader) return damaged("the file is cut off");
    Ktx2 ktx;
    ktx.width = u32_at(file, 20), ktx.height = u32_at(file, 24), ktx.scheme = Scheme{u32_at(file, 44)};
    if (const auto size = check_image_size(ktx.width, ktx.height, limits); !size) return tl::unexpected(size.error());
    if (u32_at(file, 28) > 1) return damaged("the texture has {} slices of depth, expected a flat one", u32_at(file, 28));
    ktx.globals = part(file, u64_at(file, 64), u64_at(file, 72));
    ktx.level = part(file, u64_at(file, 80), u64_at(file, 88));
    ktx.unpacked = u64_at(file, 96);
    if (ktx.level.empty()) return damaged("the file is cut off");
    if (ktx.scheme > Scheme::zlib) return damaged("supercompression scheme {} is not read", static_cast<std::uint32_t>(ktx.scheme));

    const std::uint32_t format = u32_at(file, 12);
    if (format == 0) {
        constexpr std::size_t kModelAt = 12;
        const auto descriptor = part(file, u32_at(file, 48), u32_at(file, 52));
        if (descriptor.size() <= kModelAt) return damaged("the data format descriptor is missing");
        ktx.model = byte_at(descriptor, kModelAt);
        if (ktx.model != kEtc1sModel && ktx.model != kUastcModel)
            return damaged("colour model {} is not read, expected ETC1S or UASTC", ktx.model);
        if ((ktx.model == kEtc1sModel) != (ktx.scheme == Scheme::basis_lz))
            return damaged("supercompression scheme {} does not go with colour model {}", static_cast<std::uint32_t>(ktx.scheme),
                           ktx.model);
        return ktx;
    }
    const auto* plain =
        std::find_if(std::begin(kPlains), std::end(kPlains), [&](const Plain& p) { return format == p.unorm || format == p.srgb; });
    if (plain == std::end(kPlains) || ktx.scheme == Scheme::basis_lz)
        return damaged("vkFormat {} is not read, expected ETC1S, UASTC or plain channels of 8 bits", format);
    ktx.plain = *plain;
    for (std::size_t c = plain->channels; c < 4; ++c) ktx.channels[c] = c == 3 ? 5 : 4;
    read_swizzle(part(file, u32_at(file, 56), u32_at(file, 60)), ktx);
    return ktx;
}

/// The bytes of a level, one after the other.
class LevelBytes {
public:
    explicit LevelBytes(const Ktx2& ktx) : rest_(ktx.level) {
        if (ktx.scheme != Scheme::zstd) return;
        // A level may be its own window. Streams of unknown length have up to 8 MB, which the format asks readers to support.
        const std::uint64_t most = 4 * (std::uint64_t{ktx.width} + 3) * (std::uint64_t{ktx.height} + 3);
        const int window_bits = std::clamp<int>(static_cast<int>(std::bit_width(most)), 23, 28);
        stream_.reset(ZSTD_createDStream());
        if (!stream_ || ZSTD_isError(ZSTD_DCtx_setParameter(stream_.get(), ZSTD_d_windowLogMax, window_bits)) != 0) throw std::bad_alloc();
    }
    /// Unpacks all of a level that zlib has compressed. False: it is damaged.
    bool inflate_all(std::uint64_t size) {
        whole_.resize(static_cast<std::size_t>(size));
        const bool is_sound = unpack_zlib(rest_, whole_);
        rest_ = std::as_bytes(std::span(whole_));
        return is_sound;
    }
    /// False: there are no more, or they are damaged.
    [[nodiscard]] bool read(std::span<std::uint8_t> to) {
        if (!stream_) {
            if (rest_.size() < to.size()) return false;
            std::memcpy(to.data(), rest_.data(), to.size());
            rest_ = rest_.subspan(to.size());
            return true;
        }
        ZSTD_outBuffer out{to.data(), to.size(), 0};
        ZSTD_inBuffer in{rest_.data(), rest_.size(), 0};
        for (bool is_stuck = false; out.pos < out.size && !is_stuck;) {
            check_time();
            const std::size_t before = out.pos, taken = in.pos;
            if (ZSTD_isError(ZSTD_decompressStream(stream_.get(), &out, &in)) != 0) return false;
            is_stuck = out.pos == before && in.pos == taken;
        }
        rest_ = rest_.subspan(in.pos);
        return out.pos == out.size;
    }

private:
    struct Free {
        void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
    };
    std::span<const std::byte> rest_;
    std::vector<std::uint8_t> whole_;
    std::unique_ptr<ZSTD_DStream, Free> stream_;
};

bool add_plain_rows(const Ktx2& ktx, LevelBytes& bytes, RowSink& sink) {
    const std::size_t channels = ktx.plain->channels;
    std::vector<std::uint8_t> packed(channels * ktx.width), row(4 * ktx.width);
    for (std::size_t y = 0; y < ktx.height; ++y) {
        if (!bytes.read(packed)) return false;
        for (std::size_t x = 0; x < ktx.width; ++x) {
            std::array<std::uint8_t, 6> values{0, 0, 0, 255, 0, 255};  // RGBA as stored, 0 and 1
            std::memcpy(values.data(), &packed[channels * x], channels);
            if (ktx.plain->is_bgr) std::swap(values[0], values[2]);
            for (std::size_t c = 0; c < 4; ++c) row[4 * x + c] = values[ktx.channels[c]];
        }
        sink.add_row(row.data());
    }
    return true;
}

/// next_row: fills a row of blocks; false if it cannot.
template <class NextRow>
bool add_block_rows(const Ktx2& ktx, RowSink& sink, NextRow next_row) {
    std::vector<Block> blocks((ktx.width + kBlockSide - 1) / kBlockSide);
    std::vector<std::uint8_t> row(4 * kBlockSide * blocks.size());
    for (std::size_t y = 0; y < ktx.height; ++y) {
        if (y % kBlockSide == 0 && !next_row(blocks)) return false;
        for (std::size_t i = 0; i < blocks.size(); ++i)
            std::memcpy(&row[4 * kBlockSide * i], &blocks[i][kBlockSide * (y % kBlockSide)], 4 * kBlockSide);
        sink.add_row(row.data());
    }
    return true;
}

bool add_uastc_rows(const Ktx2& ktx, LevelBytes& bytes, RowSink& sink) {
    std::vector<std::uint8_t> packed;
    return add_block_rows(ktx, sink, [&](std::span<Block> blocks) {
        packed.resize(kUastcBytes * blocks.size());
        if (!bytes.read(packed)) return false;
        const auto row = std::as_bytes(std::span(packed));
        for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i] = decode_uastc(row.subspan(kUastcBytes * i).first<kUastcBytes>());
        return true;
    });
}

bool add_etc1s_rows(const Ktx2& ktx, std::uint64_t images, RowSink& sink) {
    constexpr std::size_t kHead = 20, kImage = 20;
    if (ktx.globals.size() < kHead + kImage) return false;
    const auto slice = [&](std::size_t at) { return part(ktx.level, u32_at(ktx.globals, at), u32_at(ktx.globals, at + 4)); };
    Etc1sParts parts;
    parts.endpoint_count = u16_at(ktx.globals, 0), parts.selector_count = u16_at(ktx.globals, 2);
    parts.color = slice(kHead + 4), parts.alpha = slice(kHead + 12), parts.has_alpha = u32_at(ktx.globals, kHead + 16) != 0;
    std::uint64_t at = kHead + kImage * images;
    std::size_t size_at = 4;
    for (auto* bytes : {&parts.endpoints, &parts.selectors, &parts.tables}) {
        const std::uint32_t size = u32_at(ktx.globals, size_at);
        *bytes = part(ktx.globals, at, size);
        at += size, size_at += 4;
    }
    Etc1sDecoder decoder(parts, (ktx.width + kBlockSide - 1) / kBlockSide);
    return add_block_rows(ktx, sink, [&](std::span<Block> blocks) { return decoder.next_row(blocks); });
}

}  // namespace

Result<ImageHeader> read_ktx2_header(std::span<const std::byte> file, const ImageLimits& limits) {
    const auto ktx = read_ktx2(file, limits);
    if (!ktx) return tl::unexpected(ktx.error());
    return ImageHeader{ImageFormat::ktx2, static_cast<int>(ktx->width), static_cast<int>(ktx->height), 8};
}

Result<void> decode_ktx2_rows(std::span<const std::byte> file, const ImageLimits& limits, RowSink& sink) {
    const auto ktx = read_ktx2(file, limits);
    if (!ktx) return tl::unexpected(ktx.error());
    bool is_whole = false;
    if (ktx->model == kEtc1sModel) {
        // Layers, faces and levels, each of which has an entry. Too many lead out of the file.
        std::uint64_t images = 1;
        for (const std::size_t at : {32, 36, 40}) images *= std::max(u32_at(file, at), 1u);
        is_whole = add_etc1s_rows(*ktx, images, sink);
    } else {
        LevelBytes bytes(*ktx);
        if (ktx->scheme == Scheme::zlib) {
            constexpr std::uint64_t kMostRatio = 1032;  // of deflate
            if (ktx->unpacked > std::min(4 * std::uint64_t{limits.max_pixels}, kMostRatio * ktx->level.size()))
                return damaged("a level of {} bytes is too large", ktx->unpacked);
            if (!bytes.inflate_all(ktx->unpacked)) return damaged("the level's zlib stream is damaged");
        }
        is_whole = ktx->plain ? add_plain_rows(*ktx, bytes, sink) : add_uastc_rows(*ktx, bytes, sink);
    }
    if (!is_whole) return damaged("the pixels are damaged or cut off");
    return {};
}

#else

namespace {

tl::unexpected<Error> no_library() { return fail(ErrorCode::bad_input, "KTX2 pictures need the library libzstd, which this build lacks"); }

}  // namespace

Result<ImageHeader> read_ktx2_header(std::span<const std::byte>, const ImageLimits&) { return no_library(); }
Result<void> decode_ktx2_rows(std::span<const std::byte>, const ImageLimits&, RowSink&) { return no_library(); }

#endif

}  // namespace detail

}  // namespace halflit::io
