// The world that a scene is drawn in: the file's own, or one in which float32 keeps the scene's shape.
#pragma once

#include "apps/io/detail/gltf_document.hpp"
#include "apps/io/detail/gltf_nodes.hpp"

namespace halflit::io::detail {

/// If LoadOptions::recentre asks for it and the scene needs it: moves and scales the scene's instances and meshes, and the transforms of
/// `tree`, which place cameras and lights afterwards. Sets LoadedScene::origin and scale, and warns.
void recentre(Document& document, NodeTree& tree, LoadedScene& loaded);

}  // namespace halflit::io::detail
