// Decoding of every picture format that image.hpp writes: PNG, JPEG, BMP, TGA, HDR, PFM and EXR. For comparing pictures; models may use PNG
// and JPEG only (image_reader.hpp).
#pragma once

#include "apps/io/pictures/image_reader.hpp"
#include "halflit/error.hpp"
#include "halflit/target.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace halflit::io {

/// The formats by their first bytes: PNG, JPEG, "BM" for BMP, and the three of float_image.hpp. TGA has none that are its own, so it is
/// told by the extension .tga of `name`. BMP: 24 bits, or 32 bits with the masks of image.hpp's files. TGA: grey of 8 bits, colour of 24 or
/// 32, plain or with run lengths. HDR, PFM and EXR become 8-bit codes by the sRGB curve; light above 1 is 255. Formats without alpha are
/// opaque. Errors: bad_input for other formats and broken or cut-off files, limit above `limits`, which is checked on the header. Messages
/// have no file prefix.
[[nodiscard]] Result<Image> decode_picture(std::span<const std::byte> file, std::string_view name, const ImageLimits& limits = {});

/// Reads and decodes a file; messages begin with its path.
[[nodiscard]] Result<Image> read_picture(const std::string& path);

/// True for a name with an extension that output_format_of() knows, and for .jpeg.
[[nodiscard]] bool is_picture_name(std::string_view name);

}  // namespace halflit::io
