// The world that a scene is drawn in: the file's own, or one in which float32 keeps the scene's shape.
#pragma once

#include "apps/io/gltf/build/nodes.hpp"
#include "apps/io/gltf/file/document.hpp"
#include "halflit/mesh.hpp"

#include <span>
#include <vector>

namespace halflit::io::detail {

/// Turns the scene by `up`, and, if LoadOptions::recentre asks for it and the scene needs it, moves and scales it: its instances and
/// meshes, and the transforms of `tree`, which place cameras and lights afterwards. Sets LoadedScene::placement, and warns.
void place_scene(Document& document, UpAxis up, NodeTree& tree, LoadedScene& loaded);

/// World of the file to that of the drawn scene.
[[nodiscard]] Affine drawn(const Affine& world, const Placement& placement);
/// Transform of an instance of a mesh whose positions were multiplied by mesh_scales[mesh]; empty: none were.
[[nodiscard]] Affine in_scaled_mesh(Affine m, std::span<const double> mesh_scales, int mesh);
/// Makes the vertices not finite that lie more than 2^40 times farther from the origin than the mesh's median vertex, if they are few:
/// no scale of the scene keeps both within float32. Their triangles are not drawn. Returns their number.
std::size_t leave_out_strays(Mesh& mesh);

}  // namespace halflit::io::detail
