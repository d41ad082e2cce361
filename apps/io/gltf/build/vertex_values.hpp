// Checks of the values of vertex attributes, which cost one pass over each.
#pragma once

#include "apps/io/gltf/file/document.hpp"
#include "halflit/mesh.hpp"

#include <string>
#include <vector>

namespace halflit::io::detail {

/// Warns of normals and tangents that are not of length 1, and mends what is not finite: such a vertex has texture coordinates of 0, the
/// colour white, and normals and tangents as below. The triangles of its position are not drawn. `list` is the path of the attributes.
/// By the strict rules throws LoadFailure.
void mend_values(Document& document, const std::string& list, Mesh& mesh);

/// Makes differences 0 that are not finite.
template <class T>
void mend_deltas(Document& document, const std::string& list, const char* name, std::vector<T>& values);

/// Makes directions of length 0, and those that are not finite, what they should be, with a warning: normals and tangents of which most are
/// so are left out, so that they are made anew; others become the mean of their triangles'. The strict rules leave those of length 0.
void mend_directions(Document& document, const std::string& list, Mesh& mesh);

}  // namespace halflit::io::detail
