#include "shading/environment.hpp"

#include "sh/sun.hpp"
#include "sh/zonal.hpp"

#include <algorithm>
#include <array>

namespace halflit::shading {
namespace {

/// The polynomial in z that belongs to the real (part = +1) or imaginary (-1) part of (x + iy)^m, nested about kNodes: divided
/// differences of its values there.
std::array<double, sh::kMaxBands> nested_about_nodes(const float* coefficients, int bands, int m, int part) {
    const sh::detail::BasisTable& table = sh::detail::kBasisTable;
    std::array<double, sh::kMaxBands> a{};
    const int degree = bands - 1 - m;
    for (int j = 0; j <= degree; ++j) {
        double before = 0.0, q = table.diagonal[m];
        for (int l = m; l < bands; ++l) {
            a[j] += static_cast<double>(coefficients[sh::coefficient_index(l, part * m)]) * q;
            if (l + 1 == bands) break;
            const double next = (static_cast<double>(kNodes[j]) * q) * table.up[l + 1][m] - before * table.back[l + 1][m];
            before = q;
            q = next;
        }
    }
    for (int k = 1; k <= degree; ++k)
        for (int j = degree; j >= k; --j) a[j] = (a[j] - a[j - 1]) / (static_cast<double>(kNodes[j]) - static_cast<double>(kNodes[j - k]));
    return a;
}

}  // namespace

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

void nest_coefficients(EnvironmentPlan& plan) {
    float* next = plan.nested;
    for (int m = 0; m < plan.bands; ++m) {
        std::array<double, sh::kMaxBands> a[2][3];
        const int parts = m > 0 ? 2 : 1;
        for (int part = 0; part < parts; ++part)
            for (int channel = 0; channel < 3; ++channel)
                a[part][channel] = nested_about_nodes(channel == 0   ? plan.red
                                                      : channel == 1 ? plan.green
                                                                     : plan.blue,
                                                      plan.bands, m, 1 - 2 * part);
        for (int k = plan.bands - 1 - m; k >= 0; --k)
            for (int part = 0; part < parts; ++part)
                for (int channel = 0; channel < 3; ++channel) *next++ = static_cast<float>(a[part][channel][static_cast<std::size_t>(k)]);
    }
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
    nest_coefficients(plan);
    return plan;
}

}  // namespace halflit::shading
