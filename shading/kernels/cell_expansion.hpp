// Light in cells: the expansion of a light about the centre of a cell, to the second order in normal and position.
#pragma once

#include "shading/kernels/cell_bounds.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

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

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
