// How much of the light that passes the points of a lattice the scene's triangles there hide, by direction. The lattice lies in the scene's
// box: its spacing is a share of the box's longest side, so the unit of length does not matter.
//
// The areas of triangles, cut into pieces smaller than the spacing, are shared out to the eight points around each piece by linear
// weights. So what is hidden is a continuous function of where things lie. A piece of a single-sided triangle counts half a spacing behind
// its front: that front is not hidden by itself.
//
// It depends on the geometry and on what is opaque alone, so pictures of a scene that stands still share it.
#pragma once

#include "raster/scene/prepared_data.hpp"
#include "sh/vec3d.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace halflit::raster {

/// Most points on a side of the lattice, and spacings from the scene's box to the lattice's border.
inline constexpr int kMostCoverPoints = 32;
inline constexpr float kCoverMargin = 1.5f;

/// Share of the light from one direction that is hidden at a point: a sum over the axes, held at 1.
struct Cover {
    float facing[3];  ///< the triangles' area vector, by their fronts, over the square of the spacing
    float both[3];    ///< areas across each axis that face both ways: the lesser of the two
    float back;       ///< factor of the area vector for light on the backs: the share of double-sided triangles
    /// direction: to the light, of any length; the share is times that length.
    [[nodiscard]] float hidden(const float (&direction)[3]) const {
        const auto size = [](float x) { return x < 0.0f ? -x : x; };
        const float front = facing[0] * direction[0] + facing[1] * direction[1] + facing[2] * direction[2];
        const float rest = both[0] * size(direction[0]) + both[1] * size(direction[1]) + both[2] * size(direction[2]);
        return (front > 0.0f ? front : -back * front) + rest;
    }
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
    std::vector<Cover> covers;              ///< rows along x, in layers of z
    std::vector<bool> rows;                 ///< of y, in layers of z: some cover of the row is not 0
    Foot foot;                              ///< all that lies a little above the lowest point; empty: that is a large ground
    double middle[2] = {0, 0};              ///< mean place of what hides, along x and z, spacings from the first point

    [[nodiscard]] std::size_t row(int y, int z) const { return static_cast<std::size_t>(z * size[1] + y); }
    [[nodiscard]] const Cover* row_covers(int y, int z) const { return &covers[row(y, z) * static_cast<std::size_t>(size[0])]; }
};

/// Makes the grid unless it is this scene's already.
void make_cover_grid(const PreparedData& scene, CoverGrid& grid);

}  // namespace halflit::raster
