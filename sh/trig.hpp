// Sine and cosine in double from + - * / alone. The C library's versions differ in the last bit between CPUs (they have FMA variants), so
// set-up code whose results reach pixels uses these.
// Error: below 1e-15 for |x| <= 1e3 (tests/sh/trig_test.cpp).
#pragma once

#include "sh/config.hpp"

namespace halflit {

inline constexpr double kPi = 3.14159265358979323846;
/// The golden section of a turn, (sqrt(5) - 1) / 2: steps of a spiral that fills a disc evenly.
inline constexpr double kGoldenTurn = 0.6180339887498949;

namespace detail {
/// Taylor series on |r| <= pi/4; the first dropped term is below 2^-53 relative.
HALFLIT_INLINE constexpr double sin_core(double r) {
    const double s = r * r;
    double p = 1.0 / 355687428096000.0;  // 1/17!
    p = p * s - 1.0 / 1307674368000.0;
    p = p * s + 1.0 / 6227020800.0;
    p = p * s - 1.0 / 39916800.0;
    p = p * s + 1.0 / 362880.0;
    p = p * s - 1.0 / 5040.0;
    p = p * s + 1.0 / 120.0;
    p = p * s - 1.0 / 6.0;
    return r + r * (s * p);
}
HALFLIT_INLINE constexpr double cos_core(double r) {
    const double s = r * r;
    double p = -1.0 / 6402373705728000.0;  // 1/18!
    p = p * s + 1.0 / 20922789888000.0;
    p = p * s - 1.0 / 87178291200.0;
    p = p * s + 1.0 / 479001600.0;
    p = p * s - 1.0 / 3628800.0;
    p = p * s + 1.0 / 40320.0;
    p = p * s - 1.0 / 720.0;
    p = p * s + 1.0 / 24.0;
    return 1.0 - 0.5 * s + (s * s) * p;
}
}  // namespace detail

struct SinCos {
    double sin, cos;
};

/// Sine and cosine of x radians, |x| <= 1e6; NaN and larger arguments give (0, 1).
HALFLIT_INLINE constexpr SinCos sin_cos(double x) {
    if (!(x >= -1e6 && x <= 1e6)) return {0.0, 1.0};
    const double k_real = x * (2.0 / kPi);
    const long long k = static_cast<long long>(k_real < 0 ? k_real - 0.5 : k_real + 0.5);
    // pi/2 in two parts: the first has 33 bits, so k * part1 is exact.
    const double r = (x - static_cast<double>(k) * 1.57079632673412561417) - static_cast<double>(k) * 6.07710050650619224932e-11;
    const double s = detail::sin_core(r), c = detail::cos_core(r);
    switch (((k % 4) + 4) % 4) {
        case 0:
            return {s, c};
        case 1:
            return {c, -s};
        case 2:
            return {-s, -c};
        default:
            return {-c, s};
    }
}

}  // namespace halflit
