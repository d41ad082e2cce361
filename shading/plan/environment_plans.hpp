// How lobes take an environment: the order that the error asks for, and the coefficients, convolved once and kept.
#pragma once

#include "shading/environment.hpp"
#include "shading/plan/environment_plan.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace halflit::shading {

/// Bands by the stable recurrence, order by the bound.
[[nodiscard]] EnvironmentPlan plan_environment(const Environment& environment, const sh::WrapLobe& lobe, const EnvironmentOrder& order);

/// The plans of one environment, kept from frame to frame: searching its bands for their largest error takes milliseconds.
class EnvironmentPlans {
public:
    EnvironmentPlans() = default;
    /// The environment must live as long.
    explicit EnvironmentPlans(const Environment& environment) : environment_(std::shared_ptr<void>(), &environment) {}
    /// For the plans that follow. Those of another environment are forgotten.
    void use(std::shared_ptr<const Environment> environment);
    [[nodiscard]] EnvironmentPlan plan(const sh::WrapLobe& lobe, const EnvironmentOrder& order);

private:
    struct Entry {
        sh::WrapLobe lobe;
        EnvironmentOrder order;
        EnvironmentPlan plan;
    };
    std::shared_ptr<const Environment> environment_;
    std::uint64_t id_ = 0;  ///< Environment::id: another one may come to lie where this one did
    std::vector<Entry> entries_;
};

/// Makes `newton` from the series' coefficients.
void make_newton_form(EnvironmentPlan& plan);

}  // namespace halflit::shading
