// What nodes place besides meshes: cameras and lights.
#pragma once

#include "apps/io/detail/gltf_nodes.hpp"
#include "raster/scene/scene.hpp"

namespace halflit::io::detail {

/// In the order of the drawn nodes. A camera or light that makes no sense is left out with a warning.
void place_cameras(Document& document, const NodeTree& tree, raster::Scene& scene);
void place_lights(Document& document, const NodeTree& tree, raster::Scene& scene);

}  // namespace halflit::io::detail
