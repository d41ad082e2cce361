#include "shading/plan/light_plan.hpp"

#include "sh/power.hpp"
#include "sh/trig.hpp"
#include "shading/model/constants.hpp"
#include "shading/model/numbers.hpp"
#include "shading/model/scalar.hpp"

#include <algorithm>

namespace halflit::shading {
namespace {

/// 1 - cos(angle) without cancellation.
double versine(float angle_rad) {
    const double s = sin_cos(0.5 * static_cast<double>(angle_rad)).sin;
    return 2.0 * s * s;
}

bool contributes(const Light& light) {
    if (zero(light.color_linear) || !finite(light.color_linear)) return false;
    const LightKind& kind = kind_of(light.type);
    if (kind.aimed && (!finite(light.direction_ws) || zero(light.direction_ws))) return false;
    return !kind.placed || finite(light.position_ws);
}

LightPlan plan_light(const Light& light) {
    LightPlan plan{};
    plan.type = light.type;
    plan.color[0] = light.color_linear.x, plan.color[1] = light.color_linear.y, plan.color[2] = light.color_linear.z;
    plan.position[0] = light.position_ws.x, plan.position[1] = light.position_ws.y, plan.position[2] = light.position_ws.z;
    const Vec3f travel = normalize_or(light.direction_ws, {0, -1, 0});
    plan.to_light[0] = 0.0f - travel.x, plan.to_light[1] = 0.0f - travel.y, plan.to_light[2] = 0.0f - travel.z;
    const double range = light.range > 0.0f && finite(light.range) ? static_cast<double>(light.range) : 0.0;
    plan.inv_range_squared = range > 0.0 ? static_cast<float>(std::min(1.0 / (range * range), 1e38)) : 0.0f;
    const float radius = clamp_or_low(light.source_radius, kMinSourceRadius, 1e18f);
    plan.min_distance_squared = radius * radius;
    const float outer = clamp_or_low(light.outer_cone_rad, 0.0f, static_cast<float>(kPi));
    const float inner = clamp_or_low(light.inner_cone_rad, 0.0f, outer);
    const double cutoff = versine(outer), width = cutoff - versine(inner);
    plan.cone_cutoff = static_cast<float>(cutoff);
    plan.cone_scale = static_cast<float>(1.0 / std::max(width, 1e-30));  // inner = outer: a step
    plan.brightness = std::max({light.color_linear.x, light.color_linear.y, light.color_linear.z});
    plan.shadow_radius = clamp_or_low(light.shadow_radius, 0.0f, kind_of(light.type).placed ? 1e9f : kMaxLightAngle);
    plan.half_cone_power = 0.5f * clamp_or_low(light.cone_power, 0.0f, kMaxConePower);
    return plan;
}

/// Turns a point or spot light into a directional one if it is so far from the origin that float32 cannot hold the square of the distance,
/// or its inverse. The light keeps the strength that it has at the origin. For a scene within 1e11 of the origin this is right to 1e-7.
void plan_as_parallel_if_far(const Light& light, LightPlan& plan) {
    constexpr double kFar = 1e18;
    const Vec3d p{light.position_ws.x, light.position_ws.y, light.position_ws.z};
    const double distance_squared = dot(p, p);
    if (!kind_of(plan.type).placed || distance_squared < kFar * kFar) return;
    const Vec3d to_light = p * (1.0 / __builtin_sqrt(distance_squared));
    double attenuation = 1.0 / distance_squared;
    if (light.range > 0.0f && finite(light.range)) {
        attenuation *= range_window(distance_squared / (static_cast<double>(light.range) * static_cast<double>(light.range)));
    }
    if (kind_of(plan.type).cone) {
        const Vec3d off_axis = to_light - Vec3d{plan.to_light[0], plan.to_light[1], plan.to_light[2]};
        const double off = 0.5 * dot(off_axis, off_axis);  // 1 - cos of the angle to the axis
        const double cone = std::clamp((static_cast<double>(plan.cone_cutoff) - off) * static_cast<double>(plan.cone_scale), 0.0, 1.0);
        attenuation *= cone * cone;
        if (plan.half_cone_power > 0.0f) attenuation *= power_of(1.0 - off, 2.0 * static_cast<double>(plan.half_cone_power));
    }
    plan.type = LightType::directional;
    plan.shadow_radius = 0.0f;
    plan.to_light[0] = static_cast<float>(to_light.x), plan.to_light[1] = static_cast<float>(to_light.y);
    plan.to_light[2] = static_cast<float>(to_light.z);
    const auto arriving = [&](float channel) {
        const double value = static_cast<double>(channel) * attenuation;
        return value > 1e-37 ? static_cast<float>(value) : 0.0f;  // denormals are slow
    };
    for (float& channel : plan.color) channel = arriving(channel);
    plan.brightness = arriving(plan.brightness);
}

}  // namespace

std::vector<LightPlan> plan_lights(std::span<const Light> lights) {
    std::vector<LightPlan> plans;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (!contributes(lights[i])) continue;
        plans.push_back(plan_light(lights[i]));
        plans.back().source = static_cast<std::int32_t>(i);
        plan_as_parallel_if_far(lights[i], plans.back());
    }
    return plans;
}

}  // namespace halflit::shading
