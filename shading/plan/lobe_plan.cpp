#include "shading/plan/lobe_plan.hpp"

#include "shading/model/numbers.hpp"

#include <bit>

namespace halflit::shading {

LobePlan plan_lobe(const Lobe& asked, PowTier tier) {
    const Lobe lobe{clamp_or_low(asked.wrap, 0.0f, 1.0f), clamp_or_low(asked.power, 0.0f, kMaxLobePower), asked.normalize};
    LobePlan plan;
    plan.tier = tier;
    plan.wrap = lobe.wrap;
    plan.scale = lobe.scale();
    plan.inv_one_plus_wrap = 1.0f / (1.0f + lobe.wrap);
    if ((1.0f + lobe.wrap) * plan.inv_one_plus_wrap < 1.0f)
        plan.inv_one_plus_wrap = std::bit_cast<float>(std::bit_cast<std::int32_t>(plan.inv_one_plus_wrap) + 1);
    plan.power_minus_one = lobe.power - 1.0f;
    plan.power_minus_one_high = std::bit_cast<float>(std::bit_cast<std::uint32_t>(plan.power_minus_one) & 0xffffffc0u);
    plan.power_minus_one_low = plan.power_minus_one - plan.power_minus_one_high;
    if (lobe.power == 0.0f) {
        plan.path = LobePath::step;
    } else if (lobe.power == 1.0f) {
        plan.path = LobePath::linear;
    } else if (lobe.power == 1.5f) {
        plan.path = LobePath::sqrt_product;
    } else if (lobe.power == 2.0f) {
        plan.path = LobePath::square;
    } else if (lobe.power == 3.0f || lobe.power == 4.0f || lobe.power == 5.0f) {
        // n - 1 roundings of half an ulp: from n = 6 on the general path is more accurate.
        plan.path = LobePath::integer;
        plan.integer_power = static_cast<std::int32_t>(lobe.power);
    } else {
        plan.path = LobePath::general;
    }
    return plan;
}

}  // namespace halflit::shading
