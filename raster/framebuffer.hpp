// Pixels that the caller owns.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace halflit::raster {

/// Row 0 is the top row. Either pointer may be null: that output is not made.
struct FramebufferView {
    int width = 0, height = 0;      ///< pixels, of the whole picture
    std::uint8_t* rgba8 = nullptr;  ///< sRGB codes, alpha linear and not premultiplied; width * height * 4
    float* rgba_linear = nullptr;   ///< linear light after exposure, alpha not premultiplied; width * height * 4, 16-byte aligned
};

/// A picture with its own memory.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba8;
    std::vector<float> rgba_linear;
};

/// 64-bit hash of the bytes: the picture's identity in reports and golden tables. XXH64 with seed 0, the same on every machine.
[[nodiscard]] std::uint64_t pixel_hash(std::span<const std::uint8_t> bytes);

}  // namespace halflit::raster
