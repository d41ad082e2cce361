// Look-ups in the grid of what hides the surroundings: the terms of the eight points of the lattice around a fragment. Points at the back of
// the fragment's plane do not count.
#pragma once

#include "shading/kernels/vector.hpp"
#include "shading/plan/plan.hpp"

#include <cstdint>

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Light that is hidden at a fragment, as a polynomial in the normal, in the order of kGridTerms.
struct GridLight {
    F terms[shading::kGridTerms];
};

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
    // Mostly all lanes lie between the same eight points: then nothing is gathered.
    const std::int32_t leading = first_lane(first);
    const bool together = all(equal(first, I(leading)) | !inside);
    GridLight out;
    for (F& term : out.terms) term = none;
    F sum(0.0f);
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
        if (together) {
            const float* const point = grid.hidden + leading + step;
            for (int t = 0; t < kTerms; ++t) out.terms[t] = mad(F(point[t]), weight, out.terms[t]);
        } else {
            for (int t = 0; t < kTerms; ++t) out.terms[t] = mad(gather(grid.hidden, first + I(step + t)), weight, out.terms[t]);
        }
    }
    const F fade = vmax(border, none) * F(1.0f / shading::kGridFade);
    const F factor = sel(inside, vdiv(fade, vmax(sum, F(shading::kLeastGridWeight))), none);
    for (F& term : out.terms) term = term * factor;
    return out;
}

/// The polynomial's value.
template <class Term>
HALFLIT_INLINE F of_normal(const Term (&t)[shading::kGridTerms], V3 n) {
    const F linear = ((F(t[1]) * n.x + F(t[2]) * n.y) + F(t[3]) * n.z) + F(t[0]);
    const F squares = (F(t[4]) * n.x + F(t[6]) * n.y + F(t[7]) * n.z) * n.x + (F(t[5]) * n.y + F(t[8]) * n.z) * n.y;
    return linear + squares;
}

/// Share of the light of the surroundings that reaches a surface, in [kGridBounce, 1]. `normal`: that light is received by.
HALFLIT_INLINE F seen_in_grid(const shading::SkyGridPlan& grid, const GridLight& hidden, V3 normal) {
    constexpr float kThreshold = shading::kGridThreshold;
    const F total = vmax(of_normal(grid.total, normal), F(grid.least_total));
    const F share = (vdiv(of_normal(hidden.terms, normal), total) - F(kThreshold)) * F(1.0f / (1.0f - kThreshold));
    return F(1.0f) - clamp(share, F(0.0f), F(1.0f)) * F(1.0f - shading::kGridBounce);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
