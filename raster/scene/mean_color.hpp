// Mean colour of a texture.
#pragma once

#include "halflit/scene.hpp"

namespace halflit::raster {

/// Linear colour of the texture's smallest level; white without a texture.
[[nodiscard]] inline Vec3f mean_color(const Scene& scene, const TextureUse& use) {
    if (!use.used() || static_cast<std::size_t>(use.texture) >= scene.textures.size()) return {1, 1, 1};
    const Texture& texture = scene.textures[static_cast<std::size_t>(use.texture)];
    if (texture.levels().empty()) return {1, 1, 1};
    const std::size_t at = 4 * static_cast<std::size_t>(texture.levels().back().offset);
    const auto channel = [&](std::size_t c) { return static_cast<float>(texture.data()[at + c]) / 65535.0f; };
    return {channel(0), channel(1), channel(2)};
}

}  // namespace halflit::raster
