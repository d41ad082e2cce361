// Memory that a picture is drawn into. The caller owns it.
#pragma once

#include "halflit/export.hpp"

#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <vector>

namespace halflit {

/// Order of the four bytes of a pixel in Target::pixels.
enum class PixelFormat : std::uint8_t { rgba8, bgra8 };

/// A part of a model's edge that a picture with Settings::edges shows, from end to end. Pixels, x right and y down; (0, 0) is the upper
/// left corner of the whole picture.
struct DrawnEdge {
    double x0 = 0;        ///< one end
    double y0 = 0;        ///< likewise
    double x1 = 0;        ///< the other end
    double y1 = 0;        ///< likewise
    bool hidden = false;  ///< a surface lies before it
};

/// The caller's memory for a picture: 8-bit codes, linear light before the tone curve, or both, and planes of what was seen. A null
/// pointer: that output is not made; where neither codes nor light are, nothing is shaded and no shadow map is drawn. Row 0 is the top row.
/// The row at y begins at the pointer plus y times the stride in bytes. A stride may be larger than a row, for padding; what lies between
/// rows is not touched. A stride of 0 means that rows follow one another. Strides are at most 2^31 - 1, and never negative.
struct Target {
    int width = 0, height = 0;       ///< pixels, of the whole picture: what the camera sees
    std::uint8_t* pixels = nullptr;  ///< sRGB codes, four bytes a pixel in the order of `format`; alpha by Settings::alpha
    float* linear = nullptr;         ///< linear light after exposure, four floats (RGBA) a pixel; aligned to 4 bytes, stride too

    PixelFormat format = PixelFormat::rgba8;  ///< of `pixels`
    /// Colour is multiplied by alpha, in both outputs: a code becomes (code * alpha + 127) / 255, without the fraction.
    bool premultiplied = false;
    /// The memory holds Settings::region alone: its first row is the region's first row. Otherwise it holds the whole picture, of which the
    /// pixels outside the region are not touched.
    bool region_alone = false;
    std::size_t row_bytes = 0, linear_row_bytes = 0;  ///< strides of `pixels` and `linear`

    /// Planes of each pixel's first sample; blended surfaces and the background do not count. Aligned to 4 bytes.
    float* depth =
        nullptr;  ///< distance along the view axis, world units; of lines, which lie before their surfaces, less; infinity: nothing
    /// Three floats: the vertices' normals in world space, interpolated and of unit length; on the back of a double-sided material turned
    /// around. Normal maps do not count. 0 where nothing is, or where the mesh has no normals.
    float* normal = nullptr;
    std::uint32_t* instance = nullptr;  ///< index into Scene::instances, plus 1; 0 where nothing is
    std::uint32_t* triangle = nullptr;  ///< number of the triangle, line or point in its mesh, plus 1; 0: nothing
    std::size_t depth_row_bytes = 0, normal_row_bytes = 0, instance_row_bytes = 0, triangle_row_bytes = 0;  ///< strides of these planes

    /// The triangle that the first sample shows, at the point where it is shaded: the pixel's centre, or a point of the triangle beside it
    /// where the triangle does not hold the centre. In these planes all values are 0 where nothing is. Reading a material's textures for
    /// them takes about as long as for shading.
    float* shading_normal = nullptr;  ///< three floats: the unit normal that light falls on, world space; of lit materials with normal maps
    float* albedo = nullptr;          ///< three floats: base colour, linear: factor times texture times vertex colour; metals' too
    float* position = nullptr;        ///< three floats: world space
    /// Lights that reach the point: those of Scene::lights whose range and cone it is in. Neither its normal nor shadows count. 0 on unlit
    /// materials. With an error budget, also without lights that are left out there for their distance.
    std::uint32_t* lights = nullptr;
    float* coverage = nullptr;  ///< samples that an opaque or masked surface covers, as a share of the pixel's; of all samples
    std::size_t shading_normal_row_bytes = 0, albedo_row_bytes = 0, position_row_bytes = 0;  ///< strides of these planes
    std::size_t lights_row_bytes = 0, coverage_row_bytes = 0;                                ///< strides of these planes

    /// The same point as above, by its place in the triangle and in the texture. Both are computed in float64, and each float is rounded
    /// once. Corners are where the picture has them, in whole 1/256 pixels.
    /// Two floats: weights of the triangle's second and third corner, perspective-correct, 0 to 1; that of the first is 1 minus both, which
    /// may be below 0 by 2^-24. Of a line the weight of its second end, and 0; of a point 0.
    float* barycentric = nullptr;
    float* uv = nullptr;  ///< two floats: Mesh::uv0 by these weights, before a texture's own transform; 0 where the mesh has none
    std::size_t barycentric_row_bytes = 0, uv_row_bytes = 0;  ///< strides of these planes

    /// Edges that lie in the pixels that are drawn are appended, where `pixels` or `linear` shows them too (Settings::edges).
    std::vector<DrawnEdge>* edges = nullptr;
};

/// Width and height of a picture in pixels.
struct PictureSize {
    int width = 0;   ///< pixels
    int height = 0;  ///< pixels
    friend bool operator==(const PictureSize&, const PictureSize&) = default;
};

/// A picture with its own memory. Either array may be empty.
struct Image {
    int width = 0, height = 0;        ///< pixels
    std::vector<std::uint8_t> rgba8;  ///< width * height * 4 sRGB codes, alpha by Settings::alpha and not premultiplied
    std::vector<float> rgba_linear;   ///< width * height * 4, linear light, alpha not premultiplied

    /// A picture with rgba8, of transparent black. Sides below 0 count as 0. Throws std::bad_alloc if memory lacks.
    [[nodiscard]] static Image make(int width, int height) {
        if (width < 0) width = 0;
        if (height < 0) height = 0;
        const std::uint64_t bytes = std::uint64_t{4} * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
        if (bytes > SIZE_MAX / 2) throw std::bad_alloc();
        return {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(bytes)), {}};
    }
    /// The same.
    [[nodiscard]] static Image make(PictureSize size) { return make(size.width, size.height); }
    /// A target that draws into the arrays that are not empty. Valid until they are resized.
    [[nodiscard]] Target target() {
        Target target{width, height, rgba8.empty() ? nullptr : rgba8.data()};
        target.linear = rgba_linear.empty() ? nullptr : rgba_linear.data();
        return target;
    }
};

/// 64-bit hash of the bytes: the picture's identity in reports and golden tables. XXH64 with seed 0, the same on every machine.
[[nodiscard]] HALFLIT_API std::uint64_t pixel_hash(std::span<const std::uint8_t> bytes);

}  // namespace halflit
