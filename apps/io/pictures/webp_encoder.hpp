// Lossless WebP, by libwebp.
#pragma once

#include "halflit/image.hpp"

#include <cstdint>
#include <vector>

namespace halflit::io {

/// The picture's rgba8. The bytes depend on the pixels and on the version of libwebp alone. Throws std::bad_alloc. Fails (usage) in a build
/// without libwebp.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_webp(const Image& image);

}  // namespace halflit::io
