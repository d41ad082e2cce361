// Plans of an environment's light through lobes: the order that the error requires, and the coefficients, convolved once and kept.
#pragma once

#include "shading/environment.hpp"
#include "shading/model/code_costs.hpp"
#include "shading/plan/environment_plan.hpp"
#include "shading/plan/reflection_plan.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace halflit::shading {

/// Choice of the number of bands.
struct EnvironmentOrder {
    int fixed = 0;                   ///< 1..10, or 0: the smallest whose bound is within the tolerance
    double tolerance = 1.0 / 510.0;  ///< relative to display white, in linear light: half an 8-bit code
    double exposure = 1.0;           ///< display white is 1 / exposure
    double codes = 0.0;              ///< if above 0: largest difference from that smallest number's light, in 8-bit sRGB codes
    CodeCosts costs{};               ///< of errors in codes
    bool split_shadows = false;      ///< shadows may leave the excess of a lobe over its core
    bool operator==(const EnvironmentOrder&) const = default;
};

/// Plans one lobe: bands by the stable recurrence (sh/zonal.hpp), order by the bound (sh/order.hpp).
[[nodiscard]] EnvironmentPlan plan_environment(const Environment& environment, const sh::WrapLobe& lobe, const EnvironmentOrder& order);

/// The plans of one environment, kept from frame to frame: searching its bands for their largest error takes milliseconds.
class EnvironmentPlans {
public:
    /// Begins a frame: sets the environment of the plans that follow. Plans of another environment are dropped.
    void use(std::shared_ptr<const Environment> environment);
    [[nodiscard]] EnvironmentPlan plan(const sh::WrapLobe& lobe, const EnvironmentOrder& order);
    /// Reflections of the frame's environment.
    [[nodiscard]] ReflectionPlan reflections(const ForEachRow& for_each_row);

private:
    struct Entry {
        sh::WrapLobe lobe;
        EnvironmentOrder order;
        EnvironmentPlan plan;
        std::uint64_t last_frame;  ///< that asked for it
    };
    EnvironmentSlot environment_;
    std::uint64_t frame_ = 0;
    std::vector<Entry> entries_;  ///< of environment_
};

/// Makes `newton` from the series' coefficients.
void make_newton_form(EnvironmentPlan& plan);

}  // namespace halflit::shading
