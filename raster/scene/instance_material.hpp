// The material that an instance is drawn with.
#pragma once

#include "halflit/scene.hpp"
#include "sh/mat4.hpp"

namespace halflit::raster {

/// Index of the instance's material: its own, or else its mesh's; -1: none. Its mesh may be an index that the scene does not have.
[[nodiscard]] inline int material_index(const Scene& scene, const Instance& instance) {
    if (instance.material >= 0) return instance.material;
    if (instance.mesh < 0 || static_cast<std::size_t>(instance.mesh) >= scene.meshes.size()) return -1;
    return scene.meshes[static_cast<std::size_t>(instance.mesh)].material;
}

/// Its material; null: none, or an index that the scene does not have.
[[nodiscard]] inline const Material* material_of(const Scene& scene, const Instance& instance) {
    const int index = material_index(scene, instance);
    return index >= 0 && static_cast<std::size_t>(index) < scene.materials.size() ? &scene.materials[static_cast<std::size_t>(index)]
                                                                                  : nullptr;
}

/// True if the instance only takes shadow.
[[nodiscard]] inline bool catches_shadows(const Scene& scene, const Instance& instance) {
    const Material* const material = material_of(scene, instance);
    return material != nullptr && material->shadow_catcher;
}

/// True if alpha hides all of it, whatever its texture. Vertex colours may raise alpha above the cutoff of a mask.
[[nodiscard]] inline bool is_clear(const Scene& scene, const Instance& instance) {
    const Material* const material = material_of(scene, instance);
    if (material == nullptr || material->alpha_mode == AlphaMode::opaque || material->transmits()) return false;
    const float alpha = material->base_color.w * instance.color.w;
    return alpha <= 0.0f && (material->alpha_mode == AlphaMode::blend || material->alpha_cutoff > 0.0f);
}

/// False if its matrix leaves nothing to see: triangles without area, lines without length. Points keep their size in the picture.
[[nodiscard]] inline bool has_extent(const Scene& scene, const Instance& instance) {
    if (instance.mesh < 0 || static_cast<std::size_t>(instance.mesh) >= scene.meshes.size()) return true;
    const Mat4& m = instance.world_from_object;
    const Topology topology = scene.meshes[static_cast<std::size_t>(instance.mesh)].topology;
    const Vec3d x = axis(m, 0), y = axis(m, 1), z = axis(m, 2), none{};
    if (topology == Topology::triangles) return !(cross(x, y) == none && cross(y, z) == none && cross(z, x) == none);
    return topology == Topology::points || !(x == none && y == none && z == none);
}

/// True if views look at it: it is seen, and does more than take shadow.
[[nodiscard]] inline bool counts_for_views(const Scene& scene, const Instance& instance) {
    return instance.visible && !catches_shadows(scene, instance) && !is_clear(scene, instance) && has_extent(scene, instance);
}

}  // namespace halflit::raster
