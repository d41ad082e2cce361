// The table of the schema: which values are read, of what type, and where they go. Keys that are not here are not looked at.
#pragma once

#include "apps/io/detail/gltf_schema.hpp"

#include <span>

namespace halflit::io::detail {

[[nodiscard]] std::span<const SchemaRow> schema_rows();
[[nodiscard]] std::span<const SchemaRow> texture_place_rows();  ///< where a material names a texture
[[nodiscard]] std::span<const SchemaRow> texture_rows();        ///< below each of these places

}  // namespace halflit::io::detail
