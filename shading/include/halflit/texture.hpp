// Textures: four 16-bit unsigned normalised channels (RGBA), linear light, with a full mip chain. sRGB pictures are
// decoded once, when the texture is made, so that filtering is always done in linear light; 16 bits keep every
// 8-bit sRGB code within 0.03 code after encoding again.
#pragma once

#include "halflit/error.hpp"
#include "halflit/export.hpp"
#include "halflit/math.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace halflit {

/// Texture outside the coordinates [0, 1]: repeated, repeated with every other copy mirrored, or its edge continued.
enum class TextureWrap : std::uint8_t { repeat, mirror, clamp };
/// Texels of a level that a look-up reads: the nearest, or the four around it, interpolated.
enum class TextureFilter : std::uint8_t { nearest, linear };
/// Levels that a look-up reads: the largest alone, the one nearest in size, or the two nearest, interpolated.
enum class MipFilter : std::uint8_t { none, nearest, linear };
/// Encoding of the 8-bit red, green and blue that a texture is made from.
enum class ColorSpace : std::uint8_t { srgb, linear };
/// How smaller levels are made from larger ones.
enum class MipRule : std::uint8_t {
    equal,  ///< each channel by itself; all texels count the same
    alpha,  ///< a texel's colour counts as its alpha, for materials that mask or blend: a colour that does not show reaches no edge
    normal  ///< a normal map: as equal, but alpha is replaced by what the mean of its normals lost, which makes a surface rougher
};

/// Rules by which a texture is read.
struct Sampler {
    TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;  ///< along u; along v
    TextureFilter mag = TextureFilter::linear, min = TextureFilter::linear;  ///< where texels are larger than pixels; smaller
    MipFilter mip = MipFilter::linear;                                       ///< where texels are smaller than pixels
    friend bool operator==(const Sampler&, const Sampler&) = default;
};

class MomentLevels;
namespace shading {
struct ShadeKernels;
}

/// One mip level, and its place in Texture::data().
struct TextureLevel {
    std::int32_t width = 0, height = 0;  ///< texels, >= 1
    std::int32_t offset = 0;             ///< position of texel (0, 0) in the data, in texels
};

/// No texture has more levels; a side of kMaxTextureSide has 15.
inline constexpr int kMaxTextureLevels = 16;
/// Largest width and height, texels.
inline constexpr int kMaxTextureSide = 16384;

/// Texel (x, y) of level l is at data()[4 * (offset + y * width + x)], row 0 on top (v = 0), channel order RGBA. Copies share their texels,
/// which do not change.
class Texture {
public:
    /// `rgba8`: width * height * 4 bytes, row 0 on top. Alpha is always linear. Sides up to kMaxTextureSide.
    [[nodiscard]] HALFLIT_API static Result<Texture> from_rgba8(std::span<const std::uint8_t> rgba8, int width, int height,
                                                                ColorSpace space, MipRule rule = MipRule::equal);
    /// The same from 16-bit channels, taken as they are (linear).
    [[nodiscard]] HALFLIT_API static Result<Texture> from_rgba16(std::span<const std::uint16_t> rgba16, int width, int height,
                                                                 MipRule rule = MipRule::equal);

    /// Texels of level 0; 0 for a texture without levels, made by the default constructor.
    [[nodiscard]] int width() const { return levels_.empty() ? 0 : levels_[0].width; }
    /// As width().
    [[nodiscard]] int height() const { return levels_.empty() ? 0 : levels_[0].height; }
    /// Full size first; each next level has half the sides, rounded down, to 1 x 1.
    [[nodiscard]] std::span<const TextureLevel> levels() const { return levels_; }
    /// All levels: four numbers a texel, linear, 65535 is 1.
    [[nodiscard]] std::span<const std::uint16_t> data() const { return levels_.empty() ? std::span<const std::uint16_t>() : data_; }
    /// As the texture was made.
    [[nodiscard]] MipRule rule() const { return rule_; }
    /// The least value of each channel, in units of 1 / 65535. Measured when it is first asked for. Thread-safe. The texture must have
    /// levels.
    [[nodiscard]] HALFLIT_API const std::array<std::uint16_t, 4>& least() const;

private:
    friend class TextureBuilder;
    struct Texels;

    MipRule rule_ = MipRule::equal;
    std::vector<TextureLevel> levels_;
    std::span<const std::uint16_t> data_;
    std::shared_ptr<Texels> texels_;
};

/// Makes a texture from its rows, top to bottom, without a copy of the picture: for decoders. Smaller levels are made as rows come.
class TextureBuilder {
public:
    /// Sides from 1 to kMaxTextureSide texels; others, and too little memory, are errors (limit). skip_levels: so many of the largest
    /// levels are left out, at most all but the smallest: the texture is that of the smaller picture, with the same texels, and the larger
    /// one is never held in memory. Rows are those of the full size.
    [[nodiscard]] HALFLIT_API static Result<TextureBuilder> make(int width, int height, MipRule rule = MipRule::equal, int skip_levels = 0);
    /// @{
    /// A builder that was moved from may only be destroyed, or assigned to.
    HALFLIT_API TextureBuilder(TextureBuilder&&) noexcept;
    HALFLIT_API TextureBuilder& operator=(TextureBuilder&&) noexcept;
    /// @}
    HALFLIT_API ~TextureBuilder();

    /// Adds the next row from `width` texels of four bytes. Alpha is always linear. Rows after the last one are ignored.
    HALFLIT_API void add_row(const std::uint8_t* rgba8, ColorSpace space);
    /// The same from four 16-bit channels a texel, taken as they are (linear).
    HALFLIT_API void add_row(const std::uint16_t* rgba16);
    /// The texture. Rows that were not added are as the last one that was, or 0 in all channels. A second call gives a texture without
    /// texels.
    [[nodiscard]] HALFLIT_API Texture finish();

private:
    static constexpr int kHeldRows = 4;  ///< of a level that is left out; a row of the next one reads up to three

    TextureBuilder();
    std::uint16_t* row(std::size_t level, int y);
    std::uint16_t* next_row();  ///< null: there is none
    void reduce(std::size_t level);

    Texture texture_;
    std::vector<TextureLevel> levels_;              ///< those left out, and the texture's
    std::vector<std::vector<std::uint16_t>> held_;  ///< the last rows of those left out
    std::vector<int> rows_;                         ///< of each level that are done
    const shading::ShadeKernels* kernels_ = nullptr;
    std::unique_ptr<MomentLevels> moments_;  ///< for rules other than equal
};

/// A material's use of a texture: the texture, its sampler and the coordinates.
struct TextureUse {
    int texture = -1;  ///< index into Scene::textures; -1: not used
    int uv_set = 0;    ///< 0 or 1
    Sampler sampler;   ///< filters, and what is outside [0, 1]
    /// uv' = (row_u.x u + row_u.y v + row_u.z, row_v.x u + row_v.y v + row_v.z): KHR_texture_transform as a matrix.
    Vec3f row_u{1, 0, 0};
    Vec3f row_v{0, 1, 0};  ///< see row_u
    /// True if there is a texture.
    [[nodiscard]] bool used() const { return texture >= 0; }
};

}  // namespace halflit
