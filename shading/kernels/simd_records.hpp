// The vocabulary's moves between lanes and records of four floats: no arithmetic, only shuffles.
#pragma once

#include "shading/kernels/simd.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// (a0, a1, b0, b1) and (a2, a3, b2, b3).
#if !defined(HALFLIT_ARCH)
HALFLIT_INLINE Q q_low_pair(Q a, Q b) { return {{a.v[0], a.v[1], b.v[0], b.v[1]}}; }
HALFLIT_INLINE Q q_high_pair(Q a, Q b) { return {{a.v[2], a.v[3], b.v[2], b.v[3]}}; }
#elif defined(__x86_64__)
HALFLIT_INLINE Q q_low_pair(Q a, Q b) { return _mm_movelh_ps(a, b); }
HALFLIT_INLINE Q q_high_pair(Q a, Q b) { return _mm_movehl_ps(b, a); }
#elif defined(__aarch64__)
HALFLIT_INLINE Q q_low_pair(Q a, Q b) { return vcombine_f32(vget_low_f32(a), vget_low_f32(b)); }
HALFLIT_INLINE Q q_high_pair(Q a, Q b) { return vcombine_f32(vget_high_f32(a), vget_high_f32(b)); }
#endif

/// kWidth records of four floats: lane l of a, b, c, d goes to p[4 l .. 4 l + 3].
HALFLIT_INLINE void store4(float* p, F a, F b, F c, F d) {
#if !defined(HALFLIT_ARCH)
    q_store(p, Q{{a, b, c, d}});
#elif defined(__AVX512F__)
    const __m512 ab_lo = _mm512_unpacklo_ps(a, b), ab_hi = _mm512_unpackhi_ps(a, b);
    const __m512 cd_lo = _mm512_unpacklo_ps(c, d), cd_hi = _mm512_unpackhi_ps(c, d);
    const __m512 rows[4] = {_mm512_shuffle_ps(ab_lo, cd_lo, 0x44), _mm512_shuffle_ps(ab_lo, cd_lo, 0xee),
                            _mm512_shuffle_ps(ab_hi, cd_hi, 0x44), _mm512_shuffle_ps(ab_hi, cd_hi, 0xee)};
    for (int l = 0; l < 4; ++l) {
        _mm_storeu_ps(p + 4 * l, _mm512_castps512_ps128(rows[l]));
        _mm_storeu_ps(p + 4 * (l + 4), _mm512_extractf32x4_ps(rows[l], 1));
        _mm_storeu_ps(p + 4 * (l + 8), _mm512_extractf32x4_ps(rows[l], 2));
        _mm_storeu_ps(p + 4 * (l + 12), _mm512_extractf32x4_ps(rows[l], 3));
    }
#elif defined(__AVX2__)
    const __m256 ab_lo = _mm256_unpacklo_ps(a, b), ab_hi = _mm256_unpackhi_ps(a, b);
    const __m256 cd_lo = _mm256_unpacklo_ps(c, d), cd_hi = _mm256_unpackhi_ps(c, d);
    const __m256 rows[4] = {_mm256_shuffle_ps(ab_lo, cd_lo, 0x44), _mm256_shuffle_ps(ab_lo, cd_lo, 0xee),
                            _mm256_shuffle_ps(ab_hi, cd_hi, 0x44), _mm256_shuffle_ps(ab_hi, cd_hi, 0xee)};
    for (int l = 0; l < 4; ++l) {
        _mm_storeu_ps(p + 4 * l, _mm256_castps256_ps128(rows[l]));
        _mm_storeu_ps(p + 4 * (l + 4), _mm256_extractf128_ps(rows[l], 1));
    }
#else
    Q r0 = a, r1 = b, r2 = c, r3 = d;
    q_transpose(r0, r1, r2, r3);
    q_store(p, r0);
    q_store(p + 4, r1);
    q_store(p + 8, r2);
    q_store(p + 12, r3);
#endif
}

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

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
