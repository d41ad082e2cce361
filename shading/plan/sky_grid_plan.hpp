// A coarse grid over the scene that tells where the surroundings are hidden: for each point of a lattice, the directions in which something
// lies. It is made in a millisecond, whatever the scene, and read in a few loads a fragment (raster/view/sky_grid.hpp).
//
// The share of the light of the surroundings that a surface with the normal n loses is
//
//     min(1, (sum of L_d max(0, n.d - a) h_d over the directions) / T(n)),  T(n) = the same sum without h_d
//
// where L_d is the light from the direction d, and h_d the hidden share of three ways about d: the mean over the eight points of the
// lattice around the surface, by linear weights. Only directions with n.d > a count. The ways about them lie within the angle whose tangent
// is a, so none of them goes below the surface. T(n) is taken from the first three bands of max(0, n.d - a) [RH01]. Its lower bound is half
// of what a uniform sky gives, so the share changes no faster than kGridSlope |dn|.
#pragma once

#include <cstdint>

namespace halflit::shading {

/// Directions of a grid, in the order of sky_directions(kGridDirections), and how many of them share a word.
inline constexpr int kGridDirections = 30, kGridInWord = 15;
/// Ways about a direction that are followed: how many of them are hidden is two bits.
inline constexpr int kGridWays = 3;
/// Distance at which a fragment reads the grid, along its normal, in units of the lattice.
inline constexpr float kGridOffset = 0.6f;
/// Height of a point above the fragment's plane up to which it does not count, likewise: its own surface may hide it.
inline constexpr float kGridClearance = 0.35f;
/// Distance from the lattice's border within which hidden shares fade to 0, likewise, because a floor continues beyond the border. The
/// scene that the lattice was made for lies farther inside.
inline constexpr float kGridFade = 1.0f;
/// Tangent of the angle between a direction and the ways about it; the least cosine a that counts is the same number.
inline constexpr double kGridWayTangent = 0.21;

/// max(0, c - a) in three bands: constant + linear c + square c^2.
struct GridLobe {
    double mean, constant, linear, square;
};
constexpr GridLobe grid_lobe(double a) {
    const double a2 = a * a, ones = 1.0 - a, cosines = (1.0 - a2) / 2.0, squares = (1.0 - a2 * a) / 3.0, cubes = (1.0 - a2 * a2) / 4.0;
    const double band0 = (cosines - a * ones) / 2.0, band1 = 1.5 * (squares - a * cosines);
    const double band2 = 1.25 * ((3.0 * cubes - cosines) - a * (3.0 * squares - ones));
    return {band0, band0 - band2 / 2.0, band1, 1.5 * band2};
}
inline constexpr GridLobe kGridLobe = grid_lobe(kGridWayTangent);

/// Least T(n), in the sum of L_d; slope of the share.
inline constexpr double kLeastGridTotal = kGridLobe.mean / 2.0;
inline constexpr double kGridSlope = (1.0 + kGridLobe.linear + 2.0 * kGridLobe.square) / kLeastGridTotal;
/// Share of the hidden light that other surfaces return.
inline constexpr float kGridBounce = 0.4f;

/// Point p = (z * size[1] + y) * size[0] + x of the lattice lies at origin + (x, y, z) / per_length. Bits 2 k and 2 k + 1 of masks[2 p + w]
/// are the number of hidden ways about the direction kGridInWord w + k.
struct SkyGridPlan {
    const std::int32_t* masks = nullptr;  ///< null: there is no grid
    std::int32_t size[3] = {0, 0, 0};     ///< points, at most 32 each
    float origin[3] = {0, 0, 0};          ///< world space
    float per_length = 0;                 ///< points in a world unit
    float total[10] = {};                 ///< of T(n): 1; x, y, z; xx, yy, zz; xy, xz, yz
    float least_total = 0;                ///< T(n) is held above it
};

}  // namespace halflit::shading
