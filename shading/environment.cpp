#include "shading/environment.hpp"

#include "sh/sun.hpp"
#include "sh/zonal.hpp"

#include <algorithm>

namespace halflit::shading {

Environment make_environment(const sh::EquirectView& image, const EnvironmentOptions& options) {
    const sh::Projection whole(image);
    const sh::Rotation turn = sh::rotation_about_y(options.rotate_rad);
    Environment environment;
    if (options.keep_image) {
        environment.rgb.assign(image.rgb.begin(), image.rgb.end());
        environment.width = image.width;
        environment.height = image.height;
        environment.rotate_rad = options.rotate_rad;
    }
    const auto take = [&](const sh::Projection& projection) {
        environment.radiance = sh::rotated(projection.radiance(), turn);
        environment.grid = sh::BandGrid(projection);
    };
    if (!options.extract_suns) {
        take(whole);
        return environment;
    }
    const sh::SunExtraction extraction = sh::extract_suns(image, whole);
    take(extraction.residual);
    for (const sh::Sun& sun : extraction.suns) {
        const Vec3d towards = turn * sun.direction, color = sun.irradiance * (1.0 / kPi);
        Light light;
        light.type = LightType::directional;
        light.direction_ws = {static_cast<float>(-towards.x), static_cast<float>(-towards.y), static_cast<float>(-towards.z)};
        light.color_linear = {static_cast<float>(color.x), static_cast<float>(color.y), static_cast<float>(color.z)};
        environment.suns.push_back(light);
    }
    return environment;
}

EnvironmentPlan plan_environment(const Environment& environment, double wrap, double power, double scale, const EnvironmentOrder& order) {
    const sh::WrapLobe lobe{wrap, power, scale};
    const sh::OrderBounds bounds = environment.grid.order_bounds(sh::lobe_spectrum(lobe));
    EnvironmentPlan plan;
    if (order.fixed > 0) {
        plan.bands = std::min(order.fixed, sh::kMaxBands);
        plan.bound = sh::largest(bounds.by_order[static_cast<std::size_t>(plan.bands - 1)]);
        plan.within = plan.bound <= order.tolerance * (1.0 / order.exposure);
    } else {
        const sh::OrderChoice choice = sh::pick_order(bounds, order.tolerance, 1.0 / order.exposure);
        plan.bands = choice.order;
        plan.bound = choice.bound;
        plan.within = choice.within;
    }
    const sh::PreconvolvedSh product = sh::convolve(environment.radiance, sh::zonal_bands(lobe), plan.bands);
    std::copy(product.r.begin(), product.r.end(), plan.red);
    std::copy(product.g.begin(), product.g.end(), plan.green);
    std::copy(product.b.begin(), product.b.end(), plan.blue);
    return plan;
}

}  // namespace halflit::shading
