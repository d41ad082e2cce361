// Checks of the values of vertex attributes, which cost one pass over each.
#pragma once

#include "apps/io/gltf/file/document.hpp"
#include "halflit/mesh.hpp"

#include <string>

namespace halflit::io::detail {

/// Warns of values that are not finite, and of normals and tangents that are not of length 1. `list` is the path of the attributes.
void warn_of_values(Document& document, const std::string& list, const Mesh& mesh);

/// Makes directions of length 0 what they should be, with a warning: normals and tangents of which most are 0 are left out, so that they
/// are made anew; of others, those normals become the mean of their triangles'. The strict
/// rules leave them as they are.
void mend_zero_directions(Document& document, const std::string& list, Mesh& mesh);

}  // namespace halflit::io::detail
