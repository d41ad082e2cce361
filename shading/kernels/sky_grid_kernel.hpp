// Look-ups in the grid of what hides the surroundings: the terms of the eight points of the lattice around a fragment. Points at the back
// of the fragment's plane do not count.
#pragma once

#include "shading/kernels/vector.hpp"
#include "shading/plan/plan.hpp"

#include <cstdint>

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Light that is hidden at a fragment, as a polynomial in the normal: factors of 1; x, y, z; xx, yy; xy, xz, yz.
struct GridLight {
    F one, x, y, z, xx, yy, xy, xz, yz;

    /// Adds a point's terms, term(k), times its weight.
    template <class Term>
    HALFLIT_INLINE void add(F weight, const Term& term) {
        one = mad(term(0), weight, one);
        x = mad(term(1), weight, x), y = mad(term(2), weight, y), z = mad(term(3), weight, z);
        xx = mad(term(4), weight, xx), yy = mad(term(5), weight, yy);
        xy = mad(term(6), weight, xy), xz = mad(term(7), weight, xz), yz = mad(term(8), weight, yz);
    }
    [[nodiscard]] HALFLIT_INLINE F at(V3 n) const {
        const F linear = ((x * n.x + y * n.y) + z * n.z) + one;
        return linear + ((xx * n.x + xy * n.y + xz * n.z) * n.x + (yy * n.y + yz * n.z) * n.y);
    }
};
static_assert(shading::kGridTerms == 9);
HALFLIT_INLINE GridLight no_grid_light() {
    const F none(0.0f);
    return {none, none, none, none, none, none, none, none, none};
}

/// Beyond so many, gathering is faster.
inline constexpr int kMostCells = 4;

/// `normal`: of the surface, unit.
HALFLIT_INLINE GridLight grid_light(const shading::SkyGridPlan& grid, V3 position, V3 normal) {
    constexpr int kTerms = shading::kGridTerms;
    const F scale(grid.per_length), one(1.0f), none(0.0f), offset(shading::kGridOffset);
    F border(shading::kGridFade);
    const auto along = [&](F p, F n, int axis, F& first, F& part, F& below) __attribute__((always_inline)) {
        const F place = (p - F(grid.origin[axis])) * scale, at = mad(n, offset, place);
        const F last(static_cast<float>(grid.size[axis] - 1));
        border = vmin(border, vmin(place, last - place));
        const M in = (at >= none) & (at < last);
        const F held = sel(in, at, none);
        first = vfloor(held);
        part = held - first;
        below = first - place;
        return in;
    };
    F x, y, z, u, v, w, below_x, below_y, below_z;
    const M inside = along(position.x, normal.x, 0, x, u, below_x) & along(position.y, normal.y, 1, y, v, below_y) &
                     along(position.z, normal.z, 2, z, w, below_z);
    // At most 2^15 points: indices are exact in float.
    const F row(static_cast<float>(grid.row)), layer(static_cast<float>(grid.layer));
    const I first = round_even(mad(z, layer, mad(y, row, x)) * F(static_cast<float>(kTerms)));
    const F height = ((normal.x * below_x + normal.y * below_y) + normal.z * below_z) - F(shading::kGridClearance);
    F weights[8], sum(0.0f);
    int steps[8], count = 0;
    for (int k = 0; k < 8; ++k) {
        const int step = kTerms * ((k & 1) + (k >> 1 & 1) * grid.row + (k >> 2) * grid.layer);
        F above = height;
        if ((k & 1) != 0) above = above + normal.x;
        if ((k & 2) != 0) above = above + normal.y;
        if ((k & 4) != 0) above = above + normal.z;
        const F linear = (((k & 1) != 0 ? u : one - u) * ((k & 2) != 0 ? v : one - v)) * ((k & 4) != 0 ? w : one - w);
        const F weight = linear * clamp(above, none, one);
        if (!any(weight > none)) continue;  // it would add 0
        sum = sum + weight;
        weights[count] = weight;
        steps[count++] = step;
    }
    const F fade = vmax(border, none) * F(1.0f / shading::kGridFade);
    const F factor = sel(inside, vdiv(fade, vmax(sum, F(shading::kLeastGridWeight))), none);
    for (int k = 0; k < count; ++k) weights[k] = weights[k] * factor;
    // Lanes mostly lie between few points of the lattice: those of eight points at a time, to which other lanes add nothing.
    GridLight out = no_grid_light();
    alignas(64) std::int32_t starts[kWidth];
    store(starts, first);
    std::uint32_t left = mask_bits(inside);
    for (int cells = 0; left != 0 && cells < kMostCells; ++cells) {
        const std::int32_t start = starts[__builtin_ctz(left)];
        const M here = equal(first, I(start)) & inside;
        left &= ~mask_bits(here);
        for (int k = 0; k < count; ++k) {
            const float* const point = grid.hidden + start + steps[k];
            out.add(
                sel(here, weights[k], none), [point](int term) __attribute__((always_inline)) { return F(point[term]); });
        }
    }
    if (left == 0) return out;
    out = no_grid_light();
    for (int k = 0; k < count; ++k) {
        const I point = first + I(steps[k]);
        out.add(
            weights[k], [&](int term) __attribute__((always_inline)) { return gather(grid.hidden + term, point); });
    }
    return out;
}

/// Share of the light of the surroundings that reaches a surface, in [kGridBounce, 1]. `normal`: that light is received by.
HALFLIT_INLINE F seen_in_grid(const shading::SkyGridPlan& grid, const GridLight& hidden, V3 normal) {
    constexpr float kThreshold = shading::kGridThreshold;
    GridLight all = no_grid_light();
    all.add(
        F(1.0f), [&](int term) __attribute__((always_inline)) { return F(grid.total[term]); });
    const F total = vmax(all.at(normal), F(grid.least_total));
    const F share = (vdiv(hidden.at(normal), total) - F(kThreshold)) * F(1.0f / (1.0f - kThreshold));
    return F(1.0f) - clamp(share, F(0.0f), F(1.0f)) * F(1.0f - shading::kGridBounce);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
