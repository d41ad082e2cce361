// A node's local transform, from its matrix or its translation, rotation and scale.
#pragma once

#include "apps/io/detail/gltf_transform.hpp"

#include <span>

namespace halflit::io::detail {

/// Each list is complete (16, 3, 4 and 3 numbers) or empty. A matrix, column by column, is taken alone; otherwise the transform is T R S.
/// Quaternions are normalised; one of length zero means no rotation.
[[nodiscard]] Affine node_transform(std::span<const double> matrix, std::span<const double> translation, std::span<const double> rotation,
                                    std::span<const double> scale);

}  // namespace halflit::io::detail
