#include "apps/io/pictures/png_plain.hpp"

#include "apps/io/files/deflate.hpp"
#include "apps/io/pictures/png_filter.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <memory>

namespace halflit::io::detail {

namespace {

constexpr std::size_t kMostInflated = std::size_t{64} << 20;  // larger pictures are decompressed row by row, in less memory
constexpr std::size_t kReadPastRow = 4;                       // see FilteredRow
constexpr std::uint32_t kIdat = 0x49444154, kIend = 0x49454E44;

/// Chunks that say nothing of the pixels and may follow them: tEXt, zTXt, iTXt, tIME, eXIf.
bool may_follow_pixels(std::uint32_t type) {
    constexpr std::uint32_t kTypes[] = {0x74455874, 0x7A545874, 0x69545874, 0x74494D45, 0x65584966};
    return std::find(std::begin(kTypes), std::end(kTypes), type) != std::end(kTypes);
}

/// The contents of all IDAT chunks; nothing if a checksum is wrong, or if what follows says anything of pixels.
std::vector<std::byte> compressed_data(std::span<const std::byte> file) {
    std::vector<std::byte> data;
    data.reserve(file.size());
    bool ended = false;
    for (std::size_t at = kPngSignature; file.size() - at >= kPngChunkFrame;) {
        const std::uint32_t size = png_number(&file[at]), type = png_number(&file[at + 4]);
        if (size > file.size() - at - kPngChunkFrame) return {};
        const std::byte* const body = &file[at] + 8;
        const bool is_sound = libdeflate_crc32(0, body - 4, size + std::size_t{4}) == png_number(body + size);
        if (type == kIdat) {
            if (!is_sound || size == 0 || ended) return {};
            data.insert(data.end(), body, body + size);
        } else if (type == kIend) {
            return is_sound && size == 0 ? data : std::vector<std::byte>();
        } else if (!data.empty()) {
            if (!is_sound || !may_follow_pixels(type)) return {};
            ended = true;
        }
        at += kPngChunkFrame + size;
    }
    return {};
}

/// Rows as the file has them; null if the data are damaged, or do not have this size.
std::unique_ptr<std::uint8_t[]> inflate(std::span<const std::byte> data, std::size_t size) {
    const Decompressor decompressor = make_decompressor();
    auto rows = std::make_unique_for_overwrite<std::uint8_t[]>(size + kReadPastRow);
    std::memset(&rows[size], 0, kReadPastRow);
    std::size_t taken = 0, made = 0;
    if (libdeflate_zlib_decompress_ex(decompressor.get(), data.data(), data.size(), rows.get(), size, &taken, &made) != LIBDEFLATE_SUCCESS)
        return nullptr;
    return taken == data.size() && made == size ? std::move(rows) : nullptr;
}

std::size_t channels_of(int color_type) { return color_type == 2 ? 3 : color_type == 4 ? 2 : color_type == 6 ? 4 : 1; }

/// Pixel x of a row is at pixels + x * step.
void to_rgba(const PlainPng& png, const std::uint8_t* pixels, std::size_t step, std::uint8_t* to) {
    const std::uint8_t* const end = to + 4 * png.width;
    switch (png.color_type) {
        case 0:
            for (; to != end; to += 4, pixels += step) to[0] = to[1] = to[2] = *pixels, to[3] = 255;
            return;
        case 2:
            for (; to != end; to += 4, pixels += step) std::memcpy(to, pixels, 4), to[3] = 255;
            return;
        case 4:
            for (; to != end; to += 4, pixels += step) to[0] = to[1] = to[2] = pixels[0], to[3] = pixels[1];
            return;
        default:
            for (; to != end; to += 4, pixels += step) std::memcpy(to, pixels, 4);
    }
}

}  // namespace

bool decode_plain_png(std::span<const std::byte> file, const PlainPng& png, RowSink& sink) {
    const std::size_t channels = channels_of(png.color_type), row = 1 + channels * png.width;
    if (std::uint64_t{row} * png.height > kMostInflated) return false;
    const std::size_t size = row * png.height;
    const std::vector<std::byte> data = compressed_data(file);
    if (data.empty()) return false;
    const auto rows = inflate(data, size);
    if (rows == nullptr) return false;
    for (std::size_t at = 0; at < size; at += row)
        if (rows[at] > kMaxPngFilter) return false;

    const std::size_t room = 4 * (png.width + 1);
    std::vector<std::uint8_t> above(room), upper(room), lower(room), rgba(room);
    const auto add = [&](const std::uint8_t* pixels, std::size_t step) {
        if (png.color_type != 3) {
            to_rgba(png, pixels, step, rgba.data());
            sink.add_row(rgba.data());
        } else if (step == 1) {
            sink.add_indexed_row({pixels, png.width}, png.palette);
        } else {
            for (std::size_t x = 0; x < png.width; ++x) rgba[x] = pixels[step * x];
            sink.add_indexed_row({rgba.data(), png.width}, png.palette);
        }
    };
    for (std::size_t y = 0; y < png.height; y += 2) {
        const bool is_last = y + 1 == png.height;
        const std::uint8_t* const first = &rows[y * row];
        const std::uint8_t* const second = is_last ? first : first + row;
        if (*first == 0 && *second == 0) {
            add(first + 1, channels);
            if (!is_last) add(second + 1, channels);
            if (y + 2 < png.height)
                for (std::size_t x = 0; x < png.width; ++x) std::memcpy(&above[4 * x], second + 1 + channels * x, 4);
            continue;
        }
        undo_png_filters(first, second, channels, png.width, above.data(), upper.data(), lower.data());
        add(upper.data(), 4);
        if (!is_last) add(lower.data(), 4);
        above.swap(lower);
    }
    return true;
}

}  // namespace halflit::io::detail
