// TIFF as painting programs write it: grey, colour or a palette of 1 to 16 bits a channel, in strips or tiles, plain or compressed by
// PackBits, LZW or deflate, with or without horizontal differences. Own code: libtiff brings six libraries into each process. Refused are
// fax, JPEG, separate planes and floats. The first picture of the file is read.
#include "apps/io/files/deflate.hpp"
#include "apps/io/files/little_endian.hpp"
#include "apps/io/pictures/image_decoders.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace halflit::io::detail {
namespace {

struct Tag {
    std::uint32_t type = 0, count = 0, at = 0;  ///< at: offset of the values
};

constexpr std::uint32_t kWidth = 256, kHeight = 257, kBits = 258, kCompression = 259, kPhotometric = 262, kOffsets = 273, kSamples = 277,
                        kRows = 278, kSizes = 279, kPlanes = 284, kPredictor = 317, kPalette = 320, kTileWidth = 322, kTileHeight = 323,
                        kTileOffsets = 324, kTileSizes = 325, kExtra = 338, kSampleFormat = 339;

Result<DecodedImage> damaged(const char* what) { return fail(ErrorCode::bad_input, fmt::format("TIFF: {}", what)); }

class TiffFile {
public:
    explicit TiffFile(std::span<const std::byte> file) : file_(file), big_(byte_at(file, 0) == 'M') {}

    std::uint32_t u16(std::size_t at) const {
        if (at > file_.size() || file_.size() - at < 2) return 0;
        return big_ ? byte_at(file_, at) << 8 | byte_at(file_, at + 1) : u16_at(file_, at);
    }
    std::uint32_t u32(std::size_t at) const {
        return big_ ? u16(at) << 16 | u16(at + 2) : at <= file_.size() && file_.size() - at >= 4 ? u32_at(file_, at) : 0;
    }
    /// A tag of the first directory.
    std::optional<Tag> find(std::uint32_t id) const {
        const std::size_t directory = u32(4), entries = u16(directory);
        for (std::size_t i = 0; i < entries; ++i) {
            const std::size_t at = directory + 2 + 12 * i;
            if (at + 12 > file_.size()) break;
            if (u16(at) != id) continue;
            Tag tag{u16(at + 2), u32(at + 4), static_cast<std::uint32_t>(at) + 8};
            const std::uint64_t bytes = std::uint64_t{tag.count} * (tag.type == 3 ? 2 : tag.type == 4 ? 4 : 1);
            if (bytes > 4) tag.at = u32(at + 8);
            if (tag.at > file_.size() || bytes > file_.size() - tag.at) return std::nullopt;
            return tag;
        }
        return std::nullopt;
    }
    std::uint32_t value(const Tag& tag, std::size_t i) const {
        return tag.type == 3 ? u16(tag.at + 2 * i) : tag.type == 4 ? u32(tag.at + 4 * i) : byte_at(file_, tag.at + i);
    }
    std::uint32_t first(std::uint32_t id, std::uint32_t otherwise) const {
        const auto tag = find(id);
        return tag && tag->count > 0 ? value(*tag, 0) : otherwise;
    }
    [[nodiscard]] std::span<const std::byte> part(std::uint32_t at, std::uint32_t size) const {
        return at > file_.size() ? file_.first(0) : file_.subspan(at, std::min<std::size_t>(size, file_.size() - at));
    }
    [[nodiscard]] bool is_big() const { return big_; }

private:
    std::span<const std::byte> file_;
    bool big_;
};

// Each fills `to` as far as its data go. False: the data are damaged.

bool unpack_bits(std::span<const std::byte> from, std::span<std::uint8_t> to) {
    std::size_t out = 0;
    for (std::size_t at = 0; at < from.size() && out < to.size();) {
        const auto code = static_cast<int>(static_cast<std::int8_t>(byte_at(from, at++)));
        if (code == -128) continue;
        const auto count = static_cast<std::size_t>(code >= 0 ? code + 1 : 1 - code);
        for (std::size_t i = 0; i < count && out < to.size() && at < from.size(); ++i) {
            to[out++] = static_cast<std::uint8_t>(byte_at(from, at));
            if (code >= 0) ++at;
        }
        if (code < 0) ++at;
    }
    return out == to.size();
}

bool unpack_lzw(std::span<const std::byte> from, std::span<std::uint8_t> to) {
    constexpr std::uint32_t kClear = 256, kEnd = 257, kMost = 4096;
    struct Entry {
        std::uint16_t before;
        std::uint8_t last, first;
    };
    Entry table[kMost];
    std::uint16_t length[kMost];
    for (std::uint32_t i = 0; i < 256; ++i) table[i] = {0, static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i)}, length[i] = 1;
    std::uint32_t next = 258, width = 9, bits = 0, held = 0, before = kClear;
    std::size_t at = 0, out = 0;
    TimeCheck check;
    while (out < to.size()) {
        check();
        for (; held < width; held += 8) {
            if (at == from.size()) return false;
            bits = bits << 8 | byte_at(from, at++);
        }
        const std::uint32_t code = bits >> (held - width) & ((1u << width) - 1);
        held -= width;
        if (code == kEnd) return false;
        if (code == kClear) {
            next = 258, width = 9, before = kClear;
            continue;
        }
        if (code > next || (code == next && before == kClear) || code == kClear) return false;
        if (before != kClear && next < kMost) {
            const std::uint8_t last = code == next ? table[before].first : table[code].first;
            table[next] = {static_cast<std::uint16_t>(before), last, table[before].first};
            length[next] = static_cast<std::uint16_t>(length[before] + 1);
            ++next;
        } else if (code >= next) {
            return false;
        }
        if (next + 1 >= 1u << width && width < 12) ++width;
        std::size_t end = out + length[code];
        for (std::uint32_t entry = code; end > out; entry = table[entry].before) {
            --end;
            if (end < to.size()) to[end] = table[entry].last;
        }
        out += length[code];
        before = code;
    }
    return true;
}

struct Layout {
    std::uint32_t bits = 0, samples = 0, photometric = 0, compression = 0, predictor = 0;
    bool has_alpha = false;
};

bool unpack(const Layout& layout, std::span<const std::byte> from, std::span<std::uint8_t> to) {
    switch (layout.compression) {
        case 1:
            for (std::size_t i = 0; i < std::min(from.size(), to.size()); ++i) to[i] = static_cast<std::uint8_t>(byte_at(from, i));
            return from.size() >= to.size();
        case 5:
            return unpack_lzw(from, to);
        case 32773:
            return unpack_bits(from, to);
        default:
            return unpack_zlib(from, to);
    }
}

/// Undoes differences between neighbours of a row.
void add_differences(const Layout& layout, bool big, std::span<std::uint8_t> row) {
    const std::size_t step = layout.samples;
    if (layout.bits == 8)
        for (std::size_t i = step; i < row.size(); ++i) row[i] = static_cast<std::uint8_t>(row[i] + row[i - step]);
    if (layout.bits != 16) return;
    const std::size_t high = big ? 0 : 1, low = 1 - high;
    for (std::size_t i = 2 * step; i + 1 < row.size(); i += 2) {
        const auto value_at = [&](std::size_t at) { return static_cast<unsigned>(row[at + high] << 8 | row[at + low]); };
        const unsigned sum = value_at(i) + value_at(i - 2 * step);
        row[i + high] = static_cast<std::uint8_t>(sum >> 8), row[i + low] = static_cast<std::uint8_t>(sum);
    }
}

}  // namespace

bool is_tiff(std::span<const std::byte> file) {
    return file.size() >= 8 && ((byte_at(file, 0) == 'I' && byte_at(file, 1) == 'I' && byte_at(file, 2) == 42 && byte_at(file, 3) == 0) ||
                                (byte_at(file, 0) == 'M' && byte_at(file, 1) == 'M' && byte_at(file, 2) == 0 && byte_at(file, 3) == 42));
}

Result<ImageHeader> read_tiff_header(std::span<const std::byte> file, const ImageLimits& limits) {
    const TiffFile tiff(file);
    const std::uint32_t width = tiff.first(kWidth, 0), height = tiff.first(kHeight, 0);
    if (const auto checked = check_image_size(width, height, limits); !checked) return tl::unexpected(checked.error());
    return ImageHeader{ImageFormat::tiff, static_cast<int>(width), static_cast<int>(height)};
}

Result<DecodedImage> decode_tiff(std::span<const std::byte> file, const ImageLimits& limits) {
    const auto header = read_tiff_header(file, limits);
    if (!header) return tl::unexpected(header.error());
    const TiffFile tiff(file);
    const auto width = static_cast<std::uint32_t>(header->width), height = static_cast<std::uint32_t>(header->height);
    Layout layout{tiff.first(kBits, 1),        tiff.first(kSamples, 1),   tiff.first(kPhotometric, 1),
                  tiff.first(kCompression, 1), tiff.first(kPredictor, 1), false};
    const bool is_palette = layout.photometric == 3, is_color = layout.photometric == 2;
    layout.has_alpha = layout.samples == (is_color ? 4u : 2u) && tiff.first(kExtra, 2) != 0;
    const bool can_read = layout.photometric <= 3 && layout.samples >= (is_color ? 3u : 1u) && layout.samples <= 8 &&
                          (layout.bits == 8 || (layout.bits == 16 && !is_palette) ||
                           (layout.bits > 0 && layout.bits < 8 && 8 % layout.bits == 0 && layout.samples == 1));
    const std::uint32_t compression = layout.compression;
    if (!can_read || (compression != 1 && compression != 5 && compression != 8 && compression != 32773 && compression != 32946) ||
        tiff.first(kPlanes, 1) != 1 || tiff.first(kSampleFormat, 1) != 1 || layout.predictor > 2)
        return fail(ErrorCode::bad_input,
                    fmt::format("TIFF: expected whole numbers of 1 to 16 bits, plain or by LZW, deflate or PackBits, found "
                                "{} samples of {} bits, photometry {}, compression {}, predictor {}",
                                layout.samples, layout.bits, layout.photometric, compression, layout.predictor));
    const bool is_tiled = tiff.find(kTileOffsets).has_value();
    const auto offsets = tiff.find(is_tiled ? kTileOffsets : kOffsets), sizes = tiff.find(is_tiled ? kTileSizes : kSizes);
    const auto palette = tiff.find(kPalette);
    const std::uint32_t part_width = is_tiled ? tiff.first(kTileWidth, 0) : width;
    const std::uint32_t part_height = is_tiled ? tiff.first(kTileHeight, 0) : std::min(tiff.first(kRows, height), height);
    if (!offsets || part_width == 0 || part_height == 0) return damaged("the file has no pixels");
    if (const auto checked = check_image_size(part_width, part_height, limits); !checked) return tl::unexpected(checked.error());
    if (is_palette && (!palette || palette->count < 3u << layout.bits)) return damaged("the palette is missing");

    DecodedImage image{header->width, header->height, {}, {}};
    const std::size_t row_bytes = (std::size_t{part_width} * layout.samples * layout.bits + 7) / 8;
    const std::uint32_t across = (width + part_width - 1) / part_width, down = (height + part_height - 1) / part_height;
    if (offsets->count < std::uint64_t{across} * down) return damaged("strips or tiles are missing");
    // Bytes that a byte of the file can hold at most, so that a short file cannot take much memory.
    const std::uint64_t most_by_byte = compression == 1 ? 1 : compression == 32773 ? 64 : compression == 5 ? 2800 : 1032;
    if (std::uint64_t{row_bytes} * part_height * across * down / 2 > file.size() * most_by_byte)
        return damaged("the file ends within the pixels");
    std::vector<std::uint8_t> part;
    image.rgba8.assign(std::size_t{4} * width * height, 255);
    const std::uint32_t most = (1u << layout.bits) - 1;
    for (std::uint32_t p = 0; p < across * down; ++p) {
        check_time();
        const std::uint32_t left = p % across * part_width, top = p / across * part_height;
        const std::uint32_t rows = is_tiled ? part_height : std::min(part_height, height - top);
        part.assign(row_bytes * rows, 0);
        const auto packed = tiff.part(tiff.value(*offsets, p), sizes && p < sizes->count ? tiff.value(*sizes, p) : 0xFFFFFFFFu);
        if (!unpack(layout, packed, part)) return damaged("a strip or tile is damaged or cut off");
        for (std::uint32_t y = 0; y < std::min(rows, height - top); ++y) {
            const std::span row(part.data() + row_bytes * y, row_bytes);
            if (layout.predictor == 2 && compression != 1 && compression != 32773) add_differences(layout, tiff.is_big(), row);
            const auto sample = [&](std::uint32_t x, std::uint32_t c) -> std::uint32_t {
                const std::size_t at = std::size_t{x} * layout.samples + c;
                if (layout.bits == 16) return row[2 * at + (tiff.is_big() ? 0 : 1)];  // the high byte
                if (layout.bits == 8) return row[at];
                const std::uint32_t shift = 8 - layout.bits - static_cast<std::uint32_t>(at * layout.bits % 8);
                return (row[at * layout.bits / 8] >> shift) & most;
            };
            for (std::uint32_t x = 0; x < std::min(part_width, width - left); ++x) {
                std::uint8_t* const to = &image.rgba8[4 * (std::size_t{top + y} * width + left + x)];
                for (std::uint32_t c = 0; c < 3; ++c) {
                    const std::uint32_t value = sample(x, is_color ? c : 0);
                    const std::uint32_t code = is_palette        ? tiff.value(*palette, (std::size_t{c} << layout.bits) + value) >> 8
                                               : layout.bits < 8 ? value * 255 / most
                                                                 : value;
                    to[c] = static_cast<std::uint8_t>(layout.photometric == 0 ? 255 - code : code);
                }
                if (layout.has_alpha) to[3] = static_cast<std::uint8_t>(sample(x, layout.samples - 1));
            }
        }
    }
    return image;
}

}  // namespace halflit::io::detail
