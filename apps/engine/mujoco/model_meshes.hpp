// The meshes of a model: primitives, the grids of its planes, meshes and their convex hulls, height fields, skins and flexes.
#pragma once

#include "apps/engine/mujoco/model.hpp"
#include "apps/engine/mujoco/shapes.hpp"
#include "halflit/fixed_function.hpp"

#include <vector>

namespace halflit::engine::mujoco {

/// Vertices of the scene's arrays that a mesh has, and which it gets anew for each picture.
struct SoftMesh {
    std::int64_t first = 0, count = 0;
};

/// Meshes in this order: those of Shape; one for each grid of planes; two for each mesh, the second one its hull; height fields; skins;
/// flexes. Numbers are indices of the first of a kind.
struct ModelMeshes {
    std::vector<Mesh> meshes;
    std::vector<int> planes;  ///< of each plane of the model, its mesh
    int models = 0, hfields = 0, skins = 0, flexes = 0, end = 0;
    std::vector<SoftMesh> soft;  ///< skins, then flexes, whose `first` counts triangles
};

/// shapes_have_uv: shapes get texture coordinates if the model has a flat texture. Fails (bad_input) for an index out of range, (limit) for
/// too many vertices. Requires: check_model() passed.
[[nodiscard]] Result<ModelMeshes> make_meshes(const Model& model, bool shapes_have_uv = false);

/// Fails (bad_input) for a texture beyond the model's bytes, (limit) for a side above 16384, or more
/// than 2^27 texels in all.
[[nodiscard]] Result<std::vector<CodeTexture>> make_textures(const Model& model, const Look& look);

}  // namespace halflit::engine::mujoco
