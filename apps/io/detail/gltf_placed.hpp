// Cameras and lights, placed by the nodes.
#pragma once

#include "apps/io/detail/gltf_nodes.hpp"
#include "halflit/scene.hpp"

namespace halflit::io::detail {

/// Add cameras and lights in the order of the drawn nodes, and their indices to the nodes. One with invalid values is left out with a
/// warning.
void place_cameras(Document& document, const NodeTree& tree, LoadedScene& loaded);
void place_lights(Document& document, const NodeTree& tree, LoadedScene& loaded);

/// The node's place and its view direction (-z), with scale, shear and mirroring taken out: z is kept, y is made orthogonal to it.
[[nodiscard]] Mat4 rigid_part(const Affine& world);
/// Sets a light's position and direction.
void place(const Affine& world, Light& light);

}  // namespace halflit::io::detail
