// Direct light: for each light its direction and attenuation at a fragment, its shadow, and the sum of lobes over all lights.
#pragma once

#include "shading/kernels/lobe_kernel.hpp"
#include "shading/kernels/shadow_kernel.hpp"
#include "shading/kernels/vector.hpp"
#include "shading/model/formulas.hpp"
#include "shading/plan/plan.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Sums over the lights, in list order; the material's colours are multiplied in afterwards.
struct LightSums {
    V3 diffuse{F(0.0f), F(0.0f), F(0.0f)}, specular{F(0.0f), F(0.0f), F(0.0f)};
};

/// Unit direction to a point or spot light, and its attenuation there: the inverse square of the distance, the window that takes it to
/// zero at `range`, and the cone.
struct LocalLight {
    V3 direction;
    F attenuation;
};
/// Written part by part: a struct that two paths return is copied through memory by GCC 12.
HALFLIT_INLINE void local_light(const shading::LightPlan& light, V3 position, V3& direction, F& attenuation) {
    const V3 offset = broadcast(light.position) - position;
    const F distance_squared = dot(offset, offset);
    // Below 1e-18 the direction has no meaning and fades to zero; an infinite distance gives attenuation 0.
    const F in_range = distance_squared * F(light.inv_range_squared);
    const F window = range_window(in_range);
    const F inv_distance = vdiv(F(1.0f), vsqrt(vmax(distance_squared, F(1e-36f))));
    direction.x = offset.x * inv_distance, direction.y = offset.y * inv_distance, direction.z = offset.z * inv_distance;
    attenuation = vdiv(window, vmax(distance_squared, F(light.min_distance_squared)));
    if (light.cutoff_squared > 0.0f) attenuation = sel(distance_squared < F(light.cutoff_squared), attenuation, F(0.0f));
    if (light.type == LightType::spot) {
        // 1 - cos of the angle to the axis, as |L - A|^2 / 2, A being minus the axis. It is accurate for narrow cones, where a difference
        // of cosines has no digits left. The subtraction from the cutoff is exact near the rim.
        const V3 off_axis = direction - broadcast(light.to_light);
        const F versine = F(0.5f) * dot(off_axis, off_axis);
        const F cone = clamp((F(light.cone_cutoff) - versine) * F(light.cone_scale), F(0.0f), F(1.0f));
        attenuation = attenuation * (cone * cone);
        if (light.half_cone_power > 0.0f) {
            const F cosine = F(1.0f) - versine, sine_squared = versine * (F(2.0f) - versine);
            const F power = power_of_cosine(shading::PowTier::exact, cosine * cosine, sine_squared, F(light.half_cone_power));
            attenuation = attenuation * sel(cosine > F(0.0f), power, F(0.0f));
        }
    }
}

/// Direction and attenuation of any light. A directional light's attenuation is 1, and the product with it is exact.
HALFLIT_INLINE LocalLight arrival(const shading::LightPlan& light, V3 position) {
    LocalLight at{broadcast(light.to_light), F(1.0f)};
    if (light.type != LightType::directional) local_light(light, position, at.direction, at.attenuation);
    return at;
}

/// Point at which a fragment's shadows are looked up.
HALFLIT_INLINE V3 looked_up(const shading::ShadingPlan& frame, const shading::FragmentBlock& block, int lane) {
    const V3 position = row3(block, shading::kPosX, lane);
    return frame.shadow_offset ? position + row3(block, shading::kShadowX, lane) : position;
}

/// Data of a fragment that shadows need.
struct ShadowReceiver {
    const shading::ShadingPlan& frame;
    V3 position;        ///< point at which shadows are looked up
    V3 surface_normal;  ///< before the normal map
    ShadowFade fade;    ///< the material's
};

/// Applies a shadow to the lobe f and to the highlight. hard: all of f is cut. soft-split: the core, min(f, max(0, x)), is cut, and the
/// excess over it fades with the blocker's distance. The hidden part is subtracted from f, so that unhidden light keeps its bits, and light
/// that is hidden altogether is exactly 0.
template <bool kSpecular>
HALFLIT_INLINE void cast_shadow(const ShadowReceiver& receiver, const shading::LightPlan& light, V3 direction, F attenuation, F n_dot_l,
                                F& diffuse, F& specular) {
    M lit = (diffuse * attenuation) > F(0.0f);
    if constexpr (kSpecular) lit = lit | ((specular * attenuation) > F(0.0f));
    if (!any(lit)) return;  // nothing to hide
    const bool split = receiver.frame.shadow_mode == ShadowMode::soft_split;
    const bool soft = split && receiver.fade.scale > 0.0f;
    const HiddenShares hidden =
        hidden_share(receiver.frame, light, receiver.position, receiver.surface_normal, direction, receiver.fade, soft);
    const F core = split ? vmin(diffuse, vmax(n_dot_l, F(0.0f))) : diffuse;
    const F excess = diffuse - core;
    diffuse = (diffuse - hidden.hard * core) - hidden.soft * excess;
    if constexpr (kSpecular) specular = specular * (F(1.0f) - hidden.hard);
}

/// One loop over the lights without highlights, for one choice of lobe. A light is so little work then that the loop must contain nothing
/// else: in a loop with every path, GCC keeps the sums in memory, and each light waits for the store of the one before. With shadows it
/// makes no difference.
template <bool kShadows, class LobeValue>
HALFLIT_INLINE LightSums sum_lobes(const LobeValue& lobe_value_at, const shading::LightPlan* lights, int count,
                                   const ShadowReceiver& receiver, V3 position, V3 normal) {
    LightSums sums;
    for (int i = 0; i < count; ++i) {
        const shading::LightPlan& light = lights[i];
        const bool local = light.type != LightType::directional;
        LocalLight at{broadcast(light.to_light), F(1.0f)};  // not arrival(): with it GCC 12 makes point lights 16 % slower on AVX-512
        if (local) local_light(light, position, at.direction, at.attenuation);
        const F n_dot_l = dot(normal, at.direction);
        F diffuse = lobe_value_at(n_dot_l);
        if constexpr (kShadows) {
            F none(0.0f);
            if (light.shadow_map >= 0) cast_shadow<false>(receiver, light, at.direction, at.attenuation, n_dot_l, diffuse, none);
        }
        sums.diffuse = sums.diffuse + broadcast(light.color) * (local ? diffuse * at.attenuation : diffuse);
    }
    return sums;
}

/// Sums two lights at a time. t^n is one chain of dependent operations, much longer than the processor can look ahead, so two chains run
/// side by side. The lights are added in list order.
template <shading::PowTier kTier>
HALFLIT_INLINE LightSums sum_lights_by_power(const shading::LobePlan& lobe, const shading::LightPlan* lights, int count, V3 position,
                                             V3 normal) {
    LightSums sums;
    int i = 0;
    for (; i + 1 < count; i += 2) {
        const LocalLight at = arrival(lights[i], position), next_at = arrival(lights[i + 1], position);
        const F x = dot(normal, at.direction), next_x = dot(normal, next_at.direction);
        const F value = general_lobe_value<kTier>(lobe, x), next_value = general_lobe_value<kTier>(lobe, next_x);
        sums.diffuse = sums.diffuse + broadcast(lights[i].color) * (value * at.attenuation);
        sums.diffuse = sums.diffuse + broadcast(lights[i + 1].color) * (next_value * next_at.attenuation);
    }
    if (i < count) {
        const LocalLight at = arrival(lights[i], position);
        sums.diffuse =
            sums.diffuse + broadcast(lights[i].color) * (general_lobe_value<kTier>(lobe, dot(normal, at.direction)) * at.attenuation);
    }
    return sums;
}

/// Sums of lobes alone.
HALFLIT_INLINE LightSums sum_lobes(const shading::LightPlan* lights, int count, const shading::LobePlan& lobe,
                                   const ShadowReceiver& receiver, V3 position, V3 normal) {
    using shading::LobePath, shading::PowTier;
    const auto sum = [&]<bool kShadows>(const auto& value) __attribute__((always_inline)) {
        return sum_lobes<kShadows>(value, lights, count, receiver, position, normal);
    };
    if (!receiver.frame.shadow_maps.empty())
        return sum.template operator()<true>([&](F x) __attribute__((always_inline)) { return lobe_value(lobe, x); });
    if (lobe.path == LobePath::curve)
        return sum.template operator()<false>([&](F x) __attribute__((always_inline)) { return curve_lobe_value(lobe, x); });
    if (lobe.path != LobePath::general)
        return sum.template operator()<false>([&](F x) __attribute__((always_inline)) { return simple_lobe_value(lobe, x); });
    if (lobe.power_minus_one >= shading::kSharpPowerMinusOne)
        return sum.template operator()<false>([&](F x) __attribute__((always_inline)) { return sharp_lobe_value(lobe, x); });
    switch (lobe.tier) {
        case PowTier::display:
            return sum_lights_by_power<PowTier::display>(lobe, lights, count, position, normal);
        case PowTier::fast:
            return sum_lights_by_power<PowTier::fast>(lobe, lights, count, position, normal);
        case PowTier::exact:
            break;
    }
    return sum_lights_by_power<PowTier::exact>(lobe, lights, count, position, normal);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
