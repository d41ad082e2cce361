// At most 256 colours for a picture, chosen from that picture alone by integer arithmetic, so that every machine chooses the same.
#pragma once

#include "halflit/target.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace halflit::film {

using Rgb8 = std::array<std::uint8_t, 3>;

/// A picture by numbers of colours.
struct PalettePicture {
    std::vector<Rgb8> colors;          ///< 1 to 256
    std::vector<std::uint8_t> pixels;  ///< indices into `colors`, row by row
    int transparent = -1;              ///< index of the transparent colour; -1: none
};

/// A picture of at most 256 colours keeps them. Otherwise they are chosen by median cut over cells of 8 x 8 x 8 codes: the box with the
/// largest sum of squared distances to its mean is cut across its longest side at the median, until there are enough. A pixel gets the
/// nearest colour. dither: an ordered pattern of 8 x 8 is added before that. Pixels of alpha below 128 get the transparent colour, others
/// are opaque.
[[nodiscard]] PalettePicture with_palette(const Image& picture, bool dither);

}  // namespace halflit::film
