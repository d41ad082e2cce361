// The wrap family for lanes of N.L. The path is the same for a whole material, so the switch costs next to nothing.
#pragma once

#include "shading/kernels/pow.hpp"
#include "shading/plan/plan.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// (x + w) / (1 + w), clamped to [0, 1] after the sum: max(0, x) + w would light the whole back side. NaN gives 0.
HALFLIT_INLINE F lobe_argument(const shading::LobePlan& lobe, F x) {
    return clamp((x + F(lobe.wrap)) * F(lobe.inv_one_plus_wrap), F(0.0f), F(1.0f));
}

/// t^n on the paths other than general and curve, without the lobe's scale. NaN gives 0, and so does x <= -w for every n, 0 included.
HALFLIT_INLINE F simple_lobe_value(const shading::LobePlan& lobe, F x) {
    using shading::LobePath;
    const F t = lobe_argument(lobe, x);
    if (lobe.path == LobePath::linear) return t;
    if (lobe.path == LobePath::sqrt_product) return t * vsqrt(t);
    if (lobe.path == LobePath::step) return sel(t > F(0.0f), F(1.0f), F(0.0f));
    const F t2 = t * t;
    if (lobe.path == LobePath::square) return t2;
    if (lobe.integer_power == 3) return t2 * t;
    const F t4 = t2 * t2;
    return lobe.integer_power == 4 ? t4 : t4 * t;
}

/// t^n on the general path: general_lobe_value() below the power shading::kSharpPowerMinusOne + 1, sharp_lobe_value() from it on.
template <shading::PowTier kTier>
HALFLIT_INLINE F general_lobe_value(const shading::LobePlan& lobe, F x) {
    const F t = lobe_argument(lobe, x);
    if constexpr (kTier == shading::PowTier::display) return short_power_of_unit(kLog2Degree5, kExp2Degree4, t, lobe.power_minus_one);
    if constexpr (kTier == shading::PowTier::fast) return short_power_of_unit(kLog2Degree3, kExp2Degree3, t, lobe.power_minus_one);
    return power_of_unit(t, lobe.power_minus_one, lobe.power_minus_one_high, lobe.power_minus_one_low);
}
HALFLIT_INLINE F general_lobe_value(const shading::LobePlan& lobe, F x) {
    if (lobe.tier == shading::PowTier::display) return general_lobe_value<shading::PowTier::display>(lobe, x);
    if (lobe.tier == shading::PowTier::fast) return general_lobe_value<shading::PowTier::fast>(lobe, x);
    return general_lobe_value<shading::PowTier::exact>(lobe, x);
}
HALFLIT_INLINE F sharp_lobe_value(const shading::LobePlan& lobe, F x) {
    return sharp_power_of_unit(lobe_argument(lobe, x), clamp((F(1.0f) - x) * F(lobe.inv_one_plus_wrap), F(0.0f), F(1.0f)),
                               F(lobe.power_minus_one + 1.0f));
}

/// t^n on the curve path: a polynomial and a square root, which runs beside other operations. Never below 0.
HALFLIT_INLINE F curve_lobe_value(const shading::LobePlan& lobe, F x) {
    const F t = lobe_argument(lobe, x);
    return vmax(t * horner(lobe.curve, vsqrt(t)), F(0.0f));
}

HALFLIT_INLINE F lobe_value(const shading::LobePlan& lobe, F x) {
    if (lobe.path == shading::LobePath::curve) return curve_lobe_value(lobe, x);
    if (lobe.path != shading::LobePath::general) return simple_lobe_value(lobe, x);
    return lobe.power_minus_one >= shading::kSharpPowerMinusOne ? sharp_lobe_value(lobe, x) : general_lobe_value(lobe, x);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
