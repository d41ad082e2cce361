// Version number of the pixels.
#pragma once

namespace halflit::raster {

/// Raised by every release that may change the pixels of some scene. Releases of equal epoch give equal pixel hashes.
inline constexpr int kPixelEpoch = 1;

}  // namespace halflit::raster
