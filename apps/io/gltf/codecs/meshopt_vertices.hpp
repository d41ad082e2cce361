// Version 1 of the vertex codec of KHR_meshopt_compression (its specification, appendix A, mode 0). Debian 12's meshoptimizer, 0.18,
// decodes version 0 alone; 0.23 and newer decode both.
#pragma once

#include <cstddef>
#include <span>

namespace halflit::io::detail {

inline constexpr std::byte kVertexCodec1{0xa1};  ///< first byte of the data

/// Decodes elements of `stride` bytes, to.size() / stride of them. Requires: stride a multiple of 4 from 4 to 256. False for damaged data;
/// `to` is partly filled then.
[[nodiscard]] bool decode_vertices_1(std::span<const std::byte> from, std::span<std::byte> to, std::size_t stride);

}  // namespace halflit::io::detail
