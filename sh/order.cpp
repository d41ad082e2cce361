#include "sh/order.hpp"

namespace halflit::sh {
namespace {

double absolute(double x) { return x < 0 ? -x : x; }

/// 0 times infinity is 0 here: darkness has no error.
double tail(double norm, double absolute_sum, const LobeSpectrum& lobe) {
    const double by_norm = norm * lobe.tail_norm;
    const double by_sum = absolute_sum > 0 ? absolute_sum * lobe.tail_sum : 0.0;
    return by_norm < by_sum ? by_norm : by_sum;
}

}  // namespace

OrderBounds order_bounds(const Spectrum& environment, const LobeSpectrum& lobe) {
    OrderBounds out;
    Vec3d sum{tail(environment.tail_norm.x, environment.absolute.x, lobe), tail(environment.tail_norm.y, environment.absolute.y, lobe),
              tail(environment.tail_norm.z, environment.absolute.z, lobe)};
    for (std::size_t l = kSpectrumBands - 1; l >= 1; --l) {
        sum = sum + environment.norm[l] * (absolute(lobe.f[l]) * __builtin_sqrt(static_cast<double>(2 * l + 1) / (4.0 * kPi)));
        if (l <= out.by_order.size()) out.by_order[l - 1] = sum;
    }
    return out;
}

OrderChoice pick_order(const OrderBounds& bounds, double tolerance, double scale) {
    for (int order = 1; order <= kMaxBands; ++order) {
        const double bound = largest(bounds.by_order[static_cast<std::size_t>(order - 1)]);
        if (bound <= tolerance * scale) return {order, bound, true};
    }
    return {kMaxBands, largest(bounds.by_order.back()), false};
}

}  // namespace halflit::sh
