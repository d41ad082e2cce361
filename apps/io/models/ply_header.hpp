// The header of a PLY file: which elements follow, and their properties.
#pragma once

#include "apps/io/gltf/file/document.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace halflit::io::detail {

enum class PlyType : std::uint8_t { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };
enum class PlyFormat : std::uint8_t { ascii, little_endian, big_endian };

[[nodiscard]] constexpr bool is_whole(PlyType type) { return type < PlyType::f32; }
[[nodiscard]] constexpr std::size_t size_of(PlyType type) {
    constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

struct PlyProperty {
    std::string_view name;
    PlyType type = PlyType::f32;
    bool is_list = false;
    PlyType count_type = PlyType::u8;  ///< of a list
};

struct PlyElement {
    std::string_view name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;
    std::vector<std::string_view> textures;  ///< of comments "TextureFile NAME"
    std::string_view trained_as;             ///< of comments on how 3D Gaussians are to be drawn; see SplatCloud::set_reference
    std::string_view body;                   ///< what follows
    std::size_t lines = 0;                   ///< of the header
};

/// Throws LoadFailure. Unknown lines are passed over, with a warning. Views point into `bytes`.
[[nodiscard]] PlyHeader read_ply_header(std::span<const std::byte> bytes, Document& document);

}  // namespace halflit::io::detail
