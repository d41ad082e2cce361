// How much of the light that passes the points of a lattice the scene's triangles there hide, by direction. The lattice lies in the scene's
// box: its spacing is a share of the box's longest side, so the unit of length does not matter.
//
// The areas of triangles, cut into pieces smaller than the spacing, are shared out to the eight points around each piece by linear
// weights. So what is hidden is a continuous function of where things lie. A piece of a single-sided triangle counts half a spacing behind
// its front: that front is not hidden by itself.
//
// It depends on the geometry, and on the opacity and the sides of materials, so pictures of a scene that stands still share it.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "raster/scene/prepared_data.hpp"
#include "sh/vec3d.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace halflit::raster {

/// Most points on a side of the lattice, and spacings from the scene's box to the lattice's border.
inline constexpr int kMostCoverPoints = 28;
static_assert(kMostCoverPoints <= kCoverPitch);
inline constexpr float kCoverMargin = 1.5f;

/// Covers of the points of a lattice. The share of the light from a direction d that is hidden at a point is a sum over the axes, held at
/// 1: max(0, facing.d) + back max(0, -facing.d) + both.|d|. Kernels read it as rows of each number.
struct LatticeCovers {
    CoverLayout layout;
    /// facing: the triangles' area vector, by their fronts, over the square of the spacing; both: the areas across each axis that face
    /// both ways, the lesser of the two; back: the share of double-sided triangles.
    std::vector<float> parts[kCoverParts];
    std::vector<std::uint8_t> filled;  ///< of each row: not 0 if some cover is not 0
};

/// A rectangle around the part of a scene that it stands on, spacings from the lattice's first point; empty while low > high.
struct Foot {
    float low[2] = {1e9f, 1e9f}, high[2] = {-1e9f, -1e9f};  ///< along x and z
    [[nodiscard]] bool empty() const { return low[0] > high[0]; }
};

struct CoverGrid {
    std::optional<SceneRevision> revision;  ///< of the scene, without that of its lights; none: nothing is made yet
    int size[3] = {0, 0, 0};                ///< points; 0: the scene has no size, or one that no lattice can have, or hides nothing
    double origin[3] = {0, 0, 0};           ///< the first point, world space
    double per_length = 0;                  ///< points in a world unit
    double width[3] = {0, 0, 0};            ///< sides of the scene's box, spacings
    double lowest = 0;                      ///< the scene's least y, world space
    LatticeCovers along_x, along_y;         ///< rows along x in layers of z, and along y in layers of x
    Foot foot;                              ///< all that lies a little above the lowest point; empty: that is a large ground
    double middle[2] = {0, 0};              ///< mean place of what hides, along x and z, spacings from the first point

    [[nodiscard]] bool empty() const { return size[0] == 0; }
};

/// Makes the grid unless it is this scene's already.
void make_cover_grid(const PreparedData& scene, CoverGrid& grid);

}  // namespace halflit::raster
