#include "sh/zonal.hpp"

#include "sh/power.hpp"
#include "sh/trig.hpp"

#include <limits>
#include <span>

namespace halflit::sh {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// g_l as in the header. For w = 1 and an integer n the lobe is a polynomial of degree n: the bands past it are exactly 0.
void relative_bands(const WrapLobe& lobe, std::span<double> g) {
    const double w = lobe.wrap, n = lobe.power;
    const bool polynomial = w == 1.0 && n < 1e6 && n == static_cast<double>(static_cast<long long>(n));
    double before = 1.0, here = 1.0;
    for (std::size_t i = 0; i < g.size(); ++i) {
        const double l = static_cast<double>(i), size = here < 0 ? -here : here;
        g[i] = size < 8 * kEpsilon || (polynomial && l > n) ? 0.0 : here;
        const double next = ((n + 1.0 - l) * before - (2.0 * l + 1.0) * w * here) / (l + n + 2.0);
        before = here;
        here = next;
    }
}

double band_zero(const WrapLobe& lobe) { return lobe.scale * 2.0 * (1.0 + lobe.wrap) / (lobe.power + 1.0); }

/// Sum of all octaves of bands after one whose sum is `octave`, if each is `ratio` times the one before. A quarter is added, because bands
/// oscillate within their octave.
double octaves_after(double octave, double ratio) {
    if (octave == 0.0) return 0.0;
    return ratio < 1.0 ? 1.25 * octave * ratio / (1.0 - ratio) : kInfinity;
}

/// Upper bounds on the largest errors of the series of 1 to 10 bands: the largest error on a grid of angles with the step h, plus what the
/// grid may miss. Between two points a function with slopes up to s differs from its chord by at most s h / 2, and a series of degree d
/// with values up to m by at most d^2 m h^2 / 8.
std::array<double, kMaxBands> suprema(const WrapLobe& lobe, const LobeSpectrum& spectrum) {
    constexpr int kPoints = 2048;
    constexpr double kStep = kPi / kPoints;
    std::array<double, kMaxBands> out{};
    for (int i = 0; i <= kPoints; ++i) {
        const double x = sin_cos(kStep * i).cos, t = (x + lobe.wrap) / (1.0 + lobe.wrap);
        double rest = t > 0.0 ? lobe.scale * power_of(t, lobe.power) : 0.0, before = 0.0, here = 1.0;
        for (std::size_t l = 0; l < out.size(); ++l) {
            const double degree = static_cast<double>(l);
            rest -= (2.0 * degree + 1.0) / 4.0 * spectrum.f[l] * here;
            const double size = rest < 0 ? -rest : rest;
            if (size > out[l]) out[l] = size;
            const double next = ((2.0 * degree + 1.0) * x * here - degree * before) / (degree + 1.0);
            before = here;
            here = next;
        }
    }
    double most = 0.0;
    for (std::size_t l = 0; l < out.size(); ++l) {
        const double degree = static_cast<double>(l), band = spectrum.f[l] < 0 ? -spectrum.f[l] : spectrum.f[l];
        most += (2.0 * degree + 1.0) / 4.0 * band;
        if (l > 0 && band == 0.0)
            out[l] = out[l - 1];
        else
            out[l] += 0.5 * kStep * spectrum.slope + 0.125 * kStep * kStep * degree * degree * most;
    }
    return out;
}

}  // namespace

BandFactors zonal_bands(const WrapLobe& lobe) {
    BandFactors f{};
    relative_bands(lobe, f);
    for (double& band : f) band *= band_zero(lobe);
    return f;
}

LobeSpectrum lobe_spectrum(const WrapLobe& lobe) {
    constexpr int kLast = 4 * kSpectrumBands, kOctave = 2 * kSpectrumBands;  // the recurrence holds its accuracy this far
    std::array<double, kLast> g{};
    relative_bands(lobe, g);
    const double f0 = band_zero(lobe), size0 = f0 < 0 ? -f0 : f0;
    LobeSpectrum out;
    double squares = 0, sum = 0, octave_squares = 0, octave_sum = 0;
    for (std::size_t l = 0; l < g.size(); ++l) {
        if (l < out.f.size()) {
            out.f[l] = f0 * g[l];
            continue;
        }
        const double weight = static_cast<double>(2 * l + 1) / (4.0 * kPi), size = g[l] < 0 ? -g[l] : g[l];
        squares += weight * size * size;
        sum += weight * size;
        if (l >= kOctave) {
            octave_squares += weight * size * size;
            octave_sum += weight * size;
        }
    }
    squares += octaves_after(octave_squares, exp2_of(-1.0 - 2.0 * lobe.power));
    sum += octaves_after(octave_sum, exp2_of(0.5 - lobe.power));
    out.tail_norm = size0 * __builtin_sqrt(squares);
    out.tail_sum = size0 * sum;
    const double scale = lobe.scale < 0 ? -lobe.scale : lobe.scale;
    out.slope = lobe.power >= 1.0 ? scale * lobe.power / (1.0 + lobe.wrap) : kInfinity;  // t^(n-1) and sin theta are at most 1
    out.sup = suprema(lobe, out);
    return out;
}

}  // namespace halflit::sh
