// Checks of the values of vertex attributes, which cost one pass over each.
#pragma once

#include "apps/io/gltf/file/document.hpp"
#include "halflit/mesh.hpp"

#include <string>

namespace halflit::io::detail {

/// Warns of values that are not finite, and of normals and tangents that are not of length 1. `list` is the path of the attributes.
void warn_of_values(Document& document, const std::string& list, const Mesh& mesh);

}  // namespace halflit::io::detail
