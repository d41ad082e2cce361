// Skinned meshes, drawn in the pose that the nodes give: each vertex is moved by its joints, once, while loading.
#pragma once

#include "apps/io/detail/gltf_nodes.hpp"
#include "apps/io/detail/gltf_primitive.hpp"

namespace halflit::io::detail {

/// Moves a mesh by `skin`; the result lies in world space (glTF ignores the transform of the mesh's own node). Returns false and leaves the
/// mesh as it is if it has no joints. Throws LoadFailure.
bool apply_skin(Document& document, const std::vector<Accessor>& accessors, PrimitiveReader& reader, const NodeTree& tree, int skin,
                const file::Primitive& primitive, ReadMesh& read);

}  // namespace halflit::io::detail
