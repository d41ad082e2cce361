// The age of the pixels.
#pragma once

namespace halflit::raster {

/// Rises with every release in which some scene may give other pixels than before. Equal epochs mean equal pixel hashes.
inline constexpr int kPixelEpoch = 1;

}  // namespace halflit::raster
