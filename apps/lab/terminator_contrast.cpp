#include "apps/lab/terminator_contrast.hpp"

#include "sh/lobe_error.hpp"
#include "sh/trig.hpp"
#include "shading/model/srgb.hpp"

#include <algorithm>
#include <cmath>

namespace halflit::cli {
namespace {

double code_of(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    return 255 * (v <= shading::kSrgbLinearEnd ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
}

double strength(const LightRig& rig) { return (1 - rig.environment) / rig.lights; }

}  // namespace

std::vector<Vec3d> rig_directions(int lights) {
    constexpr double kTurn = 2.399963229728653;  // golden angle, pi (3 - sqrt 5)
    std::vector<Vec3d> directions{{1, 0, 0}};
    for (int i = 0; i + 1 < lights; ++i) {
        // Equal steps of z are equal areas. The first of these lights is opposite to the light from the right.
        const double z = 1 - (i + 0.5) / (lights - 1), side = std::sqrt(1 - z * z), turn = kPi + kTurn * i;
        directions.push_back({side * std::cos(turn), side * std::sin(turn), z});
    }
    return directions;
}

double first_light(const sh::WrapLobe& lobe, const LightRig& rig, double p) { return strength(rig) * sh::lobe_value(lobe, p); }

double rig_light(const sh::WrapLobe& lobe, const LightRig& rig, double p) {
    const double z = std::sqrt(std::max(0.0, 1 - p * p));
    double sum = rig.environment * sh::zonal_bands(lobe)[0];
    for (const Vec3d& direction : rig_directions(rig.lights))
        sum += strength(rig) * sh::lobe_value(lobe, p * direction.x + z * direction.z);
    return sum;
}

std::vector<double> edge_window(const sh::WrapLobe& lobe) {
    constexpr int kPoints = 64;  // on either side
    std::vector<double> points;
    for (int i = -kPoints; i <= kPoints; ++i) {
        const double p = -lobe.wrap + kEdgeStep * i / kPoints;
        if (p - kEdgeStep >= -1 - 1e-9) points.push_back(p);
    }
    return points;
}

double edge_contrast(const sh::WrapLobe& lobe, const LightRig& rig) {
    double largest = 0;
    for (const double p : edge_window(lobe)) {
        const double mean = 0.5 * (first_light(lobe, rig, p - kEdgeStep) + first_light(lobe, rig, p + kEdgeStep));
        largest = std::max(largest, std::fabs(mean - first_light(lobe, rig, p)) / (rig_light(lobe, rig, p) + kFlare));
    }
    return largest;
}

double edge_codes(const sh::WrapLobe& lobe, const LightRig& rig) {
    const auto code_at = [&](double p) { return code_of(rig_light(lobe, rig, p)); };
    double largest = 0;
    for (const double p : edge_window(lobe))
        largest = std::max(largest, std::fabs(code_at(p - kEdgeStep) - 2 * code_at(p) + code_at(p + kEdgeStep)));
    return largest;
}

double code_slope(double linear) { return 255 * (linear <= shading::kSrgbLinearEnd ? 12.92 : 1.055 / 2.4 * std::pow(linear, 1 / 2.4 - 1)); }

double lambert_slope_jump(const LightRig& rig) { return code_slope(rig_light({}, rig, 0)) * strength(rig) / kBallRadiusDeg; }

}  // namespace halflit::cli
