#include "sh/order.hpp"

#include "sh/vec3d.hpp"

namespace halflit::sh {
namespace {

constexpr int kGridBands = 24, kGridRows = 96, kGridColumns = 192;

Vec3d larger(Vec3d a, Vec3d b) { return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z}; }
Vec3d smaller(Vec3d a, Vec3d b) { return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z}; }

/// Bound on the bands from 64 on, for one channel: the smaller of the two estimates in order.hpp. A black channel has no error, even where
/// tail_sum is infinite.
double tail(double norm, double absolute_sum, const LobeSpectrum& lobe) {
    const double by_norm = norm * lobe.tail_norm;
    const double by_sum = absolute_sum > 0 ? absolute_sum * lobe.tail_sum : 0.0;
    return by_norm < by_sum ? by_norm : by_sum;
}

/// bounds[l]: bound on the sum of all bands from l on, from the norms.
std::array<Vec3d, kSpectrumBands + 1> bounds_from(const Spectrum& environment, const LobeSpectrum& lobe) {
    std::array<Vec3d, kSpectrumBands + 1> bounds;
    bounds[kSpectrumBands] = {tail(environment.tail_norm.x, environment.absolute.x, lobe),
                              tail(environment.tail_norm.y, environment.absolute.y, lobe),
                              tail(environment.tail_norm.z, environment.absolute.z, lobe)};
    for (std::size_t l = kSpectrumBands; l-- > 0;)
        bounds[l] =
            bounds[l + 1] + environment.norm[l] * (absolute(lobe.f[l]) * __builtin_sqrt(static_cast<double>(2 * l + 1) / (4.0 * kPi)));
    return bounds;
}

/// Third bound of order.hpp: light from each direction is off by at most sup[i] / pi times its strength, so all light is off by at most
/// sup[i] / pi times the integral of |L|.
Vec3d by_lobe(const Spectrum& environment, const LobeSpectrum& lobe, std::size_t i) {
    const auto part = [&](double absolute_sum) { return absolute_sum > 0 ? absolute_sum * lobe.sup[i] / kPi : 0.0; };
    return {part(environment.absolute.x), part(environment.absolute.y), part(environment.absolute.z)};
}

}  // namespace

OrderBounds order_bounds(const Spectrum& environment, const LobeSpectrum& lobe) {
    const auto bounds = bounds_from(environment, lobe);
    OrderBounds out;
    out.beyond = bounds[kSpectrumBands];
    for (std::size_t i = 0; i < out.by_order.size(); ++i) out.by_order[i] = bounds[i + 1];
    return out;
}

BandGrid::BandGrid(const Projection& environment)
    : spectrum_(environment.spectrum()), values_(environment.bands_on_grid(kGridBands, kGridRows, kGridColumns)) {}

OrderBounds BandGrid::order_bounds(const LobeSpectrum& lobe) const {
    std::array<Vec3d, kMaxBands> largest_sum{};
    for (std::size_t point = 0; point < values_.size(); point += kGridBands) {
        Vec3d sum{};
        for (std::size_t l = kGridBands; l-- > 1;) {
            const Vec3f& band = values_[point + l];
            sum = sum + Vec3d{band.x, band.y, band.z} * lobe.f[l];
            if (l <= kMaxBands) largest_sum[l - 1] = larger(largest_sum[l - 1], absolute(sum));
        }
    }
    // distance: half the diagonal of a grid cell. The factor 1 + 1e-6 covers the rounding of the values to float.
    const double distance = 0.5 * kPi / kGridRows * __builtin_sqrt(2.0);
    const double factor = (1.0 + 1e-6) / sin_cos((kGridBands - 1) * distance).cos;
    const auto by_norms = bounds_from(spectrum_, lobe);
    OrderBounds out;
    out.beyond = by_norms[kSpectrumBands];
    for (std::size_t i = 0; i < out.by_order.size(); ++i)
        out.by_order[i] = smaller(smaller(by_norms[i + 1], largest_sum[i] * factor + by_norms[kGridBands]), by_lobe(spectrum_, lobe, i));
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
