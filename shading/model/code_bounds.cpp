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

double codes_of_specular(double peak, int count, double constant, double linear) {
    const double top = peak * count;
    if (!(top > 0.0)) return 0.0;
    const double log2_top = log2_of(std::max(top, 1e-300));
    return std::min(255.0, largest_on_curve([&](const CurvePoint& at) {
                        const double z = std::max(0.0, kLn2 * (log2_top - at.log2_v));
                        return at.slope * std::min(at.v, top) * (constant + linear * z);
                    }));
}

}  // namespace halflit::shading
