// The vocabulary's filters of records of four channels, unsigned 16-bit numbers or floats, two neighbours in a row by one load. Every set
// computes the same lerps a + w (b - a), in the order down, right, between levels; a weight of 0 gives exactly a.
#pragma once

#include "shading/kernels/simd_records.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// The first of two neighbours in the upper row of four taps, and of two in the lower one.
template <class Value>
struct TapRows {
    const Value *upper, *lower;
};
using TexelRows = TapRows<std::uint16_t>;
/// Weights of the right and of the lower taps.
struct TapWeights {
    float right, down;
};

/// Two records that follow each other in memory.
HALFLIT_INLINE QQ two_records(const float* p) { return qq_load(p); }
#if defined(__AVX2__)
HALFLIT_INLINE QQ two_records(const std::uint16_t* p) {
    return _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p))));
}
#else
HALFLIT_INLINE QQ two_records(const std::uint16_t* p) { return qq_load_u16(p, p + 4); }
#endif
#if defined(__AVX512F__)
/// Two records at either place.
HALFLIT_INLINE __m512 four_records(const std::uint16_t* low, const std::uint16_t* high) {
    const __m256i first = _mm256_castsi128_si256(_mm_loadu_si128(reinterpret_cast<const __m128i*>(low)));
    return _mm512_cvtepi32_ps(
        _mm512_cvtepu16_epi32(_mm256_inserti128_si256(first, _mm_loadu_si128(reinterpret_cast<const __m128i*>(high)), 1)));
}
HALFLIT_INLINE __m512 four_records(const float* low, const float* high) {
    const __m512d first = _mm512_castps_pd(_mm512_castps256_ps512(_mm256_loadu_ps(low)));
    return _mm512_castpd_ps(_mm512_insertf64x4(first, _mm256_castps_pd(_mm256_loadu_ps(high)), 1));
}
#endif

/// The taps of one level.
template <class Value>
HALFLIT_INLINE Q bilinear(TapRows<Value> rows, TapWeights weight) {
    const QQ column = qq_lerp(two_records(rows.upper), two_records(rows.lower), weight.down);
    return q_lerp(qq_low(column), qq_high(column), q_set(weight.right));
}

/// The taps of two levels, and `blend` between them.
template <class Value>
HALFLIT_INLINE Q trilinear(TapRows<Value> near, TapRows<Value> far, TapWeights near_weight, TapWeights far_weight, float blend) {
#if defined(__AVX512F__)
    // One register holds near left, near right, far left, far right.
    const __m512 upper = four_records(near.upper, far.upper), lower = four_records(near.lower, far.lower);
    const __m512 down = _mm512_mask_broadcastss_ps(_mm512_set1_ps(near_weight.down), 0xff00, _mm_set_ss(far_weight.down));
    const __m512 column = _mm512_add_ps(_mm512_mul_ps(down, _mm512_sub_ps(lower, upper)), upper);
    const __m512 sorted = _mm512_shuffle_f32x4(column, column, _MM_SHUFFLE(3, 1, 2, 0));
    const __m256 left = _mm512_castps512_ps256(sorted), right = _mm256_castpd_ps(_mm512_extractf64x4_pd(_mm512_castps_pd(sorted), 1));
#elif defined(__AVX2__)
    const QQ near_column = qq_lerp(two_records(near.upper), two_records(near.lower), near_weight.down);
    const QQ far_column = qq_lerp(two_records(far.upper), two_records(far.lower), far_weight.down);
    const __m256 left = _mm256_insertf128_ps(near_column, _mm256_castps256_ps128(far_column), 1);
    const __m256 right = _mm256_permute2f128_ps(near_column, far_column, 0x31);
#endif
#if defined(__AVX2__)
    const __m256 across = _mm256_blend_ps(_mm256_set1_ps(near_weight.right), _mm256_set1_ps(far_weight.right), 0xf0);
    const __m256 levels = _mm256_add_ps(_mm256_mul_ps(across, _mm256_sub_ps(right, left)), left);
    return q_lerp(qq_low(levels), qq_high(levels), q_set(blend));
#else
    return q_lerp(bilinear(near, near_weight), bilinear(far, far_weight), q_set(blend));
#endif
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
