// The wrap family for lanes of N.L. The path is the same for a whole material, so the switch costs nothing that matters.
#pragma once

#include "shading/kernels/pow.hpp"
#include "shading/plan.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// From this power on 1 - t is taken from 1 - x, which is exact for x in [1/2, 1], instead of from t.
inline constexpr float kSharpPowerMinusOne = 63.0f;

/// t^n with t = clamp((x + w) / (1 + w), 0, 1), without the lobe's scale. Clamped after the sum: max(0, x) + w would light the whole
/// back side. NaN gives 0, and so does x <= -w for every n, 0 included.
HALFLIT_INLINE F lobe_value(const shading::LobePlan& lobe, F x) {
    using shading::LobePath;
    const F t = clamp((x + F(lobe.wrap)) * F(lobe.inv_one_plus_wrap), F(0.0f), F(1.0f));
    switch (lobe.path) {
        case LobePath::linear:
            return t;
        case LobePath::square:
            return t * t;
        case LobePath::sqrt_product:
            return t * vsqrt(t);
        case LobePath::step:
            return sel(t > F(0.0f), F(1.0f), F(0.0f));
        case LobePath::integer: {
            const F t2 = t * t;
            if (lobe.integer_power == 3) return t2 * t;
            const F t4 = t2 * t2;
            return lobe.integer_power == 4 ? t4 : t4 * t;
        }
        case LobePath::general:
            if (lobe.power_minus_one >= kSharpPowerMinusOne)
                return sharp_power_of_unit(t, clamp((F(1.0f) - x) * F(lobe.inv_one_plus_wrap), F(0.0f), F(1.0f)),
                                           F(lobe.power_minus_one + 1.0f));
            return power_of_unit(t, lobe.power_minus_one, lobe.power_minus_one_high, lobe.power_minus_one_low);
    }
    return t;
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
