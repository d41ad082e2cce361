// Scenes made by code, as GLB files.
#pragma once

#include "halflit/scene.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace halflit::test {

/// The picture that a texture was made from.
struct GlbPicture {
    int width = 0, height = 0;
    std::span<const std::uint8_t> rgba8;
};

struct GlbContent {
    const Scene& scene;
    Camera camera;
    double aspect = 1;                 ///< width / height of the picture
    std::vector<GlbPicture> pictures;  ///< of scene.textures, by index
    std::string generator;
};

/// Bytes of the file. An environment and its suns are left out, as glTF has no place for them.
[[nodiscard]] Result<std::string> glb_of(const GlbContent& content);

/// Writes a whole file.
[[nodiscard]] Result<void> write_file(const std::string& path, const void* data, std::size_t size);

}  // namespace halflit::test
