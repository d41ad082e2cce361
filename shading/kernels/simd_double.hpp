// The vocabulary's doubles: D holds one for each lane of F. Sums, products and quotients are rounded once each, as everywhere.
#pragma once

#include "shading/kernels/simd.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

#if !defined(HALFLIT_ARCH)

using D = double;
HALFLIT_INLINE D d_set(double x) { return x; }
HALFLIT_INLINE D to_double(I i) { return i; }
HALFLIT_INLINE D to_double(F x) { return static_cast<double>(x); }
/// Rounded to nearest even.
HALFLIT_INLINE F to_single(D x) { return static_cast<float>(x); }
HALFLIT_INLINE D vmin(D a, D b) { return a < b ? a : b; }
HALFLIT_INLINE D vmax(D a, D b) { return a > b ? a : b; }
HALFLIT_INLINE D vsqrt(D a) { return __builtin_sqrt(a); }
/// condition > 0 ? a : b
HALFLIT_INLINE D where_positive(D condition, D a, D b) { return condition > 0.0 ? a : b; }
HALFLIT_INLINE void store(double* p, D v) { *p = v; }

#else

// The compiler's own vectors: + - * / are one instruction each, on NEON too.
#if defined(__AVX512F__)
using HalfD = __m512d;
#elif defined(__AVX2__)
using HalfD = __m256d;
#elif defined(HALFLIT_X86_VECTORS)
using HalfD = __m128d;
#else
using HalfD = float64x2_t;
#endif

/// The lower half of the lanes, and the upper.
struct D {
    HalfD low, high;
};

HALFLIT_INLINE D operator+(D a, D b) { return {a.low + b.low, a.high + b.high}; }
HALFLIT_INLINE D operator-(D a, D b) { return {a.low - b.low, a.high - b.high}; }
HALFLIT_INLINE D operator*(D a, D b) { return {a.low * b.low, a.high * b.high}; }
HALFLIT_INLINE D operator/(D a, D b) { return {a.low / b.low, a.high / b.high}; }
HALFLIT_INLINE D vmin(D a, D b) { return {a.low < b.low ? a.low : b.low, a.high < b.high ? a.high : b.high}; }
HALFLIT_INLINE D vmax(D a, D b) { return {a.low > b.low ? a.low : b.low, a.high > b.high ? a.high : b.high}; }
/// condition > 0 ? a : b
HALFLIT_INLINE D where_positive(D condition, D a, D b) {
    const HalfD none{};
    return {condition.low > none ? a.low : b.low, condition.high > none ? a.high : b.high};
}
HALFLIT_INLINE void store(double* p, D v) { __builtin_memcpy(p, &v, sizeof v); }

#if defined(__AVX512F__)
HALFLIT_INLINE D d_set(double x) { return {_mm512_set1_pd(x), _mm512_set1_pd(x)}; }
HALFLIT_INLINE D vsqrt(D a) { return {_mm512_sqrt_pd(a.low), _mm512_sqrt_pd(a.high)}; }
HALFLIT_INLINE D to_double(I i) {
    return {_mm512_cvtepi32_pd(_mm512_castsi512_si256(i)), _mm512_cvtepi32_pd(_mm512_extracti64x4_epi64(i, 1))};
}
HALFLIT_INLINE D to_double(F x) {
    const __m256 high = _mm256_castpd_ps(_mm512_extractf64x4_pd(_mm512_castps_pd(x), 1));
    return {_mm512_cvtps_pd(_mm512_castps512_ps256(x)), _mm512_cvtps_pd(high)};
}
HALFLIT_INLINE F to_single(D x) {
    const __m512d low = _mm512_castpd256_pd512(_mm256_castps_pd(_mm512_cvtpd_ps(x.low)));
    return _mm512_castpd_ps(_mm512_insertf64x4(low, _mm256_castps_pd(_mm512_cvtpd_ps(x.high)), 1));
}
#elif defined(__AVX2__)
HALFLIT_INLINE D d_set(double x) { return {_mm256_set1_pd(x), _mm256_set1_pd(x)}; }
HALFLIT_INLINE D vsqrt(D a) { return {_mm256_sqrt_pd(a.low), _mm256_sqrt_pd(a.high)}; }
HALFLIT_INLINE D to_double(I i) {
    return {_mm256_cvtepi32_pd(_mm256_castsi256_si128(i)), _mm256_cvtepi32_pd(_mm256_extracti128_si256(i, 1))};
}
HALFLIT_INLINE D to_double(F x) { return {_mm256_cvtps_pd(_mm256_castps256_ps128(x)), _mm256_cvtps_pd(_mm256_extractf128_ps(x, 1))}; }
HALFLIT_INLINE F to_single(D x) { return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(x.low)), _mm256_cvtpd_ps(x.high), 1); }
#elif defined(HALFLIT_X86_VECTORS)
HALFLIT_INLINE D d_set(double x) { return {_mm_set1_pd(x), _mm_set1_pd(x)}; }
HALFLIT_INLINE D vsqrt(D a) { return {_mm_sqrt_pd(a.low), _mm_sqrt_pd(a.high)}; }
HALFLIT_INLINE D to_double(I i) { return {_mm_cvtepi32_pd(i), _mm_cvtepi32_pd(_mm_unpackhi_epi64(i, i))}; }
HALFLIT_INLINE D to_double(F x) { return {_mm_cvtps_pd(x), _mm_cvtps_pd(_mm_movehl_ps(x, x))}; }
HALFLIT_INLINE F to_single(D x) { return _mm_movelh_ps(_mm_cvtpd_ps(x.low), _mm_cvtpd_ps(x.high)); }
#else
HALFLIT_INLINE D d_set(double x) { return {vdupq_n_f64(x), vdupq_n_f64(x)}; }
HALFLIT_INLINE D vsqrt(D a) { return {vsqrtq_f64(a.low), vsqrtq_f64(a.high)}; }
HALFLIT_INLINE D to_double(I i) { return {vcvtq_f64_s64(vmovl_s32(vget_low_s32(i))), vcvtq_f64_s64(vmovl_s32(vget_high_s32(i)))}; }
HALFLIT_INLINE D to_double(F x) { return {vcvt_f64_f32(vget_low_f32(x)), vcvt_f64_f32(vget_high_f32(x))}; }
HALFLIT_INLINE F to_single(D x) { return vcombine_f32(vcvt_f32_f64(x.low), vcvt_f32_f64(x.high)); }
#endif

#endif  // HALFLIT_ARCH

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
