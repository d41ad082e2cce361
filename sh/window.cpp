#include "sh/window.hpp"

#include <vector>

namespace halflit::sh {
namespace {

/// Size of the grid of directions on which bands are evaluated.
constexpr int kLatitudes = 64, kLongitudes = 128;

std::vector<Vec3d> grid() {
    std::vector<Vec3d> directions;
    for (int i = 0; i < kLatitudes; ++i) {
        const SinCos theta = sin_cos(kPi * (i + 0.5) / kLatitudes);
        for (int j = 0; j < kLongitudes; ++j) {
            const SinCos phi = sin_cos(2.0 * kPi * j / kLongitudes);
            directions.push_back({theta.sin * phi.cos, theta.sin * phi.sin, theta.cos});
        }
    }
    return directions;
}

/// Value of each band in one direction; a window scales these.
struct BandValues {
    Vec3d band[kMaxBands];
};

std::vector<BandValues> band_values(const RadianceSh& sh) {
    std::vector<BandValues> values;
    for (const Vec3d& d : grid()) {
        double y[kMaxCoefficients];
        evaluate_basis<kMaxBands>(d, y);
        BandValues v{};
        for (int i = 0; i < coefficient_count(sh.bands); ++i) {
            Vec3d& band = v.band[band_of(i)];
            band = band + sh.c[static_cast<std::size_t>(i)] * y[i];
        }
        values.push_back(v);
    }
    return values;
}

bool stays_above(const std::vector<BandValues>& values, const BandFactors& window, double floor) {
    const Vec3d mean = values.front().band[0];
    for (const BandValues& v : values) {
        Vec3d sum{};
        for (std::size_t l = 0; l < kMaxBands; ++l) sum = sum + v.band[l] * window[l];
        if ((sum.x < floor && mean.x >= floor) || (sum.y < floor && mean.y >= floor) || (sum.z < floor && mean.z >= floor)) return false;
    }
    return true;
}

}  // namespace

BandFactors hann_window(double width) {
    BandFactors out{};
    for (int l = 0; l < kMaxBands && l < width; ++l) out[static_cast<std::size_t>(l)] = 0.5 * (1.0 + sin_cos(kPi * l / width).cos);
    return out;
}

BandFactors lanczos_window(double width) {
    BandFactors out{};
    out[0] = 1.0;
    for (int l = 1; l < kMaxBands && l < width; ++l) {
        const double x = kPi * l / width;
        out[static_cast<std::size_t>(l)] = sin_cos(x).sin / x;
    }
    return out;
}

BandFactors laplacian_window(double lambda) {
    BandFactors out{};
    for (int l = 0; l < kMaxBands; ++l) {
        const double k = static_cast<double>(l * (l + 1));
        out[static_cast<std::size_t>(l)] = 1.0 / (1.0 + lambda * k * k);
    }
    return out;
}

Deringed dering(const RadianceSh& sh, double floor) {
    if (sh.bands < 2) return {sh, 0.0};
    const std::vector<BandValues> values = band_values(sh);
    if (stays_above(values, laplacian_window(0.0), floor)) return {sh, 0.0};
    double low = 0.0, high = 1e-4;
    while (high < 1e12 && !stays_above(values, laplacian_window(high), floor)) high *= 4.0;
    for (int step = 0; step < 40; ++step) {
        const double middle = 0.5 * (low + high);
        (stays_above(values, laplacian_window(middle), floor) ? high : low) = middle;
    }
    return {scaled_by_band(sh, laplacian_window(high)), high};
}

}  // namespace halflit::sh
