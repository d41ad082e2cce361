// Meshes and their instances: each mesh of the drawn nodes is made once, completed for its material, and placed by its nodes.
#pragma once

#include "apps/io/gltf/build/nodes.hpp"
#include "apps/io/gltf/build/pose_sources.hpp"
#include "apps/io/gltf/build/primitive.hpp"
#include "halflit/scene.hpp"

#include <vector>

namespace halflit::io::detail {

/// One flag for each material of the file: true if a drawn primitive has it.
std::vector<bool> find_used_materials(const Document& document, const NodeTree& tree);

/// Fills the scene's meshes and instances, and adds the instances to the nodes. Requires materials and nodes. kept: gets what is needed to
/// pose the meshes again; may be null. Throws LoadFailure.
void place_meshes(Document& document, const std::vector<Accessor>& accessors, const NodeTree& tree, LoadedScene& loaded, PoseSources* kept);

}  // namespace halflit::io::detail
