#include "apps/lab/highlight_model.hpp"

#include "sh/quadrature.hpp"
#include "sh/trig.hpp"
#include "shading/model/scalar.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::cli {

double reflected_radiance(const HighlightModel& model, double light_rad, double view_cosine, double turn_rad) {
    const double x = std::cos(light_rad), view_sine = std::sqrt(std::max(0.0, 1 - view_cosine * view_cosine));
    // The normal is z, and the light is in the plane of x and z.
    const double across = std::sin(light_rad) * view_sine * std::cos(turn_rad), along = x * view_cosine;
    const double mirrored = std::max(0.0, along - across);                                         // R.V
    const double half = (x + view_cosine) / std::sqrt(std::max(1e-30, 2 + 2 * (along + across)));  // N.H
    const double peak = specular_normalization(0.5 * model.exponent, model.phong) * model.specular;
    const double highlight = peak * (model.phong ? std::pow(mirrored, model.exponent / 4) : std::pow(half, model.exponent));
    return model.diffuse * x + (model.times_cosine ? highlight * x : highlight);
}

double reflected_share(const HighlightModel& model, double light_rad) {
    static const std::vector<sh::GaussNode> rule = sh::gauss_legendre(128);
    double sum = 0;
    for (const sh::GaussNode& height : rule) {
        const double cosine = 0.5 * (1 + height.x);
        for (const sh::GaussNode& turn : rule)  // half of the azimuths; the other half is the same
            sum += height.weight * turn.weight * cosine * reflected_radiance(model, light_rad, cosine, 0.5 * kPi * (1 + turn.x));
    }
    return 0.5 * sum / std::cos(light_rad);  // 2 (halves) * 1/2 (heights) * pi/2 (azimuths) / pi
}

}  // namespace halflit::cli
