// Plain PNGs: 8 bits a channel, not interlaced, nothing that says anything of pixels after them. Most pictures are such, and they are
// decoded in a third of the time that a decoder of all kinds takes: the whole picture is decompressed at once, and filters are undone two
// rows at a time.
#pragma once

#include "apps/io/pictures/image_reader.hpp"

#include <cstddef>
#include <cstdint>

namespace halflit::io::detail {

constexpr std::size_t kPngSignature = 8, kPngChunkFrame = 12;  ///< bytes; the frame is a chunk's length, type and checksum

[[nodiscard]] inline std::uint32_t png_number(const std::byte* at) {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value = value << 8 | std::to_integer<std::uint32_t>(at[i]);
    return value;
}

struct PlainPng {
    std::size_t width = 0, height = 0;
    int color_type = 0;  ///< PNG's: 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGBA
    Palette palette{};   ///< for colour type 3
};

/// Adds all rows, of 8 bits. False: the file is not plain, or is damaged; nothing was added. `file` is sound up to its pixels, and
/// has the header of `png`.
bool decode_plain_png(std::span<const std::byte> file, const PlainPng& png, RowSink& sink);

}  // namespace halflit::io::detail
