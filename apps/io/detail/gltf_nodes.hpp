// The node graph: checked to be a forest, walked without recursion, placed in world space.
#pragma once

#include "apps/io/detail/gltf_document.hpp"
#include "apps/io/detail/gltf_transform.hpp"

#include <vector>

namespace halflit::io::detail {

struct NodeTree {
    std::vector<int> parent;              ///< of all nodes of the file; -1: none
    std::vector<int> drawn;               ///< nodes of the scene, parents before children, in the file's order
    std::vector<Affine> world_from_node;  ///< transforms of all nodes of the file
};

/// Places all nodes. Those of the default scene are drawn; without one those of the first scene, and all nodes if the file has no scenes.
/// Throws LoadFailure for a cycle or a node with two parents.
NodeTree place_nodes(Document& document);

/// All nodes of the file, as a host poses them. They place nothing yet.
std::vector<Node> make_nodes(Document& document, const NodeTree& tree);

}  // namespace halflit::io::detail
