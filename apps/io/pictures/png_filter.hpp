// Filters of PNG rows, undone. Every filter predicts a pixel's channels from the pixels to the left, above, and left above, and the file
// has the differences.
#pragma once

#include <cstddef>
#include <cstdint>

namespace halflit::io::detail {

constexpr std::uint8_t kMaxPngFilter = 4;  ///< 0 none, 1 left, 2 up, 3 their mean, 4 Paeth: the nearest to left + up - left above

/// A row of the file: the number of its filter, then its pixels. Four bytes past its last pixel are read.
using FilteredRow = const std::uint8_t*;

/// Undoes the filters of two rows of pixels of one to four channels of 8 bits. In `above` and the results a pixel has four bytes, of which
/// those past its channels mean nothing; they have room for `width` + 1 pixels.
void undo_png_filters(FilteredRow upper, FilteredRow lower, std::size_t channels, std::size_t width, const std::uint8_t* above,
                      std::uint8_t* upper_pixels, std::uint8_t* lower_pixels);

}  // namespace halflit::io::detail
