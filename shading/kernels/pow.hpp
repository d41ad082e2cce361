// Powers from + - * and integer operations: log2 and exp2 as polynomials around exact exponent arithmetic. The coefficients are
// minimax in relative error, rounded to float32; each table states what it approximates and how well.
#pragma once

#include "shading/kernels/simd.hpp"
#include "shading/plan/pow_tier.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// log2(1 + u) / u on [sqrt(1/2) - 1, sqrt(2) - 1]; relative errors, in this order: 7.4e-6, 3.5e-4, 2.1e-7 and 3.8e-8. Constant term
/// 1/ln 2.
inline constexpr float kLog2Degree5[] = {1.44270158f, -0.721206367f, 0.479812503f, -0.366493285f, 0.318202913f, -0.206192777f};
inline constexpr float kLog2Degree3[] = {1.4422704f, -0.724296927f, 0.511273205f, -0.327770442f};
inline constexpr float kLog2Degree7[] = {1.44269502f,  -0.721352816f, 0.480922282f, -0.360238284f,
                                         0.287097692f, -0.248874456f, 0.234040871f, -0.145810664f};
inline constexpr float kLog2Degree8[] = {1.44269502f,   -0.721347392f, 0.48091045f,   -0.360702813f, 0.287915081f,
                                         -0.238943219f, 0.21571368f,   -0.207268372f, 0.125835732f};

/// 2^r on [-1/2, 1/2] with constant term exactly 1; relative errors, in this order: 1.0e-4, 2.8e-6, 9.5e-8 and 5.0e-9. Second term ln 2.
inline constexpr float kExp2Degree3[] = {1.0f, 0.693282902f, 0.242210954f, 0.055009041f};
inline constexpr float kExp2Degree4[] = {1.0f, 0.693124175f, 0.240240976f, 0.0559065267f, 0.00958282873f};
inline constexpr float kExp2Degree5[] = {1.0f, 0.693147004f, 0.240222439f, 0.0555071943f, 0.00967147853f, 0.00132646016f};
inline constexpr float kExp2Degree6[] = {1.0f, 0.693147182f, 0.240226462f, 0.0555034466f, 0.00961854495f, 0.00133990345f, 0.000153534857f};

/// ((c[N-1] x + c[N-2]) x + ...) x + c[0]
template <int N>
HALFLIT_INLINE F horner(const float (&c)[N], F x) {
    F sum(c[N - 1]);
#pragma GCC unroll 16
    for (int i = N - 2; i >= 0; --i) sum = mad(sum, x, F(c[i]));
    return sum;
}

/// The same polynomial of the first N of more coefficients, N = 4 or 8, by pairs (Estrin): two more operations, and a third of the chain of
/// operations that wait for each other. A term goes through 10 roundings at most, its coefficient's own included.
template <int N, int M>
HALFLIT_INLINE F polynomial_by_pairs(const float (&c)[M], F x) {
    static_assert((N == 4 || N == 8) && N <= M);
    const F x2 = x * x;
    const F low = mad(mad(F(c[3]), x, F(c[2])), x2, mad(F(c[1]), x, F(c[0])));
    if constexpr (N == 4) return low;
    const F high = mad(mad(F(c[7]), x, F(c[6])), x2, mad(F(c[5]), x, F(c[4])));
    return mad(high, x2 * x2, low);
}

/// t = 2^exponent (1 + u) with 1 + u in [sqrt(1/2), sqrt(2)), exactly. t >= 0, not NaN; 0 gives exponent -127 and u = 0.
struct Log2Argument {
    F exponent, u;
};
HALFLIT_INLINE Log2Argument log2_argument(F t) {
    const I i = bits(t);
    const I e = shr<23>(i - I(0x3f3504f3));  // sqrt(1/2)
    return {to_float(e), from_bits(i - shl<23>(e)) - F(1.0f)};
}

/// log2(t) = exponent + fraction: an integer, and |fraction| <= 1/2 with the polynomial's relative error, so that the sum is accurate
/// just below t = 1 too. 0 gives -127, denormals some value below -125.
struct Log2 {
    F exponent, fraction;
};
template <int N>
HALFLIT_INLINE Log2 log2_parts(const float (&polynomial)[N], F t) {
    const Log2Argument argument = log2_argument(t);
    return {argument.exponent, argument.u * horner(polynomial, argument.u)};
}

/// x * 2^k for integers k in [-126, 127].
HALFLIT_INLINE F scale_by_power_of_two(F x, F k) { return x * from_bits(shl<23>(round_to_int(k) + I(127))); }

/// Results below this power of two are 0, far above the denormals that some processors are slow with.
inline constexpr float kLowestExponent = -100.0f;

/// 2^y for y <= 127; 0 below kLowestExponent. NaN gives 0.
template <int N>
HALFLIT_INLINE F exp2_floored(const float (&polynomial)[N], F y) {
    const F held = vmax(y, F(kLowestExponent));
    const F k = round_near(held);
    return sel(y >= F(kLowestExponent), scale_by_power_of_two(horner(polynomial, held - k), k), F(0.0f));
}

/// t^n = t * 2^((n-1) log2 t) for t in [0, 1], n > 0. n - 1 = high + low, high in 18 bits: its product with log2's exponent is exact, and
/// so is the subtraction of the nearest integer. Error up to 2.3 ulp for n in [1, 2] (tests/shading/elementary_test.cpp); it grows
/// with n as the condition of t^n does. 1 gives exactly 1, 0 gives 0.
HALFLIT_INLINE F power_of_unit(F t, float power_minus_one, float high, float low) {
    const Log2 log = log2_parts(kLog2Degree8, t);
    const F coarse = F(high) * log.exponent;
    const F fine = mad(F(low), log.exponent, F(power_minus_one) * log.fraction);
    const F y = coarse + fine;
    const F k = round_near(vmax(y, F(kLowestExponent)));
    const F factor = scale_by_power_of_two(horner(kExp2Degree6, (coarse - k) + fine), k);
    return sel(y >= F(kLowestExponent), t * factor, F(0.0f));
}

/// t^n for large n, from t and 1 - t: near 1, t has lost the digits that a large power makes visible. The relative error is a few eps times
/// |ln t^n|, not n eps (tests/shading/extremes_test.cpp). 1 - t = 0 gives exactly 1, t = 0 gives 0.
HALFLIT_INLINE F sharp_power_of_unit(F t, F one_minus_t, F power) {
    const Log2Argument wide = log2_argument(t);
    const M near_one = one_minus_t < F(0.25f);
    const F exponent = sel(near_one, F(0.0f), wide.exponent);
    const F u = sel(near_one, F(0.0f) - one_minus_t, wide.u);
    return sel(t > F(0.0f), exp2_floored(kExp2Degree6, power * mad(u, horner(kLog2Degree8, u), exponent)), F(0.0f));
}

/// t^n as t * 2^((n-1) log2 t), by shorter polynomials and without the splitting. 1 gives exactly 1, 0 gives 0. Errors: pow_errors in
/// shading/plan/pow_tier.hpp.
template <int L, int E>
HALFLIT_INLINE F short_power_of_unit(const float (&log2_polynomial)[L], const float (&exp2_polynomial)[E], F t, float power_minus_one) {
    const Log2 log = log2_parts(log2_polynomial, t);
    return t * exp2_floored(exp2_polynomial, F(power_minus_one) * (log.exponent + log.fraction));
}

/// (cos^2)^half_exponent, the power of a cosine, from both squares. Near 1, log2 is taken of 1 - sin^2 as log1p would, because the cosine
/// has lost the digits that a large exponent makes visible. Elsewhere it is taken of cos^2, because the sine has lost its digits near 90
/// degrees.
template <int L, int E>
HALFLIT_INLINE F power_of_cosine(const float (&log2_polynomial)[L], const float (&exp2_polynomial)[E], F cosine_squared, F sine_squared,
                                 F half_exponent) {
    const Log2Argument wide = log2_argument(vmax(cosine_squared, F(1e-30f)));
    const M near_one = sine_squared < F(0.25f);
    const F exponent = sel(near_one, F(0.0f), wide.exponent);
    const F u = sel(near_one, F(0.0f) - sine_squared, wide.u);
    return exp2_floored(exp2_polynomial, half_exponent * mad(u, horner(log2_polynomial, u), exponent));
}

/// The tier is the same for a whole material.
HALFLIT_INLINE F power_of_cosine(shading::PowTier tier, F cosine_squared, F sine_squared, F half_exponent) {
    switch (tier) {
        case shading::PowTier::exact:
            break;
        case shading::PowTier::display:
            return power_of_cosine(kLog2Degree5, kExp2Degree4, cosine_squared, sine_squared, half_exponent);
        case shading::PowTier::fast:
            return power_of_cosine(kLog2Degree3, kExp2Degree3, cosine_squared, sine_squared, half_exponent);
    }
    return power_of_cosine(kLog2Degree7, kExp2Degree5, cosine_squared, sine_squared, half_exponent);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
