// Plain PNGs: 8 bits a channel, not interlaced, nothing but IEND after the pixels. Most pictures are such, and they are decoded in a third
// of the time that a decoder of all kinds takes: the whole picture is decompressed at once, and filters are undone two rows at a time.
#pragma once

#include "apps/io/pictures/image_reader.hpp"

namespace halflit::io::detail {

struct PlainPng {
    std::size_t width = 0, height = 0;
    int color_type = 0;  ///< PNG's: 0 grey, 2 RGB, 3 palette, 4 grey and alpha, 6 RGBA
    Palette palette{};   ///< for colour type 3
};

/// Adds all rows, of 8 bits. False: the file is not plain, or is damaged; nothing was added. `file` is sound up to its pixels, and
/// has the header of `png`.
bool decode_plain_png(std::span<const std::byte> file, const PlainPng& png, RowSink& sink);

}  // namespace halflit::io::detail
