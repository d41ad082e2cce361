// Light in cells: lobe, attenuation and highlight of a light over a cell, with bounds on their derivatives. Derived in
// budget/DERIVATION.md, "Light in cells".
#pragma once

#include "shading/kernels/lobe_kernel.hpp"
#include "shading/kernels/surface_kernel.hpp"
#include "shading/light_cell.hpp"
#include "shading/model/formulas.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// By how much N.L at a pixel may differ from that of exact arithmetic.
inline constexpr float kCosineError = 5e-7f;

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
    // Closer than the margin of LightCuller: a light that is culled there is dark here, whichever cells are together.
    if (light.cutoff_squared > 0.0f) outside = outside | (near_squared > F(light.cutoff_squared * 1.00003f));
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
    const F chord = vsqrt(dot(apart, apart)), reach = nu + (F(2.0f) * turn + F(1e-6f)) * inv_half + F(1e-5f);
    const F near = vmax(chord - reach, none), far = chord + reach;
    const F cosine_most = vmax(one - F(0.5f) * near * near, none), cosine_least = one - F(0.5f) * far * far;
    const F squared_most = cosine_most * cosine_most;
    const auto power_of = [&](F c, F versine) __attribute__((always_inline)) {
        return power_of_cosine(shading::PowTier::exact, c * c, versine * (one + c), F(tolerance.half_exponent));
    };
    const M no_direction = s.squared < F(1e-4f);  // light against the view: H may turn anywhere
    const F power_most = sel(no_direction, one, power_of(cosine_most, F(0.5f) * near * near) * F(1.00001f));
    s.most = s.most * power_most;
    if (material.specular_curve.squarings >= 0)
        s.most = sel((!no_direction) & (squared_most < F(material.specular_curve.least)), none, s.most);
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
    // C^(s-k) is at most C^s over the least C^k. Below s = 2 the factors s - 1 and s - 2 change sign.
    const F k1 = exponent * inv, k2 = k1 * (vabs(exponent - one) * inv), k3 = k2 * (vabs(exponent - F(2.0f)) * inv), c1c1 = c1 * c1;
    const Bounds power{power_most, power_most * (k1 * c1), power_most * (k2 * c1c1 + k1 * c2),
                       power_most * (k3 * (c1c1 * c1) + F(3.0f) * (k2 * (c1 * c2)) + k1 * c3)};
    // The logarithm of a highlight is as wrong as its angle, times sqrt(2 s) and more.
    const F rounding = F(4e-6f) + F(2e-6f) * vsqrt(exponent);
    const F off = remainder(product(product(attenuation, cosine), power), rounding) + F(kCosineError) * (attenuation.f * power_most);
    s.off = sel(smooth, F(tolerance.peak) * off, F(shading::kNoCell));
    const F u = dot(normal, s.half) * inv_half;
    s.power = sel(smooth, power_of(u, F(0.5f) * chord * chord), none);
    return s;
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
