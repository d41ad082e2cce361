// Shadow-map look-ups: the share of a light that is hidden at each fragment, summed over a fixed neighbourhood of 4 x 4 texels.
//
// Each of the 16 texels is compared on its own (percentage-closer filtering). Rows and columns are weighted 1-f, 1, 1, f with f the
// position between texel centres: a box of 3 x 3 texels that slides without steps. Lights may have penumbras: then every second, fourth or
// eighth texel is read, as far as the distance of the blockers asks. The sum is that of the hidden shares, so that a fragment
// that no texel hides gets exactly 0, and one that all texels hide exactly 1.
#pragma once

#include "shading/kernels/simd_records.hpp"
#include "shading/kernels/vector.hpp"
#include "shading/plan/plan.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Hidden shares in [0, 1]: `hard` of light that a shadow cuts off, `soft` of light that fades with the blocker's distance.
struct HiddenShares {
    F hard, soft;
};

/// A fragment's place in a map: texel coordinates, distance along the axis, and the first texel of its face.
struct MapPoint {
    F u, v, distance;
    I base;
    I wide_base;  ///< the same in those of the widest filter
    M inside;
};

HALFLIT_INLINE F row_product(const float (&row)[4], V3 p) { return ((F(row[0]) * p.x + F(row[1]) * p.y) + F(row[2]) * p.z) + F(row[3]); }

/// The face of a cube that a direction from the light meets: +x, -x, +y, ..
struct CubeFace {
    M is_x, is_y;  ///< its axis; neither: z
    M negative;

    HALFLIT_INLINE explicit CubeFace(V3 offset) {
        const F ax = vabs(offset.x), ay = vabs(offset.y), az = vabs(offset.z);
        is_x = (ax >= ay) & (ax >= az);
        is_y = ay >= az;
        negative = along(offset) < F(0.0f);
    }
    /// The component along its axis.
    [[nodiscard]] HALFLIT_INLINE F along(V3 v) const { return sel(is_x, v.x, sel(is_y, v.y, v.z)); }
};

/// A point in the map of a face; it may lie a few texels beyond its edge. u follows the next axis, v the one after it times the face's sign
/// (raster/view/shadow_views.cpp).
HALFLIT_INLINE MapPoint cube_point(const shading::ShadowMapPlan& map, const CubeFace& at, V3 offset) {
    const F along_u = sel(at.is_x, offset.y, sel(at.is_y, offset.z, offset.x));
    const F along_v = sel(at.is_x, offset.z, sel(at.is_y, offset.x, offset.y));
    const F major = at.along(offset);
    const F distance = sel(at.negative, F(0.0f) - major, major);
    const F inv = vdiv(F(1.0f), vmax(distance, F(1e-30f)));
    const F half(0.5f * static_cast<float>(map.size - 2 * shading::kShadowBorder)), middle(0.5f * static_cast<float>(map.size));
    const I axis = sel(at.is_x, I(0), sel(at.is_y, I(2), I(4)));
    const I face = axis + sel(at.negative, I(1), I(0));
    // Six faces of at most 2^22 texels: exact in float, and a multiplication of integers is slow on some sets.
    const I base = round_even(to_float(face) * F(static_cast<float>(map.size * map.size)));
    return {mad(along_u * inv, half, middle),
            mad(sel(at.negative, F(0.0f) - along_v, along_v) * inv, half, middle),
            distance,
            base,
            I(0),
            distance > F(0.0f)};
}

/// A point in a map that is not a cube's. Where the filter would reach beyond the map, nothing casts a shadow.
HALFLIT_INLINE MapPoint flat_point(const shading::ShadowMapPlan& map, V3 p) {
    MapPoint at{row_product(map.rows[0], p), row_product(map.rows[1], p), row_product(map.rows[2], p), I(0), I(0), F(0.0f) <= F(0.0f)};
    if (map.kind == shading::ShadowMapPlan::Kind::perspective) {
        at.inside = at.distance > F(0.0f);
        const F inv = vdiv(F(1.0f), sel(at.inside, at.distance, F(1.0f)));
        at.u = at.u * inv;
        at.v = at.v * inv;
    }
    const F low(2.0f), high(static_cast<float>(map.size) - 2.0f);
    at.inside = at.inside & (at.u > low) & (at.v > low) & (at.u < high) & (at.v < high);
    return at;
}

/// A point moved off its surface, so that a plane does not hide itself. along_axis: cosine between the normal and the map's axis.
HALFLIT_INLINE V3 off_surface(const shading::ShadowMapPlan& map, V3 p, V3 normal, F texel, F along_axis) {
    const F sine = vsqrt(vmax(F(1.0f) - along_axis * along_axis, F(0.0f)));
    return p + normal * ((texel * F(map.offset)) * sine);
}

/// The place in a directional light's map.
HALFLIT_INLINE MapPoint orthographic_point(const shading::ShadowMapPlan& map, V3 p, V3 normal) {
    const F along_axis = (F(map.rows[2][0]) * normal.x + F(map.rows[2][1]) * normal.y) + F(map.rows[2][2]) * normal.z;
    return flat_point(map, off_surface(map, p, normal, F(map.texel_size), along_axis));
}

/// A fragment's place in the first of a light's cascades that holds all that the filter reads. at: the place in the first map.
HALFLIT_INLINE MapPoint in_cascades(const shading::ShadowMapPlan& map, V3 p, V3 normal, MapPoint at, F& texel) {
    const int wide_texels = shading::wide_side(map.size) * shading::wide_side(map.size);
    for (int k = 1; k <= map.coarser && !all(at.inside); ++k) {
        const shading::ShadowMapPlan& next = (&map)[k];
        const MapPoint there = orthographic_point(next, p, normal);
        // Four maps of at most 2^24 texels.
        texel = sel(at.inside, texel, F(next.texel_size));
        const M inside = at.inside | there.inside;
        at = {sel(at.inside, at.u, there.u),
              sel(at.inside, at.v, there.v),
              sel(at.inside, at.distance, there.distance),
              sel(at.inside, at.base, I(k * map.size * map.size)),
              sel(at.inside, at.wide_base, I(k * wide_texels)),
              inside};
    }
    return at;
}

/// The place where a fragment is looked up. texel: set to a texel's width at the fragment.
HALFLIT_INLINE MapPoint map_point(const shading::ShadowMapPlan& map, V3 p, V3 normal, F& texel) {
    texel = F(map.texel_size);
    if (map.kind == shading::ShadowMapPlan::Kind::cube) {
        const V3 origin = broadcast(map.origin), offset = p - origin;
        const CubeFace face(offset);
        texel = texel * vabs(face.along(offset));
        return cube_point(map, face, off_surface(map, p, normal, texel, face.along(normal)) - origin);
    }
    if (map.kind == shading::ShadowMapPlan::Kind::perspective) texel = texel * vmax(row_product(map.rows[2], p), F(0.0f));
    const F along_axis = (F(map.rows[2][0]) * normal.x + F(map.rows[2][1]) * normal.y) + F(map.rows[2][2]) * normal.z;
    return flat_point(map, off_surface(map, p, normal, texel, along_axis));
}

/// Fading of wrapped light with the blocker's distance: MaterialPlan::shadow_fade_scale and shadow_turn_scale. scale 0: shadows cut it off.
struct ShadowFade {
    float scale = 0, turn = 0;
};

/// 1 - T with T = v^2 (3 - 2 v) on [0, 1]: exactly 1 for v <= 0, exactly 0 for v >= 1.
HALFLIT_INLINE F faded(F v) {
    const F t = clamp(v, F(0.0f), F(1.0f));
    return F(1.0f) - (t * t) * (F(3.0f) - (t + t));
}

/// What a filter finds that reads every 2^k-th texel.
struct WideShares {
    HiddenShares hidden;
    F behind;  ///< mean over all texels of the distance from the blocker, 0 where there is none
};

/// Rows of four texels about a point, for every 2^k-th texel.
struct SparseRows {
    const shading::ShadowMapPlan& map;
    int k;
    I base;

    HALFLIT_INLINE void read(F u0, F v0, int j, F (&distance)[4]) const {
        const float step = static_cast<float>(1 << k);
        const F none(0.0f), ends(static_cast<float>(map.size - 1));
        const F row = clamp(mad(v0 + F(static_cast<float>(j) - 1.0f), F(step), F(0.5f * step)), none, ends);
        const I first = round_to_int(row) * I(map.size) + base;
        for (int i = 0; i < 4; ++i) {
            const F column = clamp(mad(u0 + F(static_cast<float>(i) - 1.0f), F(step), F(0.5f * step)), none, ends);
            distance[i] = gather(map.distance, first + round_to_int(column));
        }
    }
};
/// The same for the widest filter.
struct WideRows {
    const float* texels[kWidth];
    int side;

    HALFLIT_INLINE WideRows(const shading::ShadowMapPlan& map, const MapPoint& at) : side(shading::wide_side(map.size)) {
        constexpr float kStep = 1.0f / static_cast<float>(1 << shading::kPenumbraLevels);
        const F last(static_cast<float>(side - 4));
        const F u0 = vfloor(at.u * F(kStep) - F(0.5f)), v0 = vfloor(at.v * F(kStep) - F(0.5f));
        const F column = clamp(u0 + F(1.0f), F(0.0f), last), row = clamp(v0 + F(1.0f), F(0.0f), last);
        alignas(64) std::int32_t first[kWidth];
        store(first, round_to_int(mad(row, F(static_cast<float>(side)), column)) + at.wide_base);
        for (int l = 0; l < kWidth; ++l) texels[l] = map.wide + first[l];
    }
    HALFLIT_INLINE void read(F, F, int j, F (&distance)[4]) const {
        const float* row[kWidth];
        for (int l = 0; l < kWidth; ++l) row[l] = texels[l] + j * side;
        load4(row, distance[0], distance[1], distance[2], distance[3]);
    }
};

/// left, fade: as in hidden_share().
template <class Rows>
HALFLIT_INLINE WideShares wide_share(const Rows& rows, const MapPoint& at, F receiver, int k, ShadowFade fade, F left, bool soft) {
    const float step = static_cast<float>(1 << k);
    const F none(0.0f), one(1.0f), third(1.0f / 3.0f);
    const F u = at.u * F(1.0f / step) - F(0.5f), v = at.v * F(1.0f / step) - F(0.5f), u0 = vfloor(u), v0 = vfloor(v);
    const F fu = u - u0, fv = v - v0;
    const F across[4] = {(one - fu) * third, third, third, fu * third}, along[4] = {(one - fv) * third, third, third, fv * third};
    WideShares sum{{none, none}, none};
    for (int j = 0; j < 4; ++j) {
        F distance[4];
        rows.read(u0, v0, j, distance);
        for (int i = 0; i < 4; ++i) {
            const F behind = receiver - distance[i];
            const M hides = behind > none;
            if (!any(hides)) continue;
            const F weight = sel(hides, across[i] * along[j], none);
            sum.hidden.hard = sum.hidden.hard + weight;
            sum.behind = sum.behind + weight * sel(hides, behind, none);
            if (soft) sum.hidden.soft = sum.hidden.soft + weight * faded((one - behind * F(fade.scale)) * left);
        }
    }
    return sum;
}

/// Hidden shares by filters as wide as the penumbra of the blockers that the widest one finds, mixed between two of them; `sharp` are those
/// by the narrowest.
HALFLIT_INLINE HiddenShares penumbra_share(const shading::ShadowMapPlan& map, const MapPoint& at, F receiver, V3 normal, F texel,
                                           HiddenShares sharp, ShadowFade fade, F left, bool soft) {
    const F none(0.0f), one(1.0f);
    const F cosine = vabs((F(map.rows[2][0]) * normal.x + F(map.rows[2][1]) * normal.y) + F(map.rows[2][2]) * normal.z);
    const F sine = vsqrt(vmax(one - cosine * cosine, none));
    const F shift = texel * (F(shading::kPenumbraBias) * vmin(vdiv(sine, vmax(cosine, F(0.1f))), F(shading::kSteepestPenumbra)));
    const auto wide = [&](const auto& rows, int k) __attribute__((always_inline)) {
        return wide_share(rows, at, receiver - shift * F(static_cast<float>((1 << k) - 1)), k, fade, left, soft);
    };
    const WideShares widest = wide(WideRows(map, at), shading::kPenumbraLevels);
    const M found = at.inside & (widest.hidden.hard > none);
    if (!any(found)) return sharp;
    // In widths of the narrowest filter.
    const F distance = vdiv(widest.behind, sel(found, widest.hidden.hard, one));
    const F width = sel(found, vdiv(distance * F(map.penumbra), texel * F(3.0f)), none);
    HiddenShares sum{none, none};
    F share = one;
    for (int k = 0; k <= shading::kPenumbraLevels; ++k) {
        const F wider = k == shading::kPenumbraLevels ? none : clamp(width * F(1.0f / static_cast<float>(1 << k)) - one, none, one);
        const F weight = share - wider;
        share = wider;
        if (!any(weight > none)) continue;
        const HiddenShares of_level = k == 0                          ? sharp
                                      : k == shading::kPenumbraLevels ? widest.hidden
                                                                      : wide(SparseRows{map, k, at.base}, k).hidden;
        sum.hard = sum.hard + weight * of_level.hard;
        sum.soft = sum.soft + weight * of_level.soft;
    }
    return {sel(found, vmin(sum.hard, one), sharp.hard), sel(found, vmin(soft ? sum.soft : sum.hard, one), sharp.soft)};
}

/// Hidden shares of a light at each lane. `normal`: unit normal of the surface.
HALFLIT_INLINE HiddenShares hidden_share(const shading::ShadowMapPlan& map, V3 position, V3 normal, V3 to_light, ShadowFade fade,
                                         bool soft) {
    F texel;
    MapPoint at = map_point(map, position, normal, texel);
    if (map.coarser > 0) at = in_cascades(map, position, normal, at, texel);
    const F receiver = at.distance - mad(texel, F(shading::kShadowDepthBias), at.distance * F(shading::kShadowRelativeBias));

    const F limit(static_cast<float>(map.size) - 2.0f);
    const F u = clamp(at.u, F(2.0f), limit) - F(0.5f), v = clamp(at.v, F(2.0f), limit) - F(0.5f);
    const F u0 = vfloor(u), v0 = vfloor(v);
    const F fu = u - u0, fv = v - v0;
    // Rows are at most 2^12 texels: the index of a row's first texel is exact in float.
    const I column = round_to_int(u0) - I(1);
    F left(1.0f);
    if (soft) {
        // `own`: the body's own thickness towards the light, as a share of d0. A blocker nearer than that hides no wrapped light; one at d0
        // hides all. Light that nothing hides keeps its bits, because the reciprocal is at least 1.
        const F cosine = dot(normal, to_light);
        const F own = vmin(vmax(F(0.0f) - cosine, F(0.0f)) * F(fade.turn), F(shading::kOwnThickness));
        left = vdiv(F(1.0f), F(1.0f) - own);
    }
    // A row of four texels is one load for each lane.
    alignas(64) std::int32_t first[kWidth];
    store(first, round_even((v0 - F(1.0f)) * F(static_cast<float>(map.size))) + column + at.base);
    const float* texels[kWidth];
    for (int l = 0; l < kWidth; ++l) texels[l] = map.distance + first[l];
    const F ninth(1.0f / 9.0f), none(0.0f), one(1.0f);
    F hard_row[4], soft_row[4];
    for (int j = 0; j < 4; ++j) {
        F behind[4], hard[4], gone[4];
        if (j > 0)
            for (int l = 0; l < kWidth; ++l) texels[l] += map.size;
        load4(texels, behind[0], behind[1], behind[2], behind[3]);
        for (int i = 0; i < 4; ++i) {
            behind[i] = receiver - behind[i];
            hard[i] = sel(behind[i] > none, one, none);
        }
        hard_row[j] = (hard[1] + hard[2]) + mad(fu, hard[3] - hard[0], hard[0]);
        soft_row[j] = none;
        // In front of all four, nothing is gone. A texel that is NaN is not in front.
        if (!soft || all(((behind[0] <= none) & (behind[1] <= none)) & ((behind[2] <= none) & (behind[3] <= none)))) continue;
        for (int i = 0; i < 4; ++i) gone[i] = faded((one - behind[i] * F(fade.scale)) * left);
        soft_row[j] = (gone[1] + gone[2]) + mad(fu, gone[3] - gone[0], gone[0]);
    }
    HiddenShares hidden;
    hidden.hard = sel(at.inside, ((hard_row[1] + hard_row[2]) + mad(fv, hard_row[3] - hard_row[0], hard_row[0])) * ninth, none);
    hidden.soft = hidden.hard;
    if (soft) hidden.soft = sel(at.inside, ((soft_row[1] + soft_row[2]) + mad(fv, soft_row[3] - soft_row[0], soft_row[0])) * ninth, none);
    if (map.penumbra > 0.0f) return penumbra_share(map, at, receiver, normal, texel, hidden, fade, left, soft);
    return hidden;
}

/// Hidden shares of a light that may have a size: the means over its points. A point without a map is seen.
HALFLIT_INLINE HiddenShares hidden_share(const shading::ShadingPlan& frame, const shading::LightPlan& light, V3 position, V3 normal,
                                         V3 to_light, ShadowFade fade, bool soft) {
    const shading::ShadowMapPlan* map = &frame.shadow_maps[static_cast<std::size_t>(light.shadow_map)];
    HiddenShares sum{F(0.0f), F(0.0f)};
    for (;;) {
        const HiddenShares one = hidden_share(*map, position, normal, to_light, fade, soft);
        if (light.shadow_points == 1) return one;
        sum = {sum.hard + one.hard, sum.soft + one.soft};
        if (map->next == 0) break;
        map += map->next;
    }
    const F points(static_cast<float>(light.shadow_points));
    return {vdiv(sum.hard, points), vdiv(sum.soft, points)};
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
