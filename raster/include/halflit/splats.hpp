// 3D Gaussians: soft ellipsoids with an opacity and a colour that may change with the direction from which they are seen. A mesh of points
// whose Mesh::splats is set is made of them.
#pragma once

#include "halflit/math.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace halflit {

/// How a Gaussian becomes pixels: programs differ, and the picture with them. All clamp the slope of the projection at 1.3 times the
/// picture's sides, hold the alpha of a pixel at 0.99, and leave out what is nearer than 0.2.
enum class SplatReference : std::uint8_t {
    inria,     ///< [Kerbl23]: the variance in the picture grows by 0.3 square pixels; sorted by depth along the axis of the view
    inria_aa,  ///< the same, and the opacity falls by as much as the area grows, to a root of 2.5e-5 at least
    khr,       ///< KHR_gaussian_splatting: nothing grows; sorted by the distance from the eye
    mip        ///< Mip-Splatting: it grows by 0.1, and the opacity falls by as much as the area grows
};

/// Shapes and colours of a mesh's first positions, one of each for each of them; further positions are none. Colours are blended as the
/// file says: as codes of the display, or as linear light that is encoded afterwards. They need no light and cast no shadow. The planes of
/// a Target show them where they hide half of what is behind: depth is that of the splat by which they do, instance and triangle are of the
/// one that shows most (triangle: its number), coverage is their alpha, and planes of surfaces are 0.
struct Splats {
    std::vector<Vec4f> rotations{};  ///< quaternions x, y, z, w, of any length above 0
    std::vector<Vec3f> scales{};     ///< standard deviations along the three axes, object units
    std::vector<float> opacities{};  ///< 0 to 1
    int degree = 0;                  ///< of the spherical harmonics, 0 to 4
    std::vector<float> harmonics{};  ///< [splat][coefficient][channel], (degree + 1)^2 coefficients: colour = 0.5 + sum, not below 0
    SplatReference reference = SplatReference::inria;  ///< how they are drawn
    bool linear_light = false;                         ///< colours are linear light; false: sRGB codes / 255
};

/// Numbers of Splats::harmonics for each splat: (degree + 1)^2 coefficients of three channels.
[[nodiscard]] constexpr std::size_t harmonics_per_splat(int degree) { return static_cast<std::size_t>(3 * (degree + 1) * (degree + 1)); }

}  // namespace halflit
