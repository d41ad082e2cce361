// Skinned meshes, drawn in the pose that the nodes give: each vertex is moved by its joints, once, while loading.
#pragma once

#include "apps/io/detail/gltf_nodes.hpp"
#include "apps/io/detail/gltf_primitive.hpp"

#include <optional>

namespace halflit::io::detail {

/// Moves a mesh by `skin` into world space (glTF ignores the transform of the mesh's own node). Returns the point of the world at which the
/// mesh is to be placed, which floats hold exactly: the origin, or, with LoadOptions::recentre, the middle of a mesh that is far from it.
/// Returns nothing, and leaves the mesh as it is, if it has no joints. Throws LoadFailure.
std::optional<Vec3d> apply_skin(Document& document, const std::vector<Accessor>& accessors, PrimitiveReader& reader, const NodeTree& tree,
                                int skin, const file::Primitive& primitive, ReadMesh& read);

}  // namespace halflit::io::detail
