// What a geom is drawn with: meshes, and a material.
#pragma once

#include "apps/engine/mujoco/model_meshes.hpp"
#include "apps/engine/mujoco/scene_reader.hpp"

#include <vector>

namespace halflit::engine::mujoco {

/// A mesh of a geom, scaled, then moved along the geom's z axis.
struct Part {
    int mesh = 0;
    Vec3f scale{1, 1, 1};
    float shift = 0;
    bool mirrors = false;
};

/// Fails (bad_input) for a mesh that is not there.
[[nodiscard]] Result<void> check_geom(const Geom& geom, int index, const ModelMeshes& numbers);

/// The meshes of a geom, whose indices are in range; empty for types that are not drawn. mirrors: it is the mirror.
[[nodiscard]] std::vector<Part> parts_of(const Geom& geom, const ModelMeshes& numbers, const Scene& scene, bool mirrors);

/// cubes: of each texture of the model, whether it is a cube. shapes_have_uv: Look::shapes_have_uv. behind: the geom is a plane that is
/// seen from behind.
[[nodiscard]] FixedMaterial material_of(const Geom& geom, const std::vector<bool>& cubes, bool shapes_have_uv, bool behind);

}  // namespace halflit::engine::mujoco
