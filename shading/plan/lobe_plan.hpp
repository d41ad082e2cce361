// Lobes as the kernels read them.
#pragma once

#include "halflit/material.hpp"
#include "halflit/shading.hpp"
#include "shading/plan/pow_tier.hpp"

#include <cstdint>

namespace halflit::shading {

/// Method for t^n, t = max(0, (x + w) / (1 + w)), x = N.L: the cheapest that is within about 2 ulp for this n. With an error budget it may
/// be a curve: t times a polynomial in sqrt(t) (power_fit.hpp).
enum class LobePath : std::uint8_t { step, linear, square, sqrt_product, integer, general, curve };
inline constexpr int kLobeCurveTerms = 6;

struct LobePlan {
    LobePath path = LobePath::linear;
    float wrap = 0;
    float inv_one_plus_wrap = 1;  ///< 1 / (1 + w), rounded so that (1 + w) times it is not below 1: t(1) = 1 after the clamp
    float scale = 1;
    std::int32_t integer_power = 1;  ///< path integer: n, 3 to 5
    float power_minus_one = 0;       ///< path general: n - 1, and the same in two parts of 18 and 6 bits (pow.hpp)
    float power_minus_one_high = 0, power_minus_one_low = 0;
    PowTier tier = PowTier::exact;      ///< path general
    float curve[kLobeCurveTerms] = {};  ///< path curve
};

/// The lobe that a material is drawn with.
[[nodiscard]] inline const Lobe& lobe_of(const Material& material, const ShadingSettings& options) {
    return options.lobe && !material.has_own_lobe ? *options.lobe : material.lobe;
}

/// Plans a lobe. Values that check_lobe refuses are clamped to its range.
[[nodiscard]] LobePlan plan_lobe(const Lobe& lobe, PowTier tier);

}  // namespace halflit::shading
