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

/// (N.H)^s (N.L) or (V.R)^(s/4) (N.L) where both cosines are positive, else 0: wrapped light makes no highlight. The squared sine,
/// |N x H|^2 / |H|^2, keeps its digits where the cosine is nearly 1.
HALFLIT_INLINE F specular_value(const SpecularShape& shape, V3 normal, V3 to_eye, V3 to_light, F n_dot_l, F brightness) {
    const SpecularAngle at = specular_angle(shape, normal, to_eye, to_light, n_dot_l);
    const F cosine = at.cosine, squared = at.squared;
    F half_exponent = shape.half_exponent;
    if (shape.kind == SpecularModel::phong) half_exponent = half_exponent * F(0.25f);
    M shines = vmin(n_dot_l, cosine) > F(0.0f);
    if (shape.threshold > 0.0f) {
        // cos^s <= e^-z <= 8! / z^8 with z = s/2 sin^2. Where this bound is below the threshold, the highlight is left out before any
        // division or logarithm. Short turning vectors are kept, because the eighth power of their length underflows.
        const F z = half_exponent * (squared - cosine * cosine);
        const F z2 = z * z, h2 = squared * squared, z4 = z2 * z2, h4 = h2 * h2;
        const M bright = (brightness * shape.normalization) * (h4 * h4) > F(shape.threshold * (1.0f / 40320.0f)) * (z4 * z4);
        shines = shines & (bright | (squared < F(0.01f)));
    }
    if (!any(shines)) return F(0.0f);
    const V3 sine = cross(at.axis, at.turning);
    const F inv_squared = vdiv(F(1.0f), vmax(squared, F(1e-30f)));
    const F power = power_of_cosine(shape.tier, (cosine * cosine) * inv_squared, dot(sine, sine) * inv_squared, half_exponent);
    return sel(shines, n_dot_l * power, F(0.0f));
}

/// The same by MaterialPlan::specular_curve: 0 where cos^2 is less than `least`. If that is so for all lanes, nothing is computed. In a
/// lane that is 0, cos^2 is clamped to `least`, so that its squares do not become denormals, which are slow.
HALFLIT_INLINE F curve_specular_value(const SpecularShape& shape, V3 normal, V3 to_eye, V3 to_light, F n_dot_l) {
    const shading::SpecularCurve& curve = shape.curve;
    const SpecularAngle at = specular_angle(shape, normal, to_eye, to_light, n_dot_l);
    const F cosine_squared = at.cosine * at.cosine;
    const M shines = (vmin(n_dot_l, at.cosine) > F(0.0f)) & (cosine_squared > F(curve.least) * at.squared);
    if (!any(shines)) return F(0.0f);
    using shading::SpecularCurve;
    const F x = vmax(vdiv(cosine_squared, at.squared), F(curve.least));
    F power = curve.terms == SpecularCurve::kFewTerms ? polynomial_by_pairs<SpecularCurve::kFewTerms>(curve.c, x)
                                                      : polynomial_by_pairs<SpecularCurve::kMostTerms>(curve.c, x);
    for (int i = 0; i < curve.squarings; ++i) power = power * power;
    return sel(shines, n_dot_l * power, F(0.0f));
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
