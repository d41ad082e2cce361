// The table of the schema: the values that are read, their types, and where they go. Keys that are not in it are ignored.
#pragma once

#include "apps/io/gltf/file/schema.hpp"

#include <span>

namespace halflit::io::detail {

[[nodiscard]] std::span<const SchemaRow> schema_rows();
[[nodiscard]] std::span<const SchemaRow> texture_place_rows();  ///< places where a material names a texture
[[nodiscard]] std::span<const SchemaRow> texture_rows();        ///< values below each of these places

}  // namespace halflit::io::detail
