// Light in cells: the extent of a cell, the polynomial of the lights that may be fitted there, and its value at pixels. The bounds are
// derived in budget/DERIVATION.md, "Light in cells".
#pragma once

#include "shading/kernels/lobe_kernel.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/kernels/surface_kernel.hpp"
#include "shading/light_cell.hpp"
#include "shading/plan/plan.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Writes centre and radii of a block's fragments as cell `cell` of the batch.
static void measure_cell(const shading::MaterialPlan& material, const shading::FragmentBlock& block, int count, shading::CellBatch& batch,
                         int cell) {
    const auto inputs = [&](int lane, F(&out)[6]) __attribute__((always_inline)) {
        const V3 normal = normals(material, block, lane).shading, position = row3(block, shading::kPosX, lane);
        out[0] = normal.x, out[1] = normal.y, out[2] = normal.z;
        out[3] = position.x, out[4] = position.y, out[5] = position.z;
    };
    F value[6], least[6], most[6];
    inputs(0, value);
    for (int i = 0; i < 6; ++i) least[i] = most[i] = value[i];
    for (int lane = kWidth; lane < count; lane += kWidth) {
        inputs(lane, value);
        for (int i = 0; i < 6; ++i) {
            least[i] = vmin(least[i], value[i]);
            most[i] = vmax(most[i], value[i]);
        }
    }
    float center[6];
    bool flat = true;
    for (int i = 0; i < 6; ++i) {
        float low[kWidth], high[kWidth];
        store(low, least[i]);
        store(high, most[i]);
        for (int l = 1; l < kWidth; ++l) {
            low[0] = vmin(low[0], low[l]);
            high[0] = vmax(high[0], high[l]);
        }
        center[i] = 0.5f * low[0] + 0.5f * high[0];
        if (i < 3) flat &= low[0] == high[0];
    }
    const float squared = (center[0] * center[0] + center[1] * center[1]) + center[2] * center[2];
    bool usable = squared > 0.25f;
    if (!flat) {
        const float inv = 1.0f / vsqrt(vmax(squared, 0.25f));
        for (int i = 0; i < 3; ++i) center[i] = center[i] * inv;
    }
    // The largest distances from the centre. Minima and maxima lose NaN, so it is looked for here.
    F normal_squared(0.0f), position_squared(0.0f);
    for (int lane = 0; lane < count; lane += kWidth) {
        inputs(lane, value);
        for (int i = 0; i < 6; ++i) value[i] = value[i] - F(center[i]);
        const F n = dot(V3{value[0], value[1], value[2]}, V3{value[0], value[1], value[2]});
        const F p = dot(V3{value[3], value[4], value[5]}, V3{value[3], value[4], value[5]});
        usable = usable && all((n < F(8.0f)) & (p < F(1e36f)));
        normal_squared = vmax(n, normal_squared);
        position_squared = vmax(p, position_squared);
    }
    float n[kWidth], p[kWidth];
    store(n, normal_squared);
    store(p, position_squared);
    for (int l = 1; l < kWidth; ++l) {
        n[0] = vmax(n[0], n[l]);
        p[0] = vmax(p[0], p[l]);
    }
    for (int i = 0; i < 3; ++i) {
        batch.normal[i][cell] = usable ? center[i] : i == 2 ? 1.0f : 0.0f;
        batch.position[i][cell] = usable ? center[i + 3] : 0.0f;
    }
    constexpr float kMargin = 1.00001f;
    batch.normal_radius[cell] = !usable ? shading::kNoCell : flat ? 0.0f : kMargin * vsqrt(n[0]) + 1e-6f;
    batch.position_radius[cell] = usable ? kMargin * vsqrt(p[0]) : shading::kNoCell;
}

/// A lobe over the cosines of a cell: values and derivatives at the centre, and the largest absolute values in the cell.
struct LobeSpan {
    F value, slope, bend;         ///< f, f', f'' at the centre
    F most, most1, most2, most3;  ///< of f, |f'|, |f''|, |f'''|
    F least;                      ///< of f
    M whole;                      ///< no cosine of the cell is in the dark, where the lobe has another formula
};

/// x: cosine at the centre; move: the largest difference from it. Powers from 1 to 3.
HALFLIT_INLINE LobeSpan lobe_span(const shading::LobePlan& lobe, F x, F move) {
    using shading::LobePath;
    const F inv(lobe.inv_one_plus_wrap), none(0.0f), one(1.0f);
    const F raw_low = (x - move + F(lobe.wrap)) * inv - F(1e-6f);
    const F high = clamp((x + move + F(lobe.wrap)) * inv + F(1e-6f), none, one);
    const F low = clamp(raw_low, none, one), t = clamp((x + F(lobe.wrap)) * inv, none, one);
    const F n(lobe.power_minus_one + 1.0f);
    LobeSpan s{};
    s.whole = raw_low > none;
    if (lobe.path == LobePath::linear) {
        s.value = t, s.slope = inv, s.bend = none;
        s.most = high, s.most1 = inv, s.most2 = none, s.most3 = none;
        s.least = low;
    } else if (lobe.path == LobePath::square) {
        const F twice = inv + inv;
        s.value = t * t, s.slope = twice * t, s.bend = twice * inv;
        s.most = high * high, s.most1 = twice * high, s.most2 = twice * inv, s.most3 = none;
        s.least = low * low;
    } else {
        const auto power = [&](F at) __attribute__((always_inline)) {
            return power_of_unit(at, lobe.power_minus_one, lobe.power_minus_one_high, lobe.power_minus_one_low);
        };
        const F safe_low = vmax(low, F(1e-6f)), safe = vmax(t, F(1e-6f)), safe_high = vmax(high, F(1e-6f));
        const F by_low = vdiv(one, safe_low), by = vdiv(one, safe), by_high = vdiv(one, safe_high);
        const F f1 = n * inv, f2 = f1 * (F(lobe.power_minus_one) * inv), f3 = f2 * (vabs(n - F(2.0f)) * inv);
        s.value = power(safe), s.least = power(safe_low), s.most = power(safe_high);
        s.slope = f1 * (s.value * by), s.bend = f2 * (s.value * by * by);
        s.most1 = f1 * (s.most * by_high);
        // t^(n-2) falls below n = 2 and rises above; t^(n-3) falls up to n = 3.
        s.most2 = f2 * vmax(s.least * by_low * by_low, s.most * by_high * by_high);
        s.most3 = f3 * (s.least * by_low * by_low * by_low);
        s.least = sel(s.whole, s.least, none);
    }
    return s;
}

/// A light as a cell meets it.
struct CellArrival {
    V3 direction;       ///< to the light, from the centre
    F base, window;     ///< attenuation at the centre = base - window: 1 / d^2, and d^2 / range^4
    F least, most;      ///< of the attenuation in the cell
    F share, turn;      ///< r / d, and r / (d - r): the largest change of direction
    M usable, outside;  ///< the attenuation is smooth in the whole cell; is 0 there
};

HALFLIT_INLINE CellArrival cell_arrival(const shading::LightPlan& light, V3 position, F radius) {
    const F none(0.0f), one(1.0f);
    if (light.type == LightType::directional)
        return {broadcast(light.to_light), one, none, one, one, none, none, radius < F(shading::kNoCell), one < none};
    const V3 offset = broadcast(light.position) - position;
    const F squared = dot(offset, offset), inv_distance = vdiv(one, vsqrt(vmax(squared, F(1e-36f))));
    const F distance = squared * inv_distance, near = vmax(distance - radius, none), far = distance + radius;
    const F share = radius * inv_distance, near_squared = near * near, far_squared = far * far;
    const F inv_range(light.inv_range_squared);
    M usable = (share < F(0.25f)) & (near_squared * F(0.9999f) >= F(light.min_distance_squared)) & (far_squared * inv_range <= F(0.9999f)) &
               (far_squared < F(1e36f));
    M outside = near_squared * inv_range > F(1.0001f);
    if (light.cutoff_squared > 0.0f) outside = outside | (near_squared > F(light.cutoff_squared * 1.0001f));
    const V3 direction = offset * inv_distance;
    const F grown = vdiv(one, one - vmin(share, F(0.25f))), turn = share * grown;
    if (light.type == LightType::spot) {
        const V3 off_axis = direction - broadcast(light.to_light);
        const F chord = vsqrt(dot(off_axis, off_axis)), inner = vmax(chord - turn, none), outer = chord + turn;
        outside = outside | (usable & (F(0.5f) * inner * inner > F(light.cone_cutoff * 1.0001f + 1e-6f)));
        const float whole = light.half_cone_power > 0.0f ? -1.0f : (light.cone_cutoff - 1.0f / light.cone_scale) * 0.9999f - 1e-6f;
        usable = usable & (F(0.5f) * outer * outer <= F(whole));
    }
    const F base = inv_distance * inv_distance, per_range = squared * inv_range * inv_range;
    const F least = vmax(vdiv(F(0.999f), far_squared) - far_squared * inv_range * inv_range, none);
    return {direction, base, per_range, least, base * grown * grown, share, turn, usable, outside};
}

/// Largest values of a function along any line from the centre into the cell, and of its derivatives.
struct Bounds {
    F f, d1, d2, d3;
};
HALFLIT_INLINE Bounds product(const Bounds& a, const Bounds& b) {
    const F two(2.0f), three(3.0f);
    return {a.f * b.f, a.d1 * b.f + a.f * b.d1, a.d2 * b.f + two * (a.d1 * b.d1) + a.f * b.d2,
            a.d3 * b.f + three * (a.d2 * b.d1 + a.d1 * b.d2) + a.f * b.d3};
}
/// Bound on the remainder of the expansion to the second order. rounding: relative error of the terms.
HALFLIT_INLINE F remainder(const Bounds& b, F rounding) { return b.d3 * F(1.0f / 6.0f) + rounding * (b.f + b.d1 + b.d2); }

/// The eye as a cell meets it.
struct CellEye {
    V3 direction;   ///< to the eye, from the centre
    F share, turn;  ///< r / distance, and the largest change of direction; 0: orthographic
};
HALFLIT_INLINE CellEye cell_eye(const shading::ShadingPlan& frame, V3 position, F radius) {
    const F none(0.0f);
    CellEye eye{view_vector(frame, position), none, none};
    if (!frame.orthographic) {
        const V3 offset = broadcast(frame.eye_ws) - position;
        const F distance = vsqrt(dot(offset, offset)), near = distance * F(0.9999f) - radius;
        eye.share = vdiv(radius, vmax(distance, F(1e-30f)));
        eye.turn = sel(near > none, vdiv(radius, vmax(near, F(1e-30f))), F(4.0f));
    }
    return eye;
}

/// A light's highlight (N.H)^s N.L over a cell: bounds without the light's colour, with the normalisation.
struct HighlightSpan {
    V3 half;           ///< H = L + V at the centre, not normalised
    F squared, power;  ///< |H|^2; (N.H)^s at the centre
    F most, off;       ///< bound on its sum at a pixel; bound on the remainder of its expansion, kNoCell: there is none
};
HALFLIT_INLINE HighlightSpan highlight_span(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, const CellArrival& at,
                                            const CellEye& eye, V3 normal, F nu, const Bounds& attenuation, const Bounds& cosine,
                                            F x_least) {
    const F none(0.0f), one(1.0f);
    const shading::CellTolerance& tolerance = material.cells;
    HighlightSpan s{normal, one, none, F(tolerance.peak) * attenuation.f * cosine.f, F(shading::kNoCell)};
    if (frame.specular == SpecularModel::phong) return s;
    s.half = at.direction + eye.direction;
    s.squared = vmax(dot(s.half, s.half), F(1e-12f));
    const F length = vsqrt(s.squared), inv_half = vdiv(one, length), turn = at.turn + eye.turn;
    const V3 apart = normal - s.half * inv_half;
    const F chord = vsqrt(dot(apart, apart)), reach = nu + F(2.0f) * turn * inv_half + F(1e-5f);
    const F near = vmax(chord - reach, none), far = chord + reach;
    const F cosine_most = vmax(one - F(0.5f) * near * near, none), cosine_least = one - F(0.5f) * far * far;
    const F squared_most = cosine_most * cosine_most;
    const auto power_of = [&](F c, F versine) __attribute__((always_inline)) {
        return power_of_cosine(shading::PowTier::exact, c * c, versine * (one + c), F(tolerance.half_exponent));
    };
    const F power_most = power_of(cosine_most, F(0.5f) * near * near) * F(1.00001f);
    s.most = s.most * power_most;
    if (material.specular_curve.squarings >= 0) s.most = sel(squared_most < F(material.specular_curve.least), none, s.most);
    if (has(material, kStageMetallicRoughnessTexture)) return s;
    // The expansion: H has a bounded direction, N.H is not near 0, N.L not at its edge.
    const F shortest = length - turn;
    const M smooth = (shortest > F(0.1f)) & (cosine_least > F(0.05f)) & (x_least > none) & (eye.turn < F(0.25f)) & (s.most > none);
    if (!any(smooth)) return s;
    const F inv_shortest = vdiv(one, vmax(shortest, F(0.1f)));
    const F l2 = at.turn * at.turn, v2 = eye.turn * eye.turn;
    const F g1 = turn * inv_shortest, g2 = F(1.5f) * (l2 + v2) * inv_shortest,
            g3 = F(3.75f) * (l2 * at.turn + v2 * eye.turn) * inv_shortest;
    const F h1 = g1, h2 = F(1.5f) * (g1 * g1) + g2, h3 = (F(3.75f) * (g1 * g1) + F(4.5f) * g2) * g1 + g3;
    const F c1 = nu * (far + nu) + far * h1, c2 = F(2.0f) * (nu * h1) + h2, c3 = F(3.0f) * (nu * h2) + h3;
    const F exponent(2.0f * tolerance.half_exponent), inv = vdiv(one, vmax(cosine_least, F(0.05f)));
    const F sc = exponent * inv, sc1 = sc * c1;
    const Bounds power{power_most, power_most * sc1, power_most * (sc1 * sc1 + sc * c2),
                       power_most * (sc1 * (sc1 * sc1) + F(3.0f) * (sc1 * (sc * c2)) + sc * c3)};
    // The logarithm of a highlight is as wrong as its angle, times sqrt(2 s) and more.
    const F rounding = F(4e-6f) + F(2e-6f) * vsqrt(exponent);
    s.off = sel(smooth, F(tolerance.peak) * remainder(product(product(attenuation, cosine), power), rounding), F(shading::kNoCell));
    const F u = dot(normal, s.half) * inv_half;
    s.power = sel(smooth, power_of(u, F(0.5f) * chord * chord), none);
    return s;
}

/// A polynomial's terms for one light, before its colour.
struct CellSum {
    F term[shading::kCellTerms];
};

/// Index of the pair i <= j among the six.
HALFLIT_INLINE constexpr int pair_index(int i, int j) { return i == 0 ? j : i + j + 1; }

HALFLIT_INLINE F axis(const V3& v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }

/// Adds (x.v)(y.v), v being n or p: `first` is kTermNN or kTermPP.
HALFLIT_INLINE void add_square(CellSum& sum, int first, V3 x, V3 y) {
    for (int i = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j) {
            F& term = sum.term[first + pair_index(i, j)];
            term = mad(axis(x, i), axis(y, j), term);
            if (i != j) term = mad(axis(x, j), axis(y, i), term);
        }
}
/// Adds (x.n)(y.p).
HALFLIT_INLINE void add_mixed(CellSum& sum, V3 x, V3 y) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            F& term = sum.term[shading::kTermNP + 3 * i + j];
            term = mad(axis(x, i), axis(y, j), term);
        }
}
/// Begins a sum: 1, n, p, and factors of n.p and p.p.
HALFLIT_INLINE CellSum begin_sum(F constant, V3 n, V3 p, F n_dot_p, F p_dot_p) {
    const F none(0.0f);
    CellSum sum;
    sum.term[0] = constant;
    for (int i = 0; i < 3; ++i) {
        sum.term[shading::kTermN + i] = axis(n, i);
        sum.term[shading::kTermP + i] = axis(p, i);
        for (int j = 0; j < 3; ++j) sum.term[shading::kTermNP + 3 * i + j] = i == j ? n_dot_p : none;
        for (int j = i; j < 3; ++j) {
            sum.term[shading::kTermNN + pair_index(i, j)] = none;
            sum.term[shading::kTermPP + pair_index(i, j)] = i == j ? p_dot_p : none;
        }
    }
    return sum;
}
/// terms += color * sum. kFlat: without the terms that have n.
template <bool kFlat>
HALFLIT_INLINE void add_light(F (&terms)[shading::kCellTerms][3], const CellSum& sum, const float (&color)[3]) {
    for (int c = 0; c < 3; ++c) {
        const F factor(color[c]);
        for (int t = 0; t < shading::kCellTerms; ++t) {
            const bool with_n = (t >= shading::kTermN && t < shading::kTermP) || (t >= shading::kTermNN && t < shading::kTermPP);
            if (!kFlat || !with_n) terms[t][c] = mad(factor, sum.term[t], terms[t][c]);
        }
    }
}

/// Attenuation times lobe to the second order, about the centre.
template <bool kFlat>
HALFLIT_INLINE CellSum expand_lobe(const CellArrival& at, V3 to_light, V3 normal, F x, F value, F slope, F bend) {
    const F two(2.0f), half(0.5f);
    const F a0 = at.base - at.window, sum = at.base + at.window, s = at.share;
    const F k_g = a0 * slope, k_gg = half * (a0 * bend), k_sx = k_g * x, k_bx = a0 * bend * x;
    const F k_a = two * (sum * value) + k_sx, k_ag = two * (sum * slope) + k_g + k_bx;
    const F k_aa = F(4.0f) * (at.base * value) + x * (two * (sum * slope) + F(1.5f) * k_g + half * k_bx);
    const F k_q = F(0.0f) - (sum * value + half * k_sx);
    const V3 y = to_light * s, m = normal * s;
    CellSum out = begin_sum(a0 * value, to_light * k_g, y * k_a - m * k_g, F(0.0f) - k_g * s, k_q * s * s);
    add_square(out, shading::kTermPP, y, y * k_aa - m * k_ag);
    add_square(out, shading::kTermPP, m * k_gg, m);
    if constexpr (!kFlat) {
        add_square(out, shading::kTermNN, to_light * k_gg, to_light);
        add_mixed(out, to_light, y * k_ag - m * (two * k_gg));
    }
    return out;
}

/// Attenuation times highlight, (N.H)^s N.L, to the second order, about the centre.
template <bool kFlat>
HALFLIT_INLINE CellSum expand_highlight(const CellArrival& at, const CellEye& eye, const HighlightSpan& span, V3 to_light, V3 normal, F x,
                                        F exponent) {
    const F two(2.0f), half(0.5f), three_halves(1.5f), one(1.0f);
    const F s_l = at.share, s_v = eye.share, both = s_l + s_v;
    const V3 v = eye.direction, y = to_light * s_l, w = v * s_v, t = v * s_l + to_light * s_v;
    const F c = dot(to_light, v), n_dot_v = dot(normal, v);
    const F inv_squared = vdiv(one, span.squared), inv_u = vdiv(one, dot(normal, span.half)), rho = exponent * inv_u;
    // N.H = U (1 + (H.n + d.p) / U ..), |H|^2 = squared (1 - 2 e.p / squared ..), (N.H / |H|)^s = power (1 + z_n.n + z_p.p ..)
    const V3 d = y * x + w * n_dot_v - normal * both, e = t - (y + w) * c;
    const V3 z_n = span.half * rho, z_p = d * rho + e * (exponent * inv_squared);
    const F a0 = span.power * (at.base - at.window), sum = span.power * (at.base + at.window), base = span.power * at.base;
    const F k = two * sum + a0, y0 = a0 * x, ry = rho * y0, sigma = exponent * y0 * inv_squared;
    const V3 y_p = y * (k * x) - normal * (a0 * s_l);
    const V3 a_n = to_light * a0 + z_n * (half * y0), a_p = y_p + z_p * (half * y0);
    const F curl = F(0.0f) - half * ry * inv_u;  // -s y0 / (2 U^2)
    const F squares = s_l * s_l + s_v * s_v;
    const F p_dot_p = (F(0.0f) - (sum * x + half * (a0 * x)) * (s_l * s_l)) - half * ry * (x * (s_l * s_l) + n_dot_v * (s_v * s_v)) -
                      sigma * (s_l * s_v - half * c * squares);
    CellSum out = begin_sum(y0, to_light * a0 + z_n * y0, y_p + z_p * y0, F(0.0f) - (a0 * s_l + ry * both), p_dot_p);
    const F k_yy = F(4.0f) * (base * x) + two * (sum * x) + three_halves * (a0 * x) + three_halves * (ry * x - c * sigma);
    add_square(out, shading::kTermPP, a_p, z_p);
    add_square(out, shading::kTermPP, d * curl, d);
    add_square(out, shading::kTermPP, e * (sigma * inv_squared), e);
    add_square(out, shading::kTermPP, y, y * k_yy - normal * ((k + ry) * s_l) - w * (c * sigma) + t * sigma);
    add_square(out, shading::kTermPP, w, w * (three_halves * (ry * n_dot_v - c * sigma)) - normal * (ry * s_v) + t * sigma);
    if constexpr (!kFlat) {
        add_square(out, shading::kTermNN, a_n, z_n);
        add_square(out, shading::kTermNN, span.half * curl, span.half);
        add_mixed(out, a_n, z_p);
        add_mixed(out, z_n, a_p);
        add_mixed(out, span.half * (two * curl), d);
        add_mixed(out, to_light, y * (k + ry));
        add_mixed(out, v, w * ry);
    }
    return out;
}

/// kFlat: all cells are flat, and terms with n are not needed.
template <bool kSpecular, bool kFlat>
HALFLIT_INLINE void fit_lanes(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::LightList lights,
                              shading::CellBatch& batch, std::uint16_t* exact, int lane) {
    const F none(0.0f), one(1.0f);
    const V3 normal{load(batch.normal[0] + lane), load(batch.normal[1] + lane), load(batch.normal[2] + lane)};
    const V3 position{load(batch.position[0] + lane), load(batch.position[1] + lane), load(batch.position[2] + lane)};
    const F nu = load(batch.normal_radius + lane), radius = load(batch.position_radius + lane);
    const shading::CellTolerance& tolerance = material.cells;
    const F relative(tolerance.relative), absolute(tolerance.absolute), exponent(2.0f * tolerance.half_exponent);
    const bool no_edge =
        material.lobe.wrap == 1.0f && (material.lobe.path == shading::LobePath::linear || material.lobe.path == shading::LobePath::square);
    const M cell_usable = nu < F(0.25f);
    CellEye eye{};
    if constexpr (kSpecular) eye = cell_eye(frame, position, radius);
    F error[3] = {none, none, none}, known[3] = {none, none, none}, dropped(0.0f);
    F term[shading::kCellTerms][3], highlight[shading::kCellTerms][3];
    for (int t = 0; t < shading::kCellTerms; ++t)
        for (int c = 0; c < 3; ++c) term[t][c] = highlight[t][c] = none;
    std::uint32_t shining = 0;

    for (int i = 0; i < lights.count; ++i) {
        const shading::LightPlan& light = lights.lights[i];
        if (light.shadow_map >= 0) {
            exact[i] = 0xffff;
            continue;
        }
        const CellArrival at = cell_arrival(light, position, radius);
        const F x = dot(normal, at.direction), move = nu + at.turn + F(1e-6f);
        const M known_turn = at.usable & cell_usable;  // elsewhere the turn has no meaning
        const M dark = at.outside | (known_turn & (x + move + F(1e-5f) <= F(-material.lobe.wrap)));
        if (all(dark)) continue;
        const M candidate = known_turn & !dark;
        const LobeSpan f = lobe_span(material.lobe, x, move);
        const M whole = no_edge ? one > none : f.whole;
        // Bounds along any line from the centre into the cell: on N.L, the lobe, the attenuation.
        const F turn = at.turn, turn2 = turn * turn, nu_turn = nu * turn, reach = at.share * (one + at.share);
        const Bounds cosine{clamp(x + move, none, one), nu + turn, F(2.0f) * nu_turn + F(1.5f) * turn2,
                            (F(4.5f) * nu_turn + F(3.75f) * turn2) * turn};
        const F c1 = cosine.d1, c1c1 = c1 * c1;
        const Bounds lobe{f.most, f.most1 * c1, f.most2 * c1c1 + f.most1 * cosine.d2,
                          f.most3 * (c1c1 * c1) + F(3.0f) * (f.most2 * (c1 * cosine.d2)) + f.most1 * cosine.d3};
        const Bounds attenuation{at.most, F(2.0f) * (turn * at.most + at.window * reach),
                                 F(6.0f) * (turn2 * at.most) + F(2.0f) * (at.window * at.share * at.share),
                                 F(24.0f) * (turn2 * turn * at.most)};
        // At the edge of the dark, the light is left out.
        F off = sel(whole, remainder(product(attenuation, lobe), F(4e-6f)), at.most * f.most), shine(0.0f);
        HighlightSpan span{};
        M expanded = one < none;
        if constexpr (kSpecular) {
            span = highlight_span(frame, material, at, eye, normal, nu, attenuation, cosine, x - move);
            // A highlight that is weaker than the lobe's own error is not worth its expansion.
            expanded = (span.off < span.most) & ((F(tolerance.specular_ratio) * span.most > off) | (F(tolerance.specular_ratio) == none));
            shine = sel(expanded, span.off, span.most);
            off = off + F(tolerance.specular_ratio) * shine;
            shine = shine * F(light.brightness);
        }
        const F sure = sel(candidate, F(0.999f) * (at.least * f.least), none);
        M accept = candidate;
        if constexpr (kSpecular) accept = accept & (dropped + shine <= F(tolerance.absolute_specular));
        for (int c = 0; c < 3; ++c) {
            const F color(light.color[c]);
            known[c] = known[c] + sure * color;
            accept = accept & (error[c] + off * color <= relative * known[c] + absolute);
        }
        exact[i] = static_cast<std::uint16_t>(exact[i] | (mask_bits(!dark & !accept) << lane));
        if (!any(accept)) continue;
        for (int c = 0; c < 3; ++c) error[c] = error[c] + sel(accept, off * F(light.color[c]), none);
        const M fitted = accept & whole;
        if (any(fitted)) {
            CellArrival kept = at;
            kept.share = sel(fitted, at.share, none);
            const V3 to_light{sel(fitted, at.direction.x, none), sel(fitted, at.direction.y, none), sel(fitted, at.direction.z, none)};
            add_light<kFlat>(term,
                             expand_lobe<kFlat>(kept, to_light, normal, x, sel(fitted, f.value, none), sel(fitted, f.slope, none),
                                                sel(fitted, f.bend, none)),
                             light.color);
        }
        if constexpr (kSpecular) {
            dropped = dropped + sel(accept, shine, none);
            const M shines = accept & expanded;
            if (!any(shines)) continue;
            shining |= mask_bits(shines);
            CellArrival kept = at;
            kept.share = sel(shines, at.share, none);
            CellEye kept_eye = eye;
            kept_eye.share = sel(shines, eye.share, none);
            HighlightSpan kept_span = span;
            kept_span.power = sel(shines, span.power, none);
            // Where nothing is expanded, H = N keeps the quotients finite.
            kept_span.half = {sel(shines, span.half.x, normal.x), sel(shines, span.half.y, normal.y), sel(shines, span.half.z, normal.z)};
            kept_span.squared = sel(shines, span.squared, one);
            const V3 to_light{sel(shines, at.direction.x, normal.x), sel(shines, at.direction.y, normal.y),
                              sel(shines, at.direction.z, normal.z)};
            add_light<kFlat>(highlight, expand_highlight<kFlat>(kept, kept_eye, kept_span, to_light, normal, x, exponent), light.color);
        }
    }
    batch.shining |= shining << lane;
    for (int t = 0; t < shading::kCellTerms; ++t)
        for (int c = 0; c < 3; ++c) {
            store(batch.term[t][c] + lane, term[t][c]);
            if constexpr (kSpecular) store(batch.highlight[t][c] + lane, highlight[t][c]);
        }
}

/// Fits the lights to each cell of the batch. exact[i], zero on entry: bit l is set if cell l leaves light i to its pixels.
static void fit_cells(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::LightList lights,
                      shading::CellBatch& batch, std::uint16_t* exact) {
    batch.shining = 0;
    for (int lane = 0; lane < batch.count; lane += kWidth) {
        const F radius = load(batch.normal_radius + lane);
        const bool flat = all((radius == F(0.0f)) | (radius == F(shading::kNoCell)));
        if (has(material, kStageSpecular))
            flat ? fit_lanes<true, true>(frame, material, lights, batch, exact, lane)
                 : fit_lanes<true, false>(frame, material, lights, batch, exact, lane);
        else
            flat ? fit_lanes<false, true>(frame, material, lights, batch, exact, lane)
                 : fit_lanes<false, false>(frame, material, lights, batch, exact, lane);
    }
}

/// Where a pixel is in its cell: n and p of light_cell.hpp.
struct CellPlace {
    F n[3], p[3];
    bool flat;
};
HALFLIT_INLINE CellPlace cell_place(const shading::LightCell& cell, V3 position, V3 normal) {
    const V3 p = (position - broadcast(cell.position)) * F(cell.inv_position_radius), n = normal - broadcast(cell.normal);
    return {{n.x, n.y, n.z}, {p.x, p.y, p.z}, cell.flat};
}

/// The value of a polynomial, not below 0.
HALFLIT_INLINE V3 cell_sum(const float (&terms)[shading::kCellTerms][3], const CellPlace& at) {
    F light[3];
    for (int c = 0; c < 3; ++c) {
        const auto term = [&](int t) __attribute__((always_inline)) { return F(terms[t][c]); };
        F sum = term(0);
        int pp = shading::kTermPP;
        for (int r = 0; r < 3; ++r) {
            F inner = term(shading::kTermP + r);
            for (int q = r; q < 3; ++q) inner = mad(term(pp++), at.p[q], inner);
            sum = mad(inner, at.p[r], sum);
        }
        if (!at.flat) {
            int nn = shading::kTermNN;
            for (int r = 0; r < 3; ++r) {
                F inner = term(shading::kTermN + r);
                for (int q = r; q < 3; ++q) inner = mad(term(nn++), at.n[q], inner);
                for (int q = 0; q < 3; ++q) inner = mad(term(shading::kTermNP + 3 * r + q), at.p[q], inner);
                sum = mad(inner, at.n[r], sum);
            }
        }
        light[c] = vmax(sum, F(0.0f));
    }
    return {light[0], light[1], light[2]};
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
