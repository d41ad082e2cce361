// Look-ups in the grid of what hides the surroundings: the masks of the eight points of the lattice around a fragment, and for each
// direction the share of them that it is hidden from. Points at the back of the fragment's plane do not count.
#pragma once

#include "shading/kernels/vector.hpp"
#include "shading/plan/plan.hpp"

#include <cstdint>

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// One of the eight points around a fragment that counts for some lane. To leave one out changes no sum: it would add 0.
struct GridPoint {
    int count = 0;
    I masks[2][8];
    F weights[8];
    F weight;  ///< their sum; 0: nothing is hidden
    F fade;    ///< factor on hidden shares
};

/// `normal`: of the surface, unit.
HALFLIT_INLINE GridPoint grid_point(const shading::SkyGridPlan& grid, V3 position, V3 normal) {
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
    const float row = static_cast<float>(grid.size[0]), layer = static_cast<float>(grid.size[0] * grid.size[1]);
    const I first = shl<1>(round_even(mad(z, F(layer), mad(y, F(row), x))));
    const F height = ((normal.x * below_x + normal.y * below_y) + normal.z * below_z) - F(shading::kGridClearance);
    // Mostly all lanes lie between the same eight points: then nothing is gathered.
    const std::int32_t leading = first_lane(first);
    const bool together = all(equal(first, I(leading)) | !inside);
    GridPoint out;
    F sum(0.0f);
    for (int k = 0; k < 8; ++k) {
        const int step = (k & 1) + (k >> 1 & 1) * grid.size[0] + (k >> 2) * grid.size[0] * grid.size[1];
        F above = height;
        if ((k & 1) != 0) above = above + normal.x;
        if ((k & 2) != 0) above = above + normal.y;
        if ((k & 4) != 0) above = above + normal.z;
        const F linear = (((k & 1) != 0 ? u : one - u) * ((k & 2) != 0 ? v : one - v)) * ((k & 4) != 0 ? w : one - w);
        const F weight = linear * clamp(above, none, one);
        if (!any(weight > none)) continue;
        for (int word = 0; word < 2; ++word)
            out.masks[word][out.count] =
                together ? I(grid.masks[leading + 2 * step + word]) : gather(grid.masks, first + I(2 * step + word));
        out.weights[out.count++] = weight;
        sum = sum + weight;
    }
    out.weight = sel(inside, sum, none);
    out.fade = vmax(border, none) * F(1.0f / shading::kGridFade);
    return out;
}

/// Sum of the weights of the points, each times the share that a direction is hidden from there.
HALFLIT_INLINE F hidden_weight(const GridPoint& at, int direction) {
    const int word = direction / shading::kGridInWord, shift = 2 * (direction % shading::kGridInWord);
    const I bits(3 << shift);
    F sum(0.0f);
    for (int k = 0; k < at.count; ++k) sum = mad(to_float(at.masks[word][k] & bits), at.weights[k], sum);
    // Two bits at any place are exact in float.
    return sum * F(1.0f / (static_cast<float>(shading::kGridWays) * static_cast<float>(1 << shift)));
}

/// Weights of the points too small to count.
inline constexpr float kLeastGridWeight = 1e-3f;

/// Share in [0, 1] of the light from a direction that is hidden.
HALFLIT_INLINE F hidden_share(const GridPoint& at, int direction) {
    const F share = vdiv(hidden_weight(at, direction), vmax(at.weight, F(kLeastGridWeight))) * at.fade;
    return sel(at.weight > F(kLeastGridWeight), share, F(0.0f));
}

/// Share of the light of the surroundings that reaches a surface, in [kGridBounce, 1]. `normal`: that light is received by.
HALFLIT_INLINE F seen_in_grid(const shading::ShadingPlan& frame, V3 position, V3 surface_normal, V3 normal) {
    const shading::SkyGridPlan& grid = frame.sky_grid;
    const GridPoint at = grid_point(grid, position, surface_normal);
    // Ways that are hidden from some point of some lane.
    std::uint32_t ways[2];
    for (int word = 0; word < 2; ++word) {
        I all(0);
        for (int k = 0; k < at.count; ++k) all = all | at.masks[word][k];
        alignas(64) std::int32_t lanes[kWidth];
        store(lanes, sel(at.weight > F(kLeastGridWeight), all, I(0)));
        ways[word] = 0;
        for (int l = 0; l < kWidth; ++l) ways[word] |= static_cast<std::uint32_t>(lanes[l]);
    }
    const F none(0.0f);
    F hidden(0.0f);
    for (const shading::LightPlan& light : frame.sky) {
        if ((ways[light.source / shading::kGridInWord] >> (2 * (light.source % shading::kGridInWord)) & 3u) == 0) continue;
        const F received = dot(normal, broadcast(light.to_light)) - F(static_cast<float>(shading::kGridWayTangent));
        if (!any(received > none)) continue;
        hidden = hidden + (vmax(received, none) * F(light.brightness)) * hidden_weight(at, light.source);
    }
    const float(&t)[10] = grid.total;
    const F linear = ((F(t[1]) * normal.x + F(t[2]) * normal.y) + F(t[3]) * normal.z) + F(t[0]);
    const F squares = (F(t[4]) * normal.x * normal.x + F(t[5]) * normal.y * normal.y) + F(t[6]) * normal.z * normal.z;
    const F mixed = (F(t[7]) * normal.x * normal.y + F(t[8]) * normal.x * normal.z) + F(t[9]) * normal.y * normal.z;
    const F total = vmax(linear + (squares + mixed), F(grid.least_total));
    const F share = vmin(vdiv(hidden * at.fade, vmax(at.weight, F(kLeastGridWeight)) * total), F(1.0f));
    return F(1.0f) - sel(at.weight > F(kLeastGridWeight), share, none) * F(1.0f - shading::kGridBounce);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
