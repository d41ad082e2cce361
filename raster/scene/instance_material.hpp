// The material that an instance is drawn with.
#pragma once

#include "halflit/scene.hpp"

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

/// True if views look at it: it is seen, and does more than take shadow.
[[nodiscard]] inline bool counts_for_views(const Scene& scene, const Instance& instance) {
    return instance.visible && !catches_shadows(scene, instance);
}

}  // namespace halflit::raster
