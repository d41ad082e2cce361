// Rows of the picture's background: the contact shadow, what it leaves of a colour, and the means of samples.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "sh/smoothstep.hpp"
#include "shading/kernels/simd.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

/// In float64, because a cell's place is a quotient of sums over the whole picture. Loops are written for the compiler's vectors.
inline void shadow_row(const GroundShadow& shadow, int x_px, int count, float* __restrict opacity) {
    constexpr int kSide = kGroundCells;
    const GroundShadow s = shadow;
    double weight[kMaxTileSize], x[kMaxTileSize], z[kMaxTileSize];
    std::int32_t cell[kMaxTileSize];
    float corner[4][kMaxTileSize];
    for (int i = 0; i < count; ++i) {
        const double px = (x_px + i) + 0.5;
        weight[i] = (s.weight[0] * px + s.weight[1]) + s.weight[2];
        const double per_weight = 1.0 / weight[i];
        x[i] = ((s.cell_x[0] * px + s.cell_x[1]) + s.cell_x[2]) * per_weight;
        z[i] = ((s.cell_z[0] * px + s.cell_z[1]) + s.cell_z[2]) * per_weight;
    }
    // Beside the map its border is seen, where nothing is hidden.
    for (int i = 0; i < count; ++i) {
        double u = x[i] > 0.0 ? x[i] : 0.0, v = z[i] > 0.0 ? z[i] : 0.0;
        u = u < kSide - 1 ? u : kSide - 1, v = v < kSide - 1 ? v : kSide - 1;
        std::int32_t column = static_cast<std::int32_t>(u), row = static_cast<std::int32_t>(v);
        column = column < kSide - 2 ? column : kSide - 2, row = row < kSide - 2 ? row : kSide - 2;
        x[i] = u - column, z[i] = v - row;
        cell[i] = row * kSide + column;
    }
    for (int i = 0; i < count; ++i) {
        const float* const at = s.hidden + cell[i];
        corner[0][i] = at[0], corner[1][i] = at[1], corner[2][i] = at[kSide], corner[3][i] = at[kSide + 1];
    }
    for (int i = 0; i < count; ++i) {
        const double c0 = corner[0][i], c1 = corner[1][i], c2 = corner[2][i], c3 = corner[3][i];
        const double above = c0 + (c1 - c0) * x[i], below = c2 + (c3 - c2) * x[i];
        const std::int32_t left = x_px + i, right = s.width - 1 - left, beside = left < right ? left : right;
        const std::int32_t border = beside < s.border ? beside : s.border;
        const double share = above + (below - above) * z[i];
        const double most = s.opacity * smoothstep(border / s.fade_px);
        const double out = share * most;
        opacity[i] = static_cast<float>(weight[i] > 0.0 ? out : 0.0);
    }
}

/// 0 for NaN, and instead of -0.
HALFLIT_INLINE F number_or_zero(F x) { return sel(x == x, x + F(0.0f), F(0.0f)); }

/// `sums` become the colours of pixels, not premultiplied.
HALFLIT_INLINE void take_mean(F (&sums)[4], F weight) {
    const F alpha = sums[3] * weight;
    const M some = alpha > F(0.0f);
    for (int k = 0; k < 3; ++k) sums[k] = sel(some, number_or_zero(vdiv(sums[k] * weight, alpha)), F(0.0f));
    sums[3] = number_or_zero(alpha);
}

inline void take_means(float weight, int count, float* const rows[4]) {
    for (int i = 0; i < count; i += kWidth) {
        F pixel[4] = {load(rows[0] + i), load(rows[1] + i), load(rows[2] + i), load(rows[3] + i)};
        take_mean(pixel, F(weight));
        for (int k = 0; k < 4; ++k) store(rows[k] + i, pixel[k]);
    }
}

/// Through samples, so that it rounds as beside a surface.
inline void shade_background(const float (&back)[4], const float* opacity, int samples, int count, float* const rows[4]) {
    const F weight(1.0f / static_cast<float>(samples));
    for (int i = 0; i < count; i += kWidth) {
        const F over = load(opacity + i), kept = F(1.0f) - over;
        F pixel[4];
        for (int k = 0; k < 4; ++k) {
            const F sample = number_or_zero(k < 3 ? F(back[k]) * kept : F(back[k]) * kept + over);
            pixel[k] = sample;
            for (int s = 1; s < samples; ++s) pixel[k] = pixel[k] + sample;
        }
        take_mean(pixel, weight);
        for (int k = 0; k < 4; ++k) store(rows[k] + i, pixel[k]);
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
