// Cameras and lights, placed by the nodes.
#pragma once

#include "apps/io/detail/gltf_nodes.hpp"
#include "halflit/scene.hpp"

namespace halflit::io::detail {

/// Add cameras and lights in the order of the drawn nodes. One with invalid values is left out with a warning.
void place_cameras(Document& document, const NodeTree& tree, Scene& scene);
void place_lights(Document& document, const NodeTree& tree, Scene& scene);

}  // namespace halflit::io::detail
