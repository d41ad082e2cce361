// SPZ, a format of 3D Gaussians: versions 1 to 4.
#pragma once

#include "apps/io/gltf/codecs/splat_cloud.hpp"

#include <cstddef>
#include <optional>
#include <span>

namespace halflit::io::detail {

/// Nothing: the bytes are no SPZ file, or one in gzip that is damaged or cut off. Throws LoadFailure.
[[nodiscard]] std::optional<SplatCloud> read_spz(std::span<const std::byte> file, Document& document);

}  // namespace halflit::io::detail
