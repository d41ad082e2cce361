// Which instances only take shadow.
#pragma once

#include "halflit/scene.hpp"

namespace halflit::raster {

/// True if the instance's material is a shadow catcher. Its mesh may be an index that the scene does not have.
[[nodiscard]] inline bool catches_shadows(const Scene& scene, const Instance& instance) {
    if (instance.mesh < 0 || static_cast<std::size_t>(instance.mesh) >= scene.meshes.size()) return false;
    const int material = scene.meshes[static_cast<std::size_t>(instance.mesh)].material;
    return material >= 0 && static_cast<std::size_t>(material) < scene.materials.size() &&
           scene.materials[static_cast<std::size_t>(material)].shadow_catcher;
}

}  // namespace halflit::raster
