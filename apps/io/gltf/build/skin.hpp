// Skins: joints and weights of the vertices, and the joints' inverse bind matrices.
#pragma once

#include "apps/io/gltf/build/deform.hpp"
#include "apps/io/gltf/build/primitive.hpp"

namespace halflit::io::detail {

/// Throws LoadFailure.
Skin read_skin(Document& document, const std::vector<Accessor>& accessors, int index);

/// Reads the influences of all sets (JOINTS_0 and WEIGHTS_0, JOINTS_1 and WEIGHTS_1, ...). Returns false, and leaves the mesh as it is, if
/// it has none. Throws LoadFailure.
bool read_influences(Document& document, const std::vector<Accessor>& accessors, PrimitiveReader& reader, int skin,
                     const file::Primitive& primitive, ReadMesh& read);

}  // namespace halflit::io::detail
