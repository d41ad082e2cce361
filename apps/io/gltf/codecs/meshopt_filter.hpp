// Filters of EXT_meshopt_compression and KHR_meshopt_compression, which turn decoded integers into attributes. Computed here and not by the
// library meshoptimizer: its rounding, and on Arm its square root, differ between instruction sets.
#pragma once

#include "apps/io/gltf/file/file.hpp"

#include <cstddef>
#include <span>

namespace halflit::io::detail {

/// True if the filter may have elements of so many bytes.
[[nodiscard]] bool fits(file::CompressionFilter filter, std::size_t stride);

/// Filters elements of `stride` bytes in place; numbers are little-endian. Requires: fits(filter, stride). Values that no encoder writes
/// give numbers that are wrong, but the same everywhere.
void apply_filter(file::CompressionFilter filter, std::span<std::byte> data, std::size_t stride);

}  // namespace halflit::io::detail
