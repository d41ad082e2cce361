// The node graph: checked to be a forest, walked without recursion, placed in world space.
#pragma once

#include "apps/io/detail/gltf_document.hpp"
#include "apps/io/detail/gltf_transform.hpp"

#include <vector>

namespace halflit::io::detail {

struct NodeTree {
    std::vector<int> drawn;               ///< nodes of the scene, parents before children, in the file's order
    std::vector<Affine> world_from_node;  ///< of every node of the file
};

/// The default scene, or the first, or every node without a parent where the file has no scenes. Throws LoadFailure for a cycle, a
/// node with two parents, or a broken transform.
NodeTree place_nodes(const Document& document);

}  // namespace halflit::io::detail
