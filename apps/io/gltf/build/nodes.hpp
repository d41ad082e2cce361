// The node graph: checked to be a forest, walked without recursion, placed in world space.
#pragma once

#include "apps/io/gltf/file/document.hpp"
#include "apps/io/gltf/file/transform.hpp"

#include <vector>

namespace halflit::io::detail {

struct NodeTree {
    std::vector<int> parent;              ///< of all nodes of the file; -1: none
    std::vector<int> order;               ///< all nodes, parents before children
    std::vector<int> drawn;               ///< nodes of the scene, parents before children, in the file's order
    std::vector<Affine> world_from_node;  ///< transforms of all nodes of the file
    std::vector<bool> hidden;             ///< by KHR_node_visibility, of the node or one above it; empty: none
};

/// Finds parents and order. The nodes of the default scene are drawn; without one those of the first scene, and all nodes if the file has
/// no scenes. Where that scene has no mesh, and none was asked for: another one that has, or all nodes; meshes that no node has get nodes
/// behind those of the file. By the strict rules the file's scene is drawn, and LoadFailure thrown for a cycle or a node with two parents.
NodeTree walk_nodes(Document& document);

/// Fills in the transforms and the hidden nodes.
void place_nodes(const file::File& file, NodeTree& tree);
/// Marks all below a marked node too. `marks` is empty or has an entry for each node.
void mark_below(const NodeTree& tree, std::vector<bool>& marks);

/// All nodes of the file, as a host poses them. They place nothing yet.
std::vector<Node> make_nodes(Document& document, const NodeTree& tree);

}  // namespace halflit::io::detail
