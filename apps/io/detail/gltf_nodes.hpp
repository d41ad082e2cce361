// The node graph: checked to be a forest, walked without recursion, placed in world space.
#pragma once

#include "apps/io/detail/gltf_document.hpp"
#include "apps/io/detail/gltf_transform.hpp"

#include <vector>

namespace halflit::io::detail {

struct NodeTree {
    std::vector<int> drawn;               ///< nodes of the scene, parents before children, in the file's order
    std::vector<Affine> world_from_node;  ///< transforms of all nodes of the file
};

/// Places all nodes. Those of the default scene are drawn; without one those of the first scene, and all nodes if the file has no scenes.
/// Throws LoadFailure for a cycle or a node with two parents.
NodeTree place_nodes(const Document& document);

}  // namespace halflit::io::detail
