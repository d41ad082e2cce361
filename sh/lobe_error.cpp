#include "sh/lobe_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace halflit::sh {
namespace {

constexpr int kSamples = 4096;  ///< samples of the angle; a golden section search refines between two of them

/// The largest value of fn(cos theta), theta in [0, pi]. The search starts from a grid and from `kink`, an angle where fn may have a
/// corner.
template <class Fn>
double maximum(double kink, Fn&& fn) {
    double best = fn(std::cos(kink)), at = kink;
    for (int i = 0; i <= kSamples; ++i) {
        const double theta = kPi * i / kSamples, value = fn(std::cos(theta));
        if (value > best) best = value, at = theta;
    }
    double low = std::max(0.0, at - kPi / kSamples), high = std::min(kPi, at + kPi / kSamples);
    constexpr double kGolden = 0.61803398874989485;
    for (int i = 0; i < 60; ++i) {
        const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
        const double fa = fn(std::cos(a)), fb = fn(std::cos(b));
        best = std::max({best, fa, fb});
        (fa > fb ? high : low) = fa > fb ? b : a;
    }
    return best;
}

}  // namespace

double lobe_value(const WrapLobe& lobe, double x) {
    if (!(x > -lobe.wrap)) return 0.0;
    return lobe.scale * std::pow(std::min((x + lobe.wrap) / (1.0 + lobe.wrap), 1.0), lobe.power);
}

double series_value(const BandFactors& f, int bands, double x) {
    double before = 0.0, here = 1.0, sum = 0.0;
    for (int l = 0; l < bands; ++l) {
        sum += (2.0 * l + 1.0) / 4.0 * f[static_cast<std::size_t>(l)] * here;
        const double next = ((2.0 * l + 1.0) * x * here - l * before) / (l + 1.0);
        before = here;
        here = next;
    }
    return sum;
}

double slope_at_boundary(const WrapLobe& lobe) {
    if (lobe.power > 1.0) return 0.0;
    return lobe.power == 1.0 ? lobe.scale / (1.0 + lobe.wrap) : std::numeric_limits<double>::infinity();
}

TruncationError truncation_error(const WrapLobe& lobe, int bands) {
    const BandFactors f = zonal_bands(lobe);
    const LobeSpectrum spectrum = lobe_spectrum(lobe);
    const double total = 2.0 * kPi * (1.0 + lobe.wrap) / (2.0 * lobe.power + 1.0) * lobe.scale * lobe.scale;
    double head = 0.0, tail = spectrum.tail_norm * spectrum.tail_norm;
    for (int l = kSpectrumBands - 1; l >= 0; --l) {
        const double band =
            (2.0 * l + 1.0) / (4.0 * kPi) * spectrum.f[static_cast<std::size_t>(l)] * spectrum.f[static_cast<std::size_t>(l)];
        (l < bands ? head : tail) += band;
    }
    // The closed form of the total is exact, but the difference cancels where little is left. There the sum of the bands is more accurate.
    const double rest = total - kPi * kPi * head, square = rest > 1e-6 * total ? rest : kPi * kPi * tail;
    const double boundary = std::acos(std::clamp(-lobe.wrap, -1.0, 1.0));
    TruncationError out;
    out.l2 = std::sqrt(square);
    out.sup = maximum(boundary, [&](double x) { return std::abs(lobe_value(lobe, x) - series_value(f, bands, x)); });
    out.min = -maximum(boundary, [&](double x) { return -series_value(f, bands, x); });
    return out;
}

}  // namespace halflit::sh
