// Shadow maps as the kernels read them.
#pragma once

#include "halflit/shading.hpp"
#include "sh/config.hpp"

#include <cstdint>

namespace halflit::shading {

/// Width of the border of a map, in texels, around the part that it must show. A receiver is looked up 3 texels off its surface, which are
/// up to 3 sqrt 2 at the edge of a cube's face, among texels up to 2 away. With a narrower border, look-ups at the rim are clamped to the
/// outline of the receiver's own object, which then hides itself.
inline constexpr int kShadowBorder = 7;

/// Least distance by which a receiver is moved off its surface, in texels at its depth, times the sine of the angle between the normal and
/// the map's axis.
inline constexpr float kLeastShadowOffset = 3.0f;

/// The distance that a map of this texel size needs, so that no plane that faces the light hides itself. The receiver is compared with
/// texels up to 2 away along u and v, at its own depth t. Such a point, off by d, is in front of the plane if offset + dot(normal, d) >= 0.
/// With |d| <= 2 sqrt 2 texels across the axis that is 2 sqrt 2 texels at depth t times the sine. Moving the receiver may take it farther
/// from the light, by up to the offset itself, and a perspective texel with it.
constexpr float shadow_offset(float texel_at_1) {
    constexpr float kReach = 2.8284272f;  // 2 sqrt 2
    const float needed = kReach / (1.0f - kReach * texel_at_1);
    return needed > kLeastShadowOffset ? needed : kLeastShadowOffset;
}

/// Shift of a receiver towards the light, against rounding errors: in texels, and as a share of the distance.
inline constexpr float kShadowDepthBias = 0.5f, kShadowRelativeBias = 4e-6f;

/// A filter as wide as a penumbra reads every 2^k-th texel, with k from 0 to this, and is three of these wide: 3 to 24 texels. The widest
/// one looks for blockers.
inline constexpr int kPenumbraLevels = 3;
/// The widest filter's texels once more, next to each other: rows of wide_side() of a map's size. Number i of a row, or of rows, is texel
/// wide_texel(i).
HALFLIT_INLINE constexpr int wide_side(int size) { return (size >> kPenumbraLevels) + 5; }
HALFLIT_INLINE constexpr int wide_texel(int i, int size) {
    const int at = ((i - 2) << kPenumbraLevels) + (1 << kPenumbraLevels) / 2;
    return at < 0 ? 0 : at < size ? at : size - 1;
}
/// Shift of a receiver towards the light for such a filter, in texels for each of those that it leaves out, times the tangent of the angle
/// between the normal and the map's axis, which is held below kSteepestPenumbra.
inline constexpr float kPenumbraBias = 2.0f, kSteepestPenumbra = 2.0f;

/// Maps of a directional light: cascades, from the finest to the one that shows all.
inline constexpr int kMostCascades = 4;

/// Distances from a light to the nearest surface. Texel (i, j) is at j * size + i; its centre is at (i + 0.5, j + 0.5).
struct ShadowMapPlan {
    enum class Kind : std::uint8_t { orthographic, perspective, cube };

    const float* distance = nullptr;  ///< world units along the map's axis, kNoBlocker where nothing is; a cube has six maps in a row
    const float* wide = nullptr;      ///< those of the widest filter, of maps with a penumbra
    std::int32_t size = 0;            ///< texels on a side
    Kind kind = Kind::orthographic;
    /// Rows applied to (x, y, z, 1) in world space. Orthographic: u, v in texels, and distance. Perspective: u and v times
    /// distance, and distance. Cube: unused.
    float rows[3][4] = {};
    float origin[3] = {};               ///< cube: the light
    float texel_size = 0;               ///< world units; perspective and cube: at distance 1
    float offset = kLeastShadowOffset;  ///< distance of receivers from their surface, texels: shadow_offset()
    /// Number of coarser maps of the same light that follow in the list, of the same size and kind, orthographic; their texels follow this
    /// map's, and so do those of the widest filter. A receiver is looked up in the first one that holds all that the filter reads.
    std::int32_t coarser = 0;
    float penumbra = 0;     ///< width of a penumbra over the distance from the blocker, orthographic; 0: all edges are sharp
    std::int32_t next = 0;  ///< number of maps from here to that of the light's next point; 0: there is none
};

inline constexpr float kNoBlocker = 3e38f;

/// Largest thickness of a body towards the light, as a share of d0. A sphere of radius R that turns away from the light, x = N.L < 0, is
/// 2 R |x| thick towards it. d0 is 2 w R over this share, so that the thickness is less than d0 wherever a lobe of wrap w leaves light,
/// |x| < w.
inline constexpr float kOwnThickness = 8.0f / 9.0f;

}  // namespace halflit::shading
