// The arrays of a glTF file whose elements other parts refer to by index.
#pragma once

#include "apps/io/gltf/file/file.hpp"

#include <cstddef>
#include <cstdint>

namespace halflit::io::detail {

enum class Target : std::uint8_t {
    none,
    accessors,
    animations,
    buffers,
    buffer_views,
    cameras,
    images,
    lights,
    materials,
    meshes,
    nodes,
    samplers,
    scenes,
    skins,
    textures
};
inline constexpr std::size_t kTargets = 15;

[[nodiscard]] const char* name_of(Target target);  ///< "accessors"
[[nodiscard]] std::size_t count_of(Target target, const file::File& file);

}  // namespace halflit::io::detail
