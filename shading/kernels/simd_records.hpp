// The vocabulary's moves between lanes and records of four floats: no arithmetic, only shuffles.
#pragma once

#include "shading/kernels/simd.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// kWidth records of four floats, `stride` floats apart: lane l of a, b, c, d goes to p[stride l .. stride l + 3].
HALFLIT_INLINE void store4(float* p, std::int64_t stride, F a, F b, F c, F d) {
#if !defined(HALFLIT_ARCH)
    (void)stride;
    q_store(p, Q{{a, b, c, d}});
#elif defined(__AVX512F__)
    const __m512 ab_lo = _mm512_unpacklo_ps(a, b), ab_hi = _mm512_unpackhi_ps(a, b);
    const __m512 cd_lo = _mm512_unpacklo_ps(c, d), cd_hi = _mm512_unpackhi_ps(c, d);
    const __m512 rows[4] = {_mm512_shuffle_ps(ab_lo, cd_lo, 0x44), _mm512_shuffle_ps(ab_lo, cd_lo, 0xee),
                            _mm512_shuffle_ps(ab_hi, cd_hi, 0x44), _mm512_shuffle_ps(ab_hi, cd_hi, 0xee)};
    for (int l = 0; l < 4; ++l) {
        _mm_storeu_ps(p + stride * l, _mm512_castps512_ps128(rows[l]));
        _mm_storeu_ps(p + stride * (l + 4), _mm512_extractf32x4_ps(rows[l], 1));
        _mm_storeu_ps(p + stride * (l + 8), _mm512_extractf32x4_ps(rows[l], 2));
        _mm_storeu_ps(p + stride * (l + 12), _mm512_extractf32x4_ps(rows[l], 3));
    }
#elif defined(__AVX2__)
    const __m256 ab_lo = _mm256_unpacklo_ps(a, b), ab_hi = _mm256_unpackhi_ps(a, b);
    const __m256 cd_lo = _mm256_unpacklo_ps(c, d), cd_hi = _mm256_unpackhi_ps(c, d);
    const __m256 rows[4] = {_mm256_shuffle_ps(ab_lo, cd_lo, 0x44), _mm256_shuffle_ps(ab_lo, cd_lo, 0xee),
                            _mm256_shuffle_ps(ab_hi, cd_hi, 0x44), _mm256_shuffle_ps(ab_hi, cd_hi, 0xee)};
    for (int l = 0; l < 4; ++l) {
        _mm_storeu_ps(p + stride * l, _mm256_castps256_ps128(rows[l]));
        _mm_storeu_ps(p + stride * (l + 4), _mm256_extractf128_ps(rows[l], 1));
    }
#else
    Q r0 = a, r1 = b, r2 = c, r3 = d;
    q_transpose(r0, r1, r2, r3);
    q_store(p, r0);
    q_store(p + stride, r1);
    q_store(p + 2 * stride, r2);
    q_store(p + 3 * stride, r3);
#endif
}

HALFLIT_INLINE void store4(float* p, F a, F b, F c, F d) { store4(p, 4, a, b, c, d); }

/// The reverse: lane l of a, b, c, d comes from records[l].
HALFLIT_INLINE void lanes_of_records(const Q* records, F& a, F& b, F& c, F& d) {
#if !defined(HALFLIT_ARCH)
    a = records[0].v[0], b = records[0].v[1], c = records[0].v[2], d = records[0].v[3];
#elif defined(__AVX2__)
#if defined(__AVX512F__)
    const auto row = [records](int l) __attribute__((always_inline)) {
        const __m256 low = _mm256_insertf128_ps(_mm256_castps128_ps256(records[l]), records[l + 4], 1);
        const __m256 high = _mm256_insertf128_ps(_mm256_castps128_ps256(records[l + 8]), records[l + 12], 1);
        return _mm512_castpd_ps(_mm512_insertf64x4(_mm512_castps_pd(_mm512_castps256_ps512(low)), _mm256_castps_pd(high), 1));
    };
    const __m512 r0 = row(0), r1 = row(1), r2 = row(2), r3 = row(3);
    const __m512 low01 = _mm512_unpacklo_ps(r0, r1), high01 = _mm512_unpackhi_ps(r0, r1);
    const __m512 low23 = _mm512_unpacklo_ps(r2, r3), high23 = _mm512_unpackhi_ps(r2, r3);
    a = _mm512_shuffle_ps(low01, low23, 0x44);
    b = _mm512_shuffle_ps(low01, low23, 0xee);
    c = _mm512_shuffle_ps(high01, high23, 0x44);
    d = _mm512_shuffle_ps(high01, high23, 0xee);
#else
    const auto row = [records](int l) __attribute__((always_inline)) {
        return _mm256_insertf128_ps(_mm256_castps128_ps256(records[l]), records[l + 4], 1);
    };
    const __m256 r0 = row(0), r1 = row(1), r2 = row(2), r3 = row(3);
    const __m256 low01 = _mm256_unpacklo_ps(r0, r1), high01 = _mm256_unpackhi_ps(r0, r1);
    const __m256 low23 = _mm256_unpacklo_ps(r2, r3), high23 = _mm256_unpackhi_ps(r2, r3);
    a = _mm256_shuffle_ps(low01, low23, 0x44);
    b = _mm256_shuffle_ps(low01, low23, 0xee);
    c = _mm256_shuffle_ps(high01, high23, 0x44);
    d = _mm256_shuffle_ps(high01, high23, 0xee);
#endif
#else
    Q r0 = records[0], r1 = records[1], r2 = records[2], r3 = records[3];
    q_transpose(r0, r1, r2, r3);
    a = r0, b = r1, c = r2, d = r3;
#endif
}

/// The same from any places: lane l of a, b, c, d is p[l][0 .. 3].
HALFLIT_INLINE void load4(const float* const* p, F& a, F& b, F& c, F& d) {
    Q records[kWidth];
    for (int l = 0; l < kWidth; ++l) records[l] = q_load(p[l]);
    lanes_of_records(records, a, b, c, d);
}

#if defined(HALFLIT_X86_VECTORS)
/// Four floats from p on in the first quarter or half of a register, those from p + step in the next one, and so on; and _mm_shuffle_ps in
/// each of them.
#if defined(__AVX512F__)
HALFLIT_INLINE __m512 quarters(const float* p, int step) {
    const __m256 low = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(p)), _mm_loadu_ps(p + step), 1);
    const __m256 high = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(p + 2 * step)), _mm_loadu_ps(p + 3 * step), 1);
    return _mm512_castpd_ps(_mm512_insertf64x4(_mm512_castps_pd(_mm512_castps256_ps512(low)), _mm256_castps_pd(high), 1));
}
template <int kOrder>
HALFLIT_INLINE __m512 shuffle_quarters(__m512 a, __m512 b) {
    return _mm512_shuffle_ps(a, b, kOrder);
}
#elif defined(__AVX2__)
HALFLIT_INLINE __m256 quarters(const float* p, int step) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(p)), _mm_loadu_ps(p + step), 1);
}
template <int kOrder>
HALFLIT_INLINE __m256 shuffle_quarters(__m256 a, __m256 b) {
    return _mm256_shuffle_ps(a, b, kOrder);
}
#else
HALFLIT_INLINE __m128 quarters(const float* p, int) { return _mm_loadu_ps(p); }
template <int kOrder>
HALFLIT_INLINE __m128 shuffle_quarters(__m128 a, __m128 b) {
    return _mm_shuffle_ps(a, b, kOrder);
}
#endif
#endif

/// Packed pairs: lane l of x, y is p[2 l], p[2 l + 1].
HALFLIT_INLINE void load2(const float* p, F& x, F& y) {
#if !defined(HALFLIT_ARCH)
    x = p[0], y = p[1];
#elif defined(HALFLIT_X86_VECTORS)
    const auto first = quarters(p, 8), second = quarters(p + 4, 8);
    x = shuffle_quarters<_MM_SHUFFLE(2, 0, 2, 0)>(first, second);
    y = shuffle_quarters<_MM_SHUFFLE(3, 1, 3, 1)>(first, second);
#else
    const float32x4x2_t rows = vld2q_f32(p);
    x = rows.val[0], y = rows.val[1];
#endif
}

/// Packed triples: lane l of x, y, z is p[3 l .. 3 l + 2].
HALFLIT_INLINE void load3(const float* p, F& x, F& y, F& z) {
#if !defined(HALFLIT_ARCH)
    x = p[0], y = p[1], z = p[2];
#elif defined(HALFLIT_X86_VECTORS)
    const auto first = quarters(p, 12), second = quarters(p + 4, 12), third = quarters(p + 8, 12);  // x0 y0 z0 x1, y1 z1 x2 y2, z2 x3 y3 z3
    const auto x2_y2_x3_y3 = shuffle_quarters<_MM_SHUFFLE(2, 1, 3, 2)>(second, third);
    const auto y0_z0_y1_z1 = shuffle_quarters<_MM_SHUFFLE(1, 0, 2, 1)>(first, second);
    x = shuffle_quarters<_MM_SHUFFLE(2, 0, 3, 0)>(first, x2_y2_x3_y3);
    y = shuffle_quarters<_MM_SHUFFLE(3, 1, 2, 0)>(y0_z0_y1_z1, x2_y2_x3_y3);
    z = shuffle_quarters<_MM_SHUFFLE(3, 0, 3, 1)>(y0_z0_y1_z1, third);
#else
    const float32x4x3_t rows = vld3q_f32(p);
    x = rows.val[0], y = rows.val[1], z = rows.val[2];
#endif
}

/// Packed quadruples: lane l of x, y, z, w is p[4 l .. 4 l + 3].
HALFLIT_INLINE void load4(const float* p, F& x, F& y, F& z, F& w) {
    Q records[kWidth];
    for (int l = 0; l < kWidth; ++l) records[l] = q_load(p + 4 * l);
    lanes_of_records(records, x, y, z, w);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
