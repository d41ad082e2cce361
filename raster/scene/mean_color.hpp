// Mean colours of textures and surfaces.
#pragma once

#include "halflit/scene.hpp"
#include "raster/scene/instance_material.hpp"
#include "sh/equirect.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>
#include <cstddef>

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

/// Luminance that an instance's surface sends to the eye where white light comes from all around: by its base colour, some of the colours
/// of its vertices, and what it emits. Requires: a mesh that the scene has.
[[nodiscard]] inline double mean_luminance(const Scene& scene, const Instance& instance) {
    constexpr std::size_t kMostVertices = 1024;
    constexpr double kMetal = 0.5;  ///< share of the light around that a metal mirrors to the eye, divided by what a white surface scatters
    const Material* const material = material_of(scene, instance);
    const std::vector<Vec4f>& colors = scene.meshes[static_cast<std::size_t>(instance.mesh)].colors;
    Vec3d of_vertices{1, 1, 1};
    if (!colors.empty()) {
        const std::size_t stride = colors.size() / kMostVertices + 1;
        Vec3d sum{};
        double count = 0;
        for (std::size_t i = 0; i < colors.size(); i += stride, count += 1) sum = sum + Vec3d{colors[i].x, colors[i].y, colors[i].z};
        of_vertices = sum * (1.0 / count);
    }
    const Vec3d color{of_vertices.x * instance.color.x, of_vertices.y * instance.color.y, of_vertices.z * instance.color.z};
    if (material == nullptr) return kMetal * sh::luminance(color);  // glTF's default: a rough metal
    const auto mean = [&](TextureSlot slot) { return mean_color(scene, material->textures[slot]); };
    const Vec3f base = mean(TextureSlot::base_color), own = mean(TextureSlot::emissive);
    const double metal = std::clamp(double{material->metallic} * double{mean(TextureSlot::metallic_roughness).z}, 0.0, 1.0);
    const double back = material->unlit ? 1.0 : 1.0 - (1.0 - kMetal) * metal, emits = material->unlit ? 0.0 : 1.0;
    const auto channel = [&](double vertex, float factor, float texture, float light, float of_light) {
        return back * vertex * double{factor} * double{texture} + emits * double{light} * double{of_light};
    };
    return sh::luminance(Vec3d{channel(color.x, material->base_color.x, base.x, material->emissive.x, own.x),
                               channel(color.y, material->base_color.y, base.y, material->emissive.y, own.y),
                               channel(color.z, material->base_color.z, base.z, material->emissive.z, own.z)});
}

}  // namespace halflit::raster
