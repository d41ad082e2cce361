#include "halflit/scene.hpp"

#include "sh/equirect.hpp"
#include "sh/fp_environment.hpp"
#include "sh/power.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>

namespace halflit {
namespace {

constexpr float kSkyShare = 0.10f, kGroundShare = 0.05f;  // keeps unlit sides readable, but clearly dark

Vec3d level(const Lighting& of, const Bounds& bounds) {
    const Vec3d center = bounds.empty ? Vec3d{} : to_double(bounds.center());
    const double radius = bounds.empty ? 0.0 : static_cast<double>(bounds.radius());
    Vec3d sum{};
    for (const Light& light : of.all_lights()) {
        double share = 1.0;
        if (kind_of(light.type).placed) {
            const double distance = length(to_double(light.position_ws) - center);
            if (light.range > 0.0f && distance - radius >= static_cast<double>(light.range)) continue;
            // The lower limit keeps a light close to the centre from dominating the sum.
            const double effective = std::max({distance, radius / 2, 1e-4});
            share = 1.0 / (effective * effective);
        }
        sum = sum + to_double(light.color_linear) * share;
    }
    return sum;
}

}  // namespace

Vec3f light_level(const Lighting& of, const Bounds& bounds) {
    const FpEnvironment environment_of_host;
    const Vec3d sum = level(of, bounds);
    return {static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)};
}

float auto_exposure(const Lighting& of, const Bounds& bounds) {
    const FpEnvironment environment_of_host;
    const double luminance = sh::luminance(level(of, bounds));
    // Beyond these limits the factor or its product with the light would leave the range of float.
    if (!(luminance > 1e-24 && luminance < 1e24)) return 1.0f;
    return static_cast<float>(1.0 / luminance);
}

Ambient soft_ambient(const Lighting& of, const Bounds& bounds) {
    const FpEnvironment environment_of_host;
    const Vec3f sum = light_level(of, bounds);
    if (!(dot(sum, sum) < 1e36f)) return {};  // NaN, infinite, or beyond what can be squared
    return {sum * kSkyShare, sum * kGroundShare};
}

float exposure_factor(float ev) {
    const FpEnvironment environment_of_host;
    return static_cast<float>(exp2_of(std::clamp(static_cast<double>(ev), -64.0, 64.0)));
}

}  // namespace halflit
