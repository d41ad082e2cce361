// Little-endian numbers in BMP, TGA, STL and ZIP files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace halflit::io::detail {

inline std::uint32_t byte_at(std::span<const std::byte> file, std::size_t at) { return std::to_integer<std::uint32_t>(file[at]); }
inline std::uint32_t u16_at(std::span<const std::byte> file, std::size_t at) { return byte_at(file, at) | byte_at(file, at + 1) << 8; }
inline std::uint32_t u32_at(std::span<const std::byte> file, std::size_t at) { return u16_at(file, at) | u16_at(file, at + 2) << 16; }
inline std::uint64_t u64_at(std::span<const std::byte> file, std::size_t at) {
    return u32_at(file, at) | std::uint64_t{u32_at(file, at + 4)} << 32;
}

}  // namespace halflit::io::detail
