// Primitives of KHR_draco_mesh_compression: their accessors are replaced by decoded ones.
#pragma once

#include "apps/io/gltf/file/document.hpp"

#include <cstdint>

namespace halflit::io::detail {

/// Bytes of the streams that the drawn meshes use.
[[nodiscard]] std::uint64_t draco_bytes(const Document& document);

/// Decodes the streams of the meshes that are drawn, each once, and appends an accessor and a bufferView for each attribute and list of
/// indices; the primitives refer to these then, and are lists of triangles. Throws LoadFailure for damaged streams, for counts that differ
/// from the accessors', and (limit) above the geometry's limit, before memory is taken.
void decode_draco(Document& document);

}  // namespace halflit::io::detail
