// Light of whole cells of the picture. Many lights change little over a cell of 8 x 8 pixels, so their sum is fitted there by one
// polynomial of the second degree in the normal and the position, once for the cell instead of once for each pixel. A light whose remainder
// exceeds what the error budget allows stays with the pixels. Derivation and bound: budget/DERIVATION.md, "Light in cells".
#pragma once

#include <cstdint>

namespace halflit::shading {

inline constexpr int kCellSide = 8;    ///< pixels; cells are those of the whole picture, whatever tile or region is drawn
inline constexpr int kCellLanes = 16;  ///< cells that are fitted together; a multiple of every SIMD width

/// Terms of the polynomial in n = N - N0 and p = (P - P0) / r: 1; n (3); p (3); n_i n_j, i <= j (6); n_i p_j (9); p_i p_j, i <= j (6).
inline constexpr int kCellTerms = 28;
inline constexpr int kTermN = 1, kTermP = 4, kTermNN = 7, kTermNP = 13, kTermPP = 22;

/// Up to kCellLanes cells of one material, each a lane.
struct alignas(64) CellBatch {
    int count = 0;
    float normal[3][kCellLanes], position[3][kCellLanes];          ///< N0, P0; finite
    float normal_radius[kCellLanes], position_radius[kCellLanes];  ///< the largest |N - N0|, |P - P0| = r; kNoCell: nothing is fitted
    float term[kCellTerms][3][kCellLanes];                         ///< red, green, blue of the light through the lobe, before its scale
    float highlight[kCellTerms][3][kCellLanes];                    ///< of the highlights, before normalisation and reflectance
    std::uint32_t shining = 0;                                     ///< bit l: cell l has highlights
};
inline constexpr float kNoCell = 3e38f;

/// The fitted light of one cell, as pixels read it.
struct LightCell {
    float normal[3], position[3], inv_position_radius;
    bool flat;  ///< all normals are N0: terms with n are 0
    float term[kCellTerms][3], highlight[kCellTerms][3];
    bool shines;  ///< terms of highlights are not all 0
};

}  // namespace halflit::shading
