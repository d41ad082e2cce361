// What hides the surroundings, in a coarse grid over the scene: for each point of a lattice, the directions in which something lies. It is
// made in a millisecond, whatever the scene, and read in a few loads a fragment (raster/view/sky_grid.hpp).
//
// The share of the light of the surroundings that a surface with the normal n loses is
//
//     min(1, (sum of L_d max(0, n.d) h_d over the directions) / T(n)),  T(n) = the same sum without h_d
//
// where L_d is the light from the direction d and h_d the share that it is hidden: the mean over the eight points of the lattice around the
// surface, by linear weights. T(n) is taken from the first three bands of max(0, n.d) = 3/32 + n.d / 2 + 15/32 (n.d)^2 [RH01], and is at
// least an eighth of the sum of L_d, half of what a sky that is the same all around gives. So the share changes no faster than
// kGridSlope |dn|: the first sum by the sum of L_d, T(n) by 1/2 + 15/16 of it.
#pragma once

#include <cstdint>

namespace halflit::shading {

/// Directions of a grid: bits of a point's mask, in the order of sky_directions(kGridDirections).
inline constexpr int kGridDirections = 32;
/// Distance at which a fragment reads the grid, along its normal, in units of the lattice.
inline constexpr float kGridOffset = 0.6f;
/// Height of a point above the fragment's plane up to which it does not count, likewise: its own surface may hide it.
inline constexpr float kGridClearance = 0.35f;
/// Least T(n), in the sum of L_d; slope of the share.
inline constexpr double kLeastGridTotal = 0.125, kGridSlope = (1.0 + 1.0 / 2 + 15.0 / 16) / kLeastGridTotal;
/// Share of the hidden light that other surfaces return.
inline constexpr float kGridBounce = 0.3f;

/// Point (x, y, z) of the lattice has the mask masks[(z * size[1] + y) * size[0] + x] and lies at origin + (x, y, z) / per_length.
struct SkyGridPlan {
    const std::int32_t* masks = nullptr;  ///< null: there is no grid
    std::int32_t size[3] = {0, 0, 0};     ///< points, at most 32 each
    float origin[3] = {0, 0, 0};          ///< world space
    float per_length = 0;                 ///< points in a world unit
    float total[10] = {};                 ///< of T(n): 1; x, y, z; xx, yy, zz; xy, xz, yz
    float least_total = 0;                ///< T(n) is held above it
};

}  // namespace halflit::shading
