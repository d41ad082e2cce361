// Textures: four 16-bit unsigned normalised channels (RGBA), linear light, with a full mip chain. sRGB pictures are
// decoded once, when the texture is made, so that filtering is always done in linear light; 16 bits keep every
// 8-bit sRGB code within 0.03 code after encoding again.
#pragma once

#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/math.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace halflit {

enum class TextureWrap : std::uint8_t { repeat, mirror, clamp };
enum class TextureFilter : std::uint8_t { nearest, linear };
enum class MipFilter : std::uint8_t { none, nearest, linear };
enum class ColorSpace : std::uint8_t { srgb, linear };

struct Sampler {
    TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;
    TextureFilter mag = TextureFilter::linear, min = TextureFilter::linear;
    MipFilter mip = MipFilter::linear;
    friend bool operator==(const Sampler&, const Sampler&) = default;
};

struct TextureLevel {
    std::int32_t width = 0, height = 0;  ///< texels, >= 1
    std::int32_t offset = 0;             ///< position of texel (0, 0) in the data, in texels
};

inline constexpr int kMaxTextureLevels = 16;
inline constexpr int kMaxTextureSide = 16384;

/// Range of a texture's channels over all levels, in units of 1 / 65535, for bounds on the error of filtering.
struct TextureRange {
    std::uint16_t least[4], most[4];
    std::uint16_t step[4];  ///< the largest difference between neighbours in a row or a column, those across opposite edges included
};

/// Texel (x, y) of level l is at data()[4 * (offset + y * width + x)], row 0 on top (v = 0), channel order RGBA.
class Texture {
public:
    /// `rgba8`: width * height * 4 bytes, row 0 on top. Alpha is always linear. Sides up to kMaxTextureSide.
    [[nodiscard]] HALFLIT_API static Result<Texture> from_rgba8(std::span<const std::uint8_t> rgba8, int width, int height,
                                                                ColorSpace space);
    /// The same from 16-bit channels, taken as they are (linear).
    [[nodiscard]] HALFLIT_API static Result<Texture> from_rgba16(std::span<const std::uint16_t> rgba16, int width, int height);

    [[nodiscard]] int width() const { return levels_.empty() ? 0 : levels_[0].width; }
    [[nodiscard]] int height() const { return levels_.empty() ? 0 : levels_[0].height; }
    [[nodiscard]] std::span<const TextureLevel> levels() const { return levels_; }
    [[nodiscard]] std::span<const std::uint16_t> data() const { return data_; }
    [[nodiscard]] const TextureRange& range() const { return range_; }

private:
    template <class ReadTexel>
    static Result<Texture> make(int width, int height, ReadTexel read_texel);

    std::vector<TextureLevel> levels_;
    std::vector<std::uint16_t> data_;
    TextureRange range_{};
};

/// A material's use of a texture: the texture, its sampler and the coordinates.
struct TextureUse {
    int texture = -1;  ///< index into Scene::textures; -1: not used
    int uv_set = 0;    ///< 0 or 1
    Sampler sampler;
    /// uv' = (row_u.x u + row_u.y v + row_u.z, row_v.x u + row_v.y v + row_v.z): KHR_texture_transform as a matrix.
    Vec3f row_u{1, 0, 0}, row_v{0, 1, 0};
    [[nodiscard]] bool used() const { return texture >= 0; }
};

}  // namespace halflit
