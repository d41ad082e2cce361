// A node's own transform from what the file says of it.
#pragma once

#include "apps/io/detail/gltf_transform.hpp"

#include <span>

namespace halflit::io::detail {

/// Each list is whole (16, 3, 4 and 3 numbers) or empty. A matrix, column by column, stands alone; otherwise T R S. A rotation of any
/// length but zero is taken as its unit quaternion; zero means none.
[[nodiscard]] Affine node_transform(std::span<const double> matrix, std::span<const double> translation, std::span<const double> rotation,
                                    std::span<const double> scale);

}  // namespace halflit::io::detail
