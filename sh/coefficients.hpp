// Expansions in spherical harmonics with three channels. Radiance and the light that a lobe reflects of it are different types, so that
// radiance coefficients cannot be used as irradiance by mistake. convolve() is the only way from one to the other.
#pragma once

#include "sh/basis.hpp"

#include <array>

namespace halflit::sh {

/// One factor for each band.
using BandFactors = std::array<double, kMaxBands>;

/// L(d) = sum of c[i] Y_i(d) over the bands 0..bands-1; coefficients past them are zero.
template <class T>
struct Expansion {
    int bands = 0;
    std::array<Vec3<T>, kMaxCoefficients> c{};
};

/// Incoming radiance, linear rgb.
using RadianceSh = Expansion<double>;

/// Light reflected by a white surface with a given lobe: (1/pi) times the integral of L(d) f(N.d), as an expansion in the normal N. The
/// factor 1/pi is inside, as in a light's colour: a sky of constant radiance 1 gives 1 for Lambert. There is one array per channel, because
/// kernels broadcast coefficients; coefficients past `bands` are zero.
struct PreconvolvedSh {
    int bands = 0;
    std::array<float, kMaxCoefficients> r{}, g{}, b{};
};

template <class T>
[[nodiscard]] Vec3<T> evaluate(const Expansion<T>& sh, Vec3<T> d) {
    T y[kMaxCoefficients];
    evaluate_basis<kMaxBands>(d, y);
    Vec3<T> sum{};
    for (int i = 0; i < coefficient_count(sh.bands); ++i) sum = sum + sh.c[static_cast<std::size_t>(i)] * y[i];
    return sum;
}

/// Definition of the result of every faster evaluation: in double, coefficients in ascending order. May be negative.
[[nodiscard]] inline Vec3d evaluate(const PreconvolvedSh& sh, Vec3d normal) {
    double y[kMaxCoefficients];
    evaluate_basis<kMaxBands>(normal, y);
    Vec3d sum{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(coefficient_count(sh.bands)); ++i)
        sum = sum + Vec3d{sh.r[i], sh.g[i], sh.b[i]} * y[i];
    return sum;
}

/// Multiplies each band by its factor.
template <class T>
[[nodiscard]] Expansion<T> scaled_by_band(const Expansion<T>& sh, const BandFactors& factors) {
    Expansion<T> out{sh.bands, {}};
    for (int l = 0; l < sh.bands; ++l)
        for (int m = -l; m <= l; ++m) {
            const auto i = static_cast<std::size_t>(coefficient_index(l, m));
            out.c[i] = sh.c[i] * static_cast<T>(factors[static_cast<std::size_t>(l)]);
        }
    return out;
}

/// The first `bands` bands alone; asking for more than there are changes nothing.
template <class T>
[[nodiscard]] Expansion<T> truncated(const Expansion<T>& sh, int bands) {
    Expansion<T> out{bands < sh.bands ? bands : sh.bands, {}};
    for (std::size_t i = 0; i < static_cast<std::size_t>(coefficient_count(out.bands)); ++i) out.c[i] = sh.c[i];
    return out;
}

/// Turns radiance into the light that a lobe with these bands (sh/zonal.hpp) reflects of it, at order `bands`.
[[nodiscard]] inline PreconvolvedSh convolve(const RadianceSh& radiance, const BandFactors& lobe, int bands) {
    const RadianceSh product = scaled_by_band(truncated(radiance, bands), lobe);
    PreconvolvedSh out;
    out.bands = product.bands;
    for (std::size_t i = 0; i < static_cast<std::size_t>(coefficient_count(out.bands)); ++i) {
        out.r[i] = static_cast<float>(product.c[i].x);
        out.g[i] = static_cast<float>(product.c[i].y);
        out.b[i] = static_cast<float>(product.c[i].z);
    }
    return out;
}

}  // namespace halflit::sh
