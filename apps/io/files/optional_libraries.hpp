// Libraries that a build may lack. Each answer stands beside the code that calls the library.
#pragma once

namespace halflit::io {

/// @{
/// True where the build has the library: libwebp, libzstd, Draco, meshoptimizer.
[[nodiscard]] bool has_webp();
[[nodiscard]] bool has_ktx2();
[[nodiscard]] bool has_draco();
[[nodiscard]] bool has_meshopt();
/// @}

}  // namespace halflit::io
