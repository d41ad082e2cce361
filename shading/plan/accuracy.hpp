// Accuracy tiers: less accuracy for more speed, and bounds on the error of each tier.
#pragma once

#include <cstdint>

namespace halflit::shading {

enum class Accuracy : std::uint8_t {
    reference,  ///< float64 and the C library, environments by direct integration: slow; errors are measured against it
    exact,      ///< float32, elementary functions within about 2 ulp
    display,    ///< relative error of t^n: 2.6e-6 n + 3e-6; at most one 8-bit code from exact, and that rarely
    fast        ///< relative error of t^n: 1.3e-4 n + 1e-4
};

/// Least n - 1 of a sharp power t^n. For these, 1 - t is computed from 1 - x, which is exact for x in [1/2, 1], instead of from t. All
/// tiers compute them in the same way.
inline constexpr float kSharpPowerMinusOne = 63.0f;

/// Polynomials used for t^n and cos^s.
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

/// Bound on the error of a frame in 8-bit sRGB codes: 255 times the encoded value, before it is rounded to a whole code, of a pixel that
/// one surface fills. `codes` is the sum of the parts below it, for the material where that sum is largest.
struct ErrorBound {
    double budget = 0;  ///< codes asked for; 0: no budget, and nothing below is known
    double codes = 0;
    bool within = true;      ///< codes <= budget; if not, rounding and bands alone exceed it for some material, which is computed exactly
    double rounding = 0;     ///< float32 itself, and texture filters
    double lobes = 0;        ///< shorter polynomials for t^n, or curves
    double specular = 0;     ///< shorter polynomials for cos^s, or curves
    double environment = 0;  ///< bands left out
    double left_out = 0;     ///< lights beyond their cutoff radius, and highlights too weak to see
};

}  // namespace halflit::shading
