#include "shading/model/code_bounds.hpp"

#include <cmath>

namespace halflit::shading {
double codes_of_absolute(double delta) {
    if (!(delta < 1.0)) return 255.0;
    return delta <= kLinearEnd ? kSlopeAtBlack * delta : 255.0 * (1.055 * power_of(delta, 1.0 / 2.4) - 0.055) + 0.01;
}

double codes_of_relative(double r) { return r > 0.0 ? std::min(255.0, kSlopeAtWhite * (r < 1e-4 ? r : kLn2 * log2_of(1.0 + r))) : 0.0; }

const std::array<CurvePoint, 61>& curve_points() {
    static const std::array<CurvePoint, 61> points = [] {
        std::array<CurvePoint, 61> all{};
        for (std::size_t i = 0; i < all.size(); ++i) {
            const double log2_v = log2_of(kLinearEnd) * (1.0 - static_cast<double>(i) / static_cast<double>(all.size() - 1));
            const double v = i == 0 ? kLinearEnd : exp2_of(log2_v);
            all[i] = {v, log2_v, code_slope(v)};
        }
        return all;
    }();
    return points;
}

double codes_of_edge(double amplitude, double n, double t_error) {
    if (n <= 0.0) return 255.0;  // a step
    if (!(amplitude > 1e-300)) return 0.0;
    // A n t^(n-1) times the error of t, with t = (v / A)^(1/n) clamped to [t_error, 1].
    const double log2_amplitude = log2_of(amplitude), log2_error = log2_of(std::max(t_error, 1e-300)), factor = amplitude * n * t_error;
    double codes = largest_on_curve([&](const CurvePoint& at) {
        const double log2_t = std::clamp((at.log2_v - log2_amplitude) / n, std::min(log2_error, 0.0), 0.0);
        return at.slope * factor * exp2_of((n - 1.0) * log2_t);
    });
    if (n < 1.0) codes = std::max(codes, codes_of_absolute(amplitude * power_of(t_error, n)));
    return std::min(codes, 255.0);
}

double codes_of_specular(double peak, int count, double constant, double linear, double root) {
    const double top = peak * count;
    if (!(top > 0.0)) return 0.0;
    const double log2_top = log2_of(std::max(top, 1e-300));
    return std::min(255.0, largest_on_curve([&](const CurvePoint& at) {
                        const double z = std::max(0.0, kLn2 * (log2_top - at.log2_v));
                        return at.slope * std::min(at.v, top) * (constant + linear * z + root * std::sqrt(z));
                    }));
}

}  // namespace halflit::shading
