// Accuracy for speed: the tiers, and what each of them may be off by.
#pragma once

#include <cstdint>

namespace halflit::shading {

enum class Accuracy : std::uint8_t {
    reference,  ///< float64 and the C library, environments by direct integration: slow, and what all others are measured against
    exact,      ///< float32, elementary functions within about 2 ulp
    display,    ///< powers t^n within 2.6e-6 n + 3e-6: at most one 8-bit code from exact, and that rarely
    fast        ///< powers t^n within 1.3e-4 n + 1e-4
};

/// From this power on 1 - t is taken from 1 - x, which is exact for x in [1/2, 1], instead of from t; all tiers then compute the same.
inline constexpr float kSharpPowerMinusOne = 63.0f;

/// Polynomials behind t^n and cos^s.
enum class PowTier : std::uint8_t { exact, display, fast };

/// Relative errors of the two polynomials of a tier: of log2(1 + u) on [sqrt(1/2), sqrt(2)), and of 2^r on [-1/2, 1/2].
struct PowErrors {
    double log2, exp2;
};
constexpr PowErrors pow_errors(PowTier tier) {
    switch (tier) {
        case PowTier::exact:
            break;
        case PowTier::display:
            return {7.4e-6, 2.8e-6};
        case PowTier::fast:
            return {3.5e-4, 1.0e-4};
    }
    return {2.1e-7, 9.5e-8};
}

/// What a frame may be off by, in 8-bit sRGB codes: 255 times the encoded value, before it is rounded to a whole code, of a pixel that one
/// surface fills. `codes` is the sum of the parts, each of which is a bound for every material.
struct ErrorBound {
    double budget = 0;  ///< codes asked for; 0: none was, and nothing below is known
    double codes = 0;
    bool within = true;      ///< codes <= budget; otherwise some material's rounding alone is more, and that is computed exactly
    double rounding = 0;     ///< float32 itself, and texture filters
    double lobes = 0;        ///< shorter polynomials for t^n, or curves
    double specular = 0;     ///< shorter polynomials for cos^s, or curves
    double environment = 0;  ///< bands left out
    double left_out = 0;     ///< lights beyond their reach and highlights too weak to see
};

}  // namespace halflit::shading
