#include "shading/code_bounds.hpp"

#include <cmath>

namespace halflit::shading {
namespace {

constexpr double kLn2 = 0.69314718055994531;
/// S at white: 255 * 1.055 / 2.4.
constexpr double kSensitivity = 112.1;

}  // namespace

double codes_of_absolute(double delta) {
    if (!(delta < 1.0)) return 255.0;
    return delta <= kLinearEnd ? kSlopeAtBlack * delta : 255.0 * (1.055 * power_of(delta, 1.0 / 2.4) - 0.055) + 0.01;
}

double codes_of_relative(double r) { return r > 0.0 ? std::min(255.0, kSensitivity * (r < 1e-4 ? r : kLn2 * log2_of(1.0 + r))) : 0.0; }

double codes_of_edge(double amplitude, double n, double t_error) {
    if (n <= 0.0) return 255.0;  // a step
    const auto error = [&](double v, double at) {
        const double t = std::min(1.0, power_of(v / amplitude, 1.0 / n));
        const double held = std::max(t, t_error);
        return at * amplitude * n * power_of(held, n) / held * t_error;
    };
    double codes = amplitude > 0.0 ? largest_on_curve(error) : 0.0;
    if (n < 1.0) codes = std::max(codes, codes_of_absolute(amplitude * power_of(t_error, n)));
    return std::min(codes, 255.0);
}

double codes_of_highlight(double peak, int count, double constant, double linear, double root) {
    const double top = peak * count;
    if (!(top > 0.0)) return 0.0;
    return std::min(255.0, largest_on_curve([&](double v, double at) {
                        const double z = std::max(0.0, kLn2 * (log2_of(top) - log2_of(v)));
                        return at * std::min(v, top) * (constant + linear * z + root * std::sqrt(z));
                    }));
}

}  // namespace halflit::shading
