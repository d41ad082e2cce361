// Versions of the library and of its pixels.
#pragma once

#include "halflit/export.hpp"

/// @{
/// Part of the headers' version.
#define HALFLIT_VERSION_MAJOR 0
#define HALFLIT_VERSION_MINOR 1
#define HALFLIT_VERSION_PATCH 0
/// @}

namespace halflit {

/// Raised by every release that may change the pixels of some scene. Releases of equal epoch give equal pixel hashes.
inline constexpr int kPixelEpoch = 10;

/// Version of the library that is linked, as "0.1.0"; a shared library may be another than that of the headers.
[[nodiscard]] HALFLIT_API const char* version();

/// Pixel epoch of the library that is linked.
[[nodiscard]] HALFLIT_API int pixel_epoch();

}  // namespace halflit
