// A coarse grid over the scene that tells where the surroundings are hidden. For each point of a lattice it has the light of the
// surroundings that something hides there, as a function of the normal that would receive it (raster/view/sky_grid.hpp).
//
// The share of the light of the surroundings that a surface with the normal n loses is
//
//     held in [0, 1]: (H(n) / T(n) - kGridThreshold) / (1 - kGridThreshold),     H(n) = sum of L_d A(n.d) h_d,  T(n) = sum of L_d A(n.d)
//
// where L_d is the light from the direction d, h_d the share of it that is hidden, and A the received cosine in its first three bands. H is
// a polynomial of the second degree in n. Its nine terms are those of the eight points of the lattice around the surface, by linear weights
// and by their heights above the surface. The threshold keeps what a convex body hides from itself out: the bands of A are not 0 below the
// horizon. T's lower bound is half of what a uniform sky gives, so the share changes no faster than kGridSlope |dn|.
#pragma once

#include <cstdint>

namespace halflit::shading {

/// Directions of the light, in the order of sky_directions(kGridDirections).
inline constexpr int kGridDirections = 30;
/// Distance at which a fragment reads the grid, along its normal, in units of the lattice.
inline constexpr float kGridOffset = 0.6f;
/// Height of a point above the fragment's plane up to which it does not count, likewise: its own surface may hide it.
inline constexpr float kGridClearance = 0.35f;
/// Distance from the lattice's border within which hidden shares fade to 0, likewise, because a floor continues beyond the border. The
/// scene that the lattice was made for lies farther inside.
inline constexpr float kGridFade = 1.0f;
/// Sum of the weights of the points below which hidden shares fade to 0.
inline constexpr float kLeastGridWeight = 0.05f;
/// Hidden share that does not count.
inline constexpr float kGridThreshold = 0.04f;

/// A(c) = constant + linear c + square c^2 [RH01].
struct GridLobe {
    double constant, linear, square;
};
inline constexpr GridLobe kGridLobe{3.0 / 32.0, 1.0 / 2.0, 15.0 / 32.0};
/// Mean of A over the sphere.
inline constexpr double kGridLobeMean = kGridLobe.constant + kGridLobe.square / 3.0;

/// Least T(n), in the sum of L_d; slope of the share.
inline constexpr double kLeastGridTotal = kGridLobeMean / 2.0;
inline constexpr double kGridSlope = 2.0 * (kGridLobe.linear + 2.0 * kGridLobe.square) / (kLeastGridTotal * (1.0 - double{kGridThreshold}));
/// Share of the hidden light that other surfaces return.
inline constexpr float kGridBounce = 0.4f;

/// Terms of a polynomial of the second degree in a unit normal: factors of 1; x, y, z; xx, yy; xy, xz, yz, as zz is 1 - xx - yy.
inline constexpr int kGridTerms = 9;

/// Adds the light A(n.d) of a direction.
inline void add_grid_light(double light, const double (&d)[3], double (&terms)[kGridTerms]) {
    const double once = light * kGridLobe.linear, twice = light * kGridLobe.square, zz = twice * d[2] * d[2];
    const double more[kGridTerms] = {light * kGridLobe.constant + zz,
                                     once * d[0],
                                     once * d[1],
                                     once * d[2],
                                     twice * d[0] * d[0] - zz,
                                     twice * d[1] * d[1] - zz,
                                     2.0 * twice * d[0] * d[1],
                                     2.0 * twice * d[0] * d[2],
                                     2.0 * twice * d[1] * d[2]};
    for (int k = 0; k < kGridTerms; ++k) terms[k] += more[k];
}

/// Point p = z * layer + y * row + x of the lattice lies at origin + (x, y, z) / per_length. Its terms of H are hidden[kGridTerms p ..].
struct SkyGridPlan {
    const float* hidden = nullptr;     ///< null: there is no grid
    std::int32_t size[3] = {0, 0, 0};  ///< points, at most 32 each
    std::int32_t row = 0, layer = 0;   ///< steps in p
    float origin[3] = {0, 0, 0};       ///< world space
    float per_length = 0;              ///< points in a world unit
    float total[kGridTerms] = {};      ///< terms of T
    float least_total = 0;             ///< T(n) is held above it
};

}  // namespace halflit::shading
