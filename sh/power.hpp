// Powers in double from + - * / and exact exponent arithmetic alone, for the reason that sh/trig.hpp gives.
#pragma once

#include "sh/config.hpp"

#include <bit>
#include <cstdint>

namespace halflit {

/// log2(x) for normal x > 0, error below 1e-15 of max(1, |log2 x|).
inline double log2_of(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    auto exponent = static_cast<int>(bits >> 52) - 1023;
    double m = std::bit_cast<double>((bits & 0x000fffffffffffffu) | 0x3ff0000000000000u);
    if (m > 1.4142135623730951) m *= 0.5, ++exponent;
    // ln m = 2 artanh s, |s| <= 0.172; the first dropped term is below 1e-19.
    const double s = (m - 1.0) / (m + 1.0), s2 = s * s;
    double sum = 0.0;
    for (int k = 23; k >= 1; k -= 2) sum = sum * s2 + 1.0 / k;
    return exponent + 2.8853900817779268 * (s * sum);  // 2 / ln 2
}

inline constexpr double kLn2 = 0.69314718055994531;

/// 2^y for y in [-1000, 1000], relative error below 1e-15. Smaller y give 0, larger ones 2^1000.
inline double exp2_of(double y) {
    if (!(y >= -1000.0)) return 0.0;
    if (y > 1000.0) y = 1000.0;
    const auto k = static_cast<int>(y + (y < 0 ? -0.5 : 0.5));
    const double r = (y - k) * kLn2;  // |r| <= 0.35: the first dropped term is below 1e-19
    double sum = 1.0;
    for (int i = 15; i >= 1; --i) sum = 1.0 + sum * r / i;
    return sum * std::bit_cast<double>(static_cast<std::uint64_t>(k + 1023) << 52);
}

/// e^x, with the range and the error of exp2_of plus 2e-16 |x|.
inline double exp_of(double x) { return exp2_of(x * 1.4426950408889634); }  // 1 / ln 2

/// x^p for x >= 0; 0 to any power is 0.
inline double power_of(double x, double p) { return x > 1e-300 ? exp2_of(p * log2_of(x)) : 0.0; }

}  // namespace halflit
