// Direct light: for each light its direction and strength at a fragment, the diffuse lobe, and normalised Blinn-Phong.
#pragma once

#include "shading/kernels/lobe_kernel.hpp"
#include "shading/kernels/vector.hpp"
#include "shading/plan.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Sums over the lights, in list order; the material's colours are multiplied in afterwards.
struct LightSums {
    V3 diffuse{F(0.0f), F(0.0f), F(0.0f)}, specular{F(0.0f), F(0.0f), F(0.0f)};
};

/// Unit direction to a point or spot light, and its strength there: the inverse square of the distance, the window that takes it to
/// zero at `range`, and the cone.
struct LocalLight {
    V3 direction;
    F strength;
};
HALFLIT_INLINE LocalLight local_light(const shading::LightPlan& light, V3 position) {
    const V3 offset = broadcast(light.position) - position;
    const F distance_squared = dot(offset, offset);
    // Below 1e-18 the direction has no meaning and fades to zero; an infinite distance gives strength 0.
    const V3 direction = offset * vdiv(F(1.0f), vsqrt(vmax(distance_squared, F(1e-36f))));
    const F in_range = distance_squared * F(light.inv_range_squared);
    const F window = vmax(F(1.0f) - in_range * in_range, F(0.0f));
    F strength = vdiv(window, vmax(distance_squared, F(light.min_distance_squared)));
    if (light.type == shading::LightType::spot) {
        // 1 - cos of the angle to the axis, as |L - A|^2 / 2: right to the last digits for narrow cones, where a difference of cosines
        // has none left. The subtraction from the cutoff is exact near the rim.
        const V3 off_axis = direction - broadcast(light.to_light);
        const F versine = F(0.5f) * dot(off_axis, off_axis);
        const F cone = clamp((F(light.cone_cutoff) - versine) * F(light.cone_scale), F(0.0f), F(1.0f));
        strength = strength * (cone * cone);
    }
    return {direction, strength};
}

/// (N.H)^s (N.L) where both cosines are positive, else 0: wrapped light makes no highlight. H = L + V is not normalised; the
/// squared sine |N x H|^2 / |H|^2 keeps its digits where the cosine is nearly 1.
HALFLIT_INLINE F blinn_value(V3 normal, V3 to_eye, V3 to_light, F n_dot_l, F half_exponent) {
    const V3 half = to_light + to_eye;
    const F n_dot_h = dot(normal, half);
    const V3 n_cross_h = cross(normal, half);
    const F inv_squared = vdiv(F(1.0f), vmax(dot(half, half), F(1e-30f)));
    const F power = power_of_cosine((n_dot_h * n_dot_h) * inv_squared, dot(n_cross_h, n_cross_h) * inv_squared, half_exponent);
    return sel(vmin(n_dot_l, n_dot_h) > F(0.0f), n_dot_l * power, F(0.0f));
}

template <bool kSpecular>
HALFLIT_INLINE LightSums sum_lights(const shading::LightPlan* lights, int count, const shading::LobePlan& lobe, V3 position, V3 normal,
                                    V3 to_eye, F half_exponent) {
    LightSums sums;
    for (int i = 0; i < count; ++i) {
        const shading::LightPlan& light = lights[i];
        const bool local = light.type != shading::LightType::directional;
        LocalLight at{broadcast(light.to_light), F(1.0f)};
        if (local) at = local_light(light, position);
        const F n_dot_l = dot(normal, at.direction);
        F diffuse = lobe_value(lobe, n_dot_l);
        if (local) diffuse = diffuse * at.strength;
        const V3 color = broadcast(light.color);
        sums.diffuse = sums.diffuse + color * diffuse;
        if constexpr (kSpecular) {
            F specular = blinn_value(normal, to_eye, at.direction, n_dot_l, half_exponent);
            if (local) specular = specular * at.strength;
            sums.specular = sums.specular + color * specular;
        }
    }
    return sums;
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
