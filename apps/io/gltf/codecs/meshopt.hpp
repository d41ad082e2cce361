// bufferViews of EXT_meshopt_compression and KHR_meshopt_compression, decoded by the library meshoptimizer. It is optional: a build
// without it reads the views without compression, and refuses by name a file that requires the extension.
#pragma once

#include "apps/io/gltf/file/document.hpp"

#include <cstdint>

namespace halflit::io::detail {

/// Bytes of the compressed data that the drawn nodes use.
[[nodiscard]] std::uint64_t compressed_bytes(const Document& document);

/// Decodes the bufferViews that are used and compressed. Requires: the buffers are there. Throws LoadFailure for wrong sizes and damaged
/// data, and (limit) where the decoded bytes exceed the geometry's limit, before memory is taken.
void decode_views(Document& document);

}  // namespace halflit::io::detail
