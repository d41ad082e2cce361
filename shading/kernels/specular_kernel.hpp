// Highlights of a light: cosine powers about the half vector or the mirrored light.
#pragma once

#include "shading/kernels/pow.hpp"
#include "shading/kernels/vector.hpp"
#include "shading/plan/plan.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// A material's highlights, as planned.
struct SpecularShape {
    SpecularModel kind;
    shading::PowTier tier;
    float threshold;  ///< see MaterialPlan
    const shading::SpecularCurve& curve;
    F half_exponent;
    F normalization;
};

/// The angle of a highlight, between the unit vector `axis` and `turning`, which is not normalised. Blinn: N and H = L + V. Phong: V and
/// the mirrored light R = 2 (N.L) N - L. R turns twice as fast as H, so a quarter of the exponent gives a highlight of the same width.
struct SpecularAngle {
    V3 axis, turning;
    F cosine;   ///< axis . turning
    F squared;  ///< |turning|^2
};
HALFLIT_INLINE SpecularAngle specular_angle(const SpecularShape& shape, V3 normal, V3 to_eye, V3 to_light, F n_dot_l) {
    V3 axis = normal, turning = to_light + to_eye;
    if (shape.kind == SpecularModel::phong) {
        const F twice = n_dot_l + n_dot_l;
        axis = to_eye;
        turning = {mad(twice, normal.x, F(0.0f) - to_light.x), mad(twice, normal.y, F(0.0f) - to_light.y),
                   mad(twice, normal.z, F(0.0f) - to_light.z)};
    }
    return {axis, turning, dot(axis, turning), dot(turning, turning)};
}

/// A highlight is (N.H)^s (N.L) or (V.R)^(s/4) (N.L) where both cosines are positive, else 0: wrapped light makes no highlight. Both ways
/// to compute it have two halves, the argument and the power, so that a loop over lights can run many of the first half side by side, then
/// many of the second.
struct SpecularArgument {
    F cosine_squared;  ///< cos^2
    F sine_squared;    ///< sin^2; by log2 and exp2 only
    F height;          ///< N.L where there is a highlight, else 0
};

/// By log2 and exp2. The squared sine, |N x H|^2 / |H|^2, keeps its digits where the cosine is nearly 1.
struct PowerHighlight {
    static constexpr bool kNeedsSine = true;
    const SpecularShape& shape;

    HALFLIT_INLINE F half_exponent() const {
        return shape.kind == SpecularModel::phong ? shape.half_exponent * F(0.25f) : shape.half_exponent;
    }
    /// False if no lane has a highlight: `out` is not changed then.
    HALFLIT_INLINE bool argument(V3 normal, V3 to_eye, V3 to_light, F n_dot_l, F brightness, SpecularArgument& out) const {
        const SpecularAngle at = specular_angle(shape, normal, to_eye, to_light, n_dot_l);
        const F cosine = at.cosine, squared = at.squared;
        M shines = vmin(n_dot_l, cosine) > F(0.0f);
        if (shape.threshold > 0.0f) {
            // cos^s <= e^-z <= 8! / z^8 with z = s/2 sin^2. Where this bound is below the threshold, the highlight is left out before any
            // division or logarithm. Short turning vectors are kept, because the eighth power of their length underflows.
            const F z = half_exponent() * (squared - cosine * cosine);
            const F z2 = z * z, h2 = squared * squared, z4 = z2 * z2, h4 = h2 * h2;
            const M bright = (brightness * shape.normalization) * (h4 * h4) > F(shape.threshold * (1.0f / 40320.0f)) * (z4 * z4);
            shines = shines & (bright | (squared < F(0.01f)));
        }
        if (!any(shines)) return false;
        const V3 sine = cross(at.axis, at.turning);
        const F inv_squared = vdiv(F(1.0f), vmax(squared, F(1e-30f)));
        out.cosine_squared = (cosine * cosine) * inv_squared;
        out.sine_squared = dot(sine, sine) * inv_squared;
        out.height = sel(shines, n_dot_l, F(0.0f));
        return true;
    }
    HALFLIT_INLINE F value(F cosine_squared, F sine_squared, F height) const {
        return sel(height > F(0.0f), height * power_of_cosine(shape.tier, cosine_squared, sine_squared, half_exponent()), F(0.0f));
    }
};

/// By MaterialPlan::specular_curve: 0 where cos^2 is less than `least`. In a lane that is 0, cos^2 is clamped to `least`, so that its
/// squares do not become denormals, which are slow.
struct CurveHighlight {
    static constexpr bool kNeedsSine = false;
    const SpecularShape& shape;

    /// As PowerHighlight's. `out` is always set: the division is cheaper than a branch that is foretold wrongly.
    HALFLIT_INLINE bool argument(V3 normal, V3 to_eye, V3 to_light, F n_dot_l, F, SpecularArgument& out) const {
        const F least(shape.curve.least), none(0.0f);
        const SpecularAngle at = specular_angle(shape, normal, to_eye, to_light, n_dot_l);
        const F cosine_squared = at.cosine * at.cosine;
        const M shines = (vmin(n_dot_l, at.cosine) > none) & (cosine_squared > least * at.squared);
        out.cosine_squared = vmax(vdiv(cosine_squared, at.squared), least);
        out.height = sel(shines, n_dot_l, none);
        return any(shines);
    }
    HALFLIT_INLINE F value(F cosine_squared, F, F height) const {
        using shading::SpecularCurve;
        const SpecularCurve& curve = shape.curve;
        F power = curve.terms == SpecularCurve::kFewTerms ? polynomial_by_pairs<SpecularCurve::kFewTerms>(curve.c, cosine_squared)
                                                          : polynomial_by_pairs<SpecularCurve::kMostTerms>(curve.c, cosine_squared);
        for (int i = 0; i < curve.squarings; ++i) power = power * power;
        return sel(height > F(0.0f), height * power, F(0.0f));
    }
};

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
