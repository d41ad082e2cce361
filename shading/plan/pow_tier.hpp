// Tiers of the polynomials for powers, and their errors.
#pragma once

#include <cstdint>

namespace halflit::shading {

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

}  // namespace halflit::shading
