// A node's transform to its parent, from its matrix or its translation, rotation and scale.
#pragma once

#include "apps/io/gltf/file/file.hpp"

namespace halflit::io::detail {

/// The matrix if there is one, otherwise T R S. Quaternions are normalised; one of length zero means no rotation.
[[nodiscard]] Affine node_transform(const file::Transform& transform);
/// Transform of a node of the file; the identity if it has none.
[[nodiscard]] Affine local_transform(const file::File& file, std::size_t node);

}  // namespace halflit::io::detail
