// The vocabulary: every operation that a kernel may use. It and the other files named simd_* alone name xsimd or an intrinsic.
//
// One kernel source is compiled once per instruction set. Before including this header a kernel file defines
//   HALFLIT_ISA   the set's name as an identifier: scalar, sse2, sse41, avx2, avx512, neon64, wasm128
//   HALFLIT_ARCH  the xsimd architecture, e.g. avx2; left undefined for scalar
// and gets F (float lanes), I (int32 lanes), M (one truth value per lane), kWidth, and Q (four floats, one record).
//
// Every operation here gives the same bits on every set: one correctly rounded operation, or integer arithmetic, or a fixed sequence of
// those. Missing on purpose: fused multiply-add, reciprocal and square root estimates, min/max with another rule for NaN and -0, float to
// int conversion out of range, and the C library. Do not use `!=` on floats: for NaN xsimd answers false on AVX and true elsewhere. Use
// is_nan(x) or !(a == b).
//
// All code sits in a namespace named after the instruction set, and xsimd is renamed per set, so that no inline function
// is shared between objects built with different flags (the linker would keep one of them, for all CPUs).
#pragma once

#ifndef HALFLIT_ISA
#error "define HALFLIT_ISA before including simd.hpp"
#endif

#define HALFLIT_CONCAT2(a, b) a##b
#define HALFLIT_CONCAT(a, b) HALFLIT_CONCAT2(a, b)
#define HALFLIT_ISA_NAMESPACE HALFLIT_CONCAT(isa_, HALFLIT_ISA)

#ifdef HALFLIT_ARCH
#define xsimd HALFLIT_CONCAT(xsimd_, HALFLIT_ISA)
#include <xsimd/xsimd.hpp>
// Intel's intrinsics. Emscripten has those of SSE4.1 too, each made of one or a few operations of WebAssembly.
#if defined(__x86_64__) || defined(__wasm_simd128__)
#define HALFLIT_X86_VECTORS
#endif
#endif

#include "sh/config.hpp"

#include <cstdint>
#include <cstring>

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

// ---- float and int32, one lane: the meaning of every operation -------------------------------------------------

HALFLIT_INLINE std::int32_t bits(float x) {
    std::int32_t i;
    __builtin_memcpy(&i, &x, 4);
    return i;
}
HALFLIT_INLINE float from_bits(std::int32_t i) {
    float x;
    __builtin_memcpy(&x, &i, 4);
    return x;
}
/// a < b ? a : b, so b when either is NaN or both are zeros.
HALFLIT_INLINE float vmin(float a, float b) { return a < b ? a : b; }
/// a > b ? a : b, so b when either is NaN or both are zeros.
HALFLIT_INLINE float vmax(float a, float b) { return a > b ? a : b; }
HALFLIT_INLINE std::int32_t vmin(std::int32_t a, std::int32_t b) { return a < b ? a : b; }
HALFLIT_INLINE std::int32_t vmax(std::int32_t a, std::int32_t b) { return a > b ? a : b; }
HALFLIT_INLINE float vdiv(float a, float b) { return a / b; }
HALFLIT_INLINE float vsqrt(float a) { return __builtin_sqrtf(a); }
HALFLIT_INLINE float vabs(float a) { return from_bits(bits(a) & 0x7fffffff); }
HALFLIT_INLINE float vneg(float a) { return from_bits(bits(a) ^ static_cast<std::int32_t>(0x80000000u)); }
/// a * b + c with two roundings.
HALFLIT_INLINE float mad(float a, float b, float c) { return a * b + c; }
HALFLIT_INLINE float sel(bool m, float a, float b) { return m ? a : b; }
HALFLIT_INLINE std::int32_t sel(bool m, std::int32_t a, std::int32_t b) { return m ? a : b; }
/// Exact for |i| < 2^24.
HALFLIT_INLINE float to_float(std::int32_t i) { return static_cast<float>(i); }
template <int N>
HALFLIT_INLINE std::int32_t shl(std::int32_t i) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(i) << N);
}
/// Arithmetic shift.
template <int N>
HALFLIT_INLINE std::int32_t shr(std::int32_t i) {
    return i >> N;
}
/// Nearest integer, ties to even, for |x| < 2^31; the caller keeps other values and NaN out.
HALFLIT_INLINE std::int32_t round_even(float x) { return static_cast<std::int32_t>(__builtin_lrintf(x)); }
/// Bit l is lane l.
HALFLIT_INLINE std::uint32_t mask_bits(bool m) { return m ? 1u : 0u; }
/// Bit l is the sign bit of lane l.
HALFLIT_INLINE std::uint32_t sign_bits(std::int32_t i) { return static_cast<std::uint32_t>(i) >> 31; }

#ifndef HALFLIT_ARCH

using F = float;
using I = std::int32_t;
using M = bool;
inline constexpr int kWidth = 1;

HALFLIT_INLINE F load(const float* p) { return *p; }
HALFLIT_INLINE I load(const std::int32_t* p) { return *p; }
HALFLIT_INLINE void store(float* p, F v) { *p = v; }
HALFLIT_INLINE void store(std::int32_t* p, I v) { *p = v; }
HALFLIT_INLINE F iota_f() { return 0.0f; }
HALFLIT_INLINE I iota_i() { return 0; }
HALFLIT_INLINE F gather(const float* base, I index) { return base[index]; }
HALFLIT_INLINE I gather(const std::int32_t* base, I index) { return base[index]; }
HALFLIT_INLINE M less(I a, I b) { return a < b; }
HALFLIT_INLINE M equal(I a, I b) { return a == b; }
HALFLIT_INLINE std::int32_t first_lane(I i) { return i; }

#else

using Arch = xsimd::HALFLIT_ARCH;
using F = xsimd::batch<float, Arch>;
using I = xsimd::batch<std::int32_t, Arch>;
using M = xsimd::batch_bool<float, Arch>;
inline constexpr int kWidth = static_cast<int>(F::size);

HALFLIT_INLINE F load(const float* p) { return F::load_unaligned(p); }
HALFLIT_INLINE I load(const std::int32_t* p) { return I::load_unaligned(p); }
HALFLIT_INLINE void store(float* p, F v) { v.store_unaligned(p); }
HALFLIT_INLINE void store(std::int32_t* p, I v) { v.store_unaligned(p); }
// From xsimd 11 on, bitwise_cast names the type of an element; before, it named a batch.
#if XSIMD_VERSION_MAJOR >= 11
HALFLIT_INLINE I bits(F x) { return xsimd::bitwise_cast<std::int32_t>(x); }
HALFLIT_INLINE F from_bits(I i) { return xsimd::bitwise_cast<float>(i); }
#else
HALFLIT_INLINE I bits(F x) { return xsimd::bitwise_cast<I>(x); }
HALFLIT_INLINE F from_bits(I i) { return xsimd::bitwise_cast<F>(i); }
#endif
HALFLIT_INLINE F vabs(F a) { return from_bits(bits(a) & I(0x7fffffff)); }
HALFLIT_INLINE F vneg(F a) { return from_bits(bits(a) ^ I(static_cast<std::int32_t>(0x80000000u))); }
HALFLIT_INLINE F mad(F a, F b, F c) { return a * b + c; }
HALFLIT_INLINE F sel(M m, F a, F b) { return xsimd::select(m, a, b); }
HALFLIT_INLINE I sel(M m, I a, I b) { return bits(xsimd::select(m, from_bits(a), from_bits(b))); }
HALFLIT_INLINE F to_float(I i) { return xsimd::to_float(i); }
template <int N>
HALFLIT_INLINE I shl(I i) {
    return i << N;
}
template <int N>
HALFLIT_INLINE I shr(I i) {
    return i >> N;
}

#if defined(HALFLIT_X86_VECTORS)

HALFLIT_INLINE F vdiv(F a, F b) { return a / b; }
#if defined(__AVX512F__)
HALFLIT_INLINE F vsqrt(F a) { return _mm512_sqrt_ps(a); }
HALFLIT_INLINE I round_even(F x) { return _mm512_cvtps_epi32(x); }
HALFLIT_INLINE F vmin(F a, F b) { return _mm512_min_ps(a, b); }
HALFLIT_INLINE F vmax(F a, F b) { return _mm512_max_ps(a, b); }
HALFLIT_INLINE std::uint32_t mask_bits(M m) { return static_cast<std::uint32_t>(static_cast<__mmask16>(m.data)); }
HALFLIT_INLINE std::uint32_t sign_bits(I i) { return _mm512_cmplt_epi32_mask(i, _mm512_setzero_si512()); }
HALFLIT_INLINE I vmin(I a, I b) { return _mm512_min_epi32(a, b); }
HALFLIT_INLINE I vmax(I a, I b) { return _mm512_max_epi32(a, b); }
HALFLIT_INLINE F gather(const float* base, I index) { return _mm512_i32gather_ps(index, base, 4); }
HALFLIT_INLINE I gather(const std::int32_t* base, I index) { return _mm512_i32gather_epi32(index, base, 4); }
HALFLIT_INLINE F look_up8(const float (&table)[8], I index) {
    return _mm512_permutexvar_ps(index, _mm512_castps256_ps512(_mm256_loadu_ps(table)));
}
HALFLIT_INLINE I look_up8(const std::int32_t (&table)[8], I index) {
    const __m256i values = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(table));
    return _mm512_permutexvar_epi32(index, _mm512_castsi256_si512(values));
}
HALFLIT_INLINE F look_up16(const float (&table)[16], I index) { return _mm512_permutexvar_ps(index, _mm512_loadu_ps(table)); }
HALFLIT_INLINE M less(I a, I b) { return M(_mm512_cmplt_epi32_mask(a, b)); }
HALFLIT_INLINE M equal(I a, I b) { return M(_mm512_cmpeq_epi32_mask(a, b)); }
#elif defined(__AVX2__)
HALFLIT_INLINE F vsqrt(F a) { return _mm256_sqrt_ps(a); }
HALFLIT_INLINE I round_even(F x) { return _mm256_cvtps_epi32(x); }
HALFLIT_INLINE F vmin(F a, F b) { return _mm256_min_ps(a, b); }
HALFLIT_INLINE F vmax(F a, F b) { return _mm256_max_ps(a, b); }
HALFLIT_INLINE std::uint32_t mask_bits(M m) { return static_cast<std::uint32_t>(_mm256_movemask_ps(m)); }
HALFLIT_INLINE std::uint32_t sign_bits(I i) { return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(i))); }
HALFLIT_INLINE I vmin(I a, I b) { return _mm256_min_epi32(a, b); }
HALFLIT_INLINE I vmax(I a, I b) { return _mm256_max_epi32(a, b); }
HALFLIT_INLINE F gather(const float* base, I index) { return _mm256_i32gather_ps(base, index, 4); }
HALFLIT_INLINE I gather(const std::int32_t* base, I index) { return _mm256_i32gather_epi32(base, index, 4); }
HALFLIT_INLINE F look_up8(const float (&table)[8], I index) { return _mm256_permutevar8x32_ps(_mm256_loadu_ps(table), index); }
HALFLIT_INLINE I look_up8(const std::int32_t (&table)[8], I index) {
    return _mm256_permutevar8x32_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(table)), index);
}
HALFLIT_INLINE F look_up16(const float (&table)[16], I index) {
    const __m256 upper = _mm256_castsi256_ps(_mm256_slli_epi32(index, 28));  // bit 3 as the sign
    const __m256 low = _mm256_permutevar8x32_ps(_mm256_loadu_ps(table), index);
    return _mm256_blendv_ps(low, _mm256_permutevar8x32_ps(_mm256_loadu_ps(table + 8), index), upper);
}
HALFLIT_INLINE M less(I a, I b) { return M(_mm256_castsi256_ps(_mm256_cmpgt_epi32(b, a))); }
HALFLIT_INLINE M equal(I a, I b) { return M(_mm256_castsi256_ps(_mm256_cmpeq_epi32(a, b))); }
#else
HALFLIT_INLINE F vsqrt(F a) { return _mm_sqrt_ps(a); }
#if defined(__wasm_simd128__)
// Emscripten's _mm_cvtps_epi32 goes lane by lane.
HALFLIT_INLINE I round_even(F x) {
    return I(reinterpret_cast<__m128i>(wasm_i32x4_trunc_sat_f32x4(wasm_f32x4_nearest(reinterpret_cast<v128_t>(static_cast<__m128>(x))))));
}
#else
HALFLIT_INLINE I round_even(F x) { return _mm_cvtps_epi32(x); }
#endif
HALFLIT_INLINE F vmin(F a, F b) { return _mm_min_ps(a, b); }
HALFLIT_INLINE F vmax(F a, F b) { return _mm_max_ps(a, b); }
HALFLIT_INLINE std::uint32_t mask_bits(M m) { return static_cast<std::uint32_t>(_mm_movemask_ps(m)); }
HALFLIT_INLINE std::uint32_t sign_bits(I i) { return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_castsi128_ps(i))); }
HALFLIT_INLINE F gather(const float* base, I index) {
    alignas(16) std::int32_t at[4];
    index.store_aligned(at);
    return _mm_set_ps(base[at[3]], base[at[2]], base[at[1]], base[at[0]]);
}
HALFLIT_INLINE I gather(const std::int32_t* base, I index) {
    alignas(16) std::int32_t at[4];
    index.store_aligned(at);
    return _mm_set_epi32(base[at[3]], base[at[2]], base[at[1]], base[at[0]]);
}
HALFLIT_INLINE M less(I a, I b) { return M(_mm_castsi128_ps(_mm_cmplt_epi32(a, b))); }
HALFLIT_INLINE M equal(I a, I b) { return M(_mm_castsi128_ps(_mm_cmpeq_epi32(a, b))); }
HALFLIT_INLINE I vmin(I a, I b) { return sel(less(a, b), a, b); }
HALFLIT_INLINE I vmax(I a, I b) { return sel(less(b, a), a, b); }
#endif

#elif defined(__aarch64__)

// xsimd's own / and sqrt are estimates with Newton steps here; its min and max order -0 and propagate NaN.
HALFLIT_INLINE F vdiv(F a, F b) { return vdivq_f32(a, b); }
HALFLIT_INLINE F vsqrt(F a) { return vsqrtq_f32(a); }
HALFLIT_INLINE I round_even(F x) { return vcvtnq_s32_f32(x); }
HALFLIT_INLINE F vmin(F a, F b) { return vbslq_f32(vcltq_f32(a, b), a, b); }
HALFLIT_INLINE F vmax(F a, F b) { return vbslq_f32(vcgtq_f32(a, b), a, b); }
HALFLIT_INLINE std::uint32_t sign_bits(I i) {
    const int32x4_t shifts = {0, 1, 2, 3};
    return vaddvq_u32(vshlq_u32(vshrq_n_u32(vreinterpretq_u32_s32(i), 31), shifts));
}
HALFLIT_INLINE std::uint32_t mask_bits(M m) { return sign_bits(I(vreinterpretq_s32_u32(m))); }
HALFLIT_INLINE F gather(const float* base, I index) {
    alignas(16) std::int32_t at[4];
    index.store_aligned(at);
    const float32x4_t v = {base[at[0]], base[at[1]], base[at[2]], base[at[3]]};
    return v;
}
HALFLIT_INLINE I gather(const std::int32_t* base, I index) {
    alignas(16) std::int32_t at[4];
    index.store_aligned(at);
    const int32x4_t v = {base[at[0]], base[at[1]], base[at[2]], base[at[3]]};
    return v;
}
HALFLIT_INLINE I vmin(I a, I b) { return vminq_s32(a, b); }
HALFLIT_INLINE I vmax(I a, I b) { return vmaxq_s32(a, b); }
HALFLIT_INLINE M less(I a, I b) { return M(vcltq_s32(a, b)); }
HALFLIT_INLINE M equal(I a, I b) { return M(vceqq_s32(a, b)); }

#endif

#if defined(__AVX512F__)
HALFLIT_INLINE std::int32_t first_lane(I i) { return _mm_cvtsi128_si32(_mm512_castsi512_si128(i)); }
#elif defined(__AVX2__)
HALFLIT_INLINE std::int32_t first_lane(I i) { return _mm_cvtsi128_si32(_mm256_castsi256_si128(i)); }
#elif defined(HALFLIT_X86_VECTORS)
HALFLIT_INLINE std::int32_t first_lane(I i) { return _mm_cvtsi128_si32(i); }
#elif defined(__aarch64__)
HALFLIT_INLINE std::int32_t first_lane(I i) { return vgetq_lane_s32(i, 0); }
#endif

inline constexpr std::int32_t kIotaLanes[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
HALFLIT_INLINE I iota_i() { return load(kIotaLanes); }
HALFLIT_INLINE F iota_f() { return to_float(iota_i()); }

#endif  // HALFLIT_ARCH

/// table[index], index from 0 to 7 or 15.
#if !defined(__AVX2__) || !defined(HALFLIT_ARCH)
HALFLIT_INLINE F look_up8(const float (&table)[8], I index) { return gather(table, index); }
HALFLIT_INLINE I look_up8(const std::int32_t (&table)[8], I index) { return gather(table, index); }
HALFLIT_INLINE F look_up16(const float (&table)[16], I index) { return gather(table, index); }
#endif

HALFLIT_INLINE M is_nan(F x) { return !(x == x); }
HALFLIT_INLINE bool any(M m) { return mask_bits(m) != 0; }
HALFLIT_INLINE bool all(M m) { return mask_bits(m) == (kWidth == 32 ? ~0u : (1u << kWidth) - 1u); }

/// Nearest integer (ties to even) as a float and as an int, for |x| <= 2^22: adding 1.5 * 2^23 leaves it in the low bits.
/// No conversion instruction is used: those differ between CPUs outside their range and for NaN.
HALFLIT_INLINE F round_near(F x) { return (x + F(12582912.0f)) - F(12582912.0f); }
HALFLIT_INLINE I round_to_int(F x) { return bits(x + F(12582912.0f)) - I(0x4b400000); }
/// Largest integer <= x, for |x| <= 2^22; +0 for -0, by the added 0.
#if defined(__AVX512F__) && defined(HALFLIT_ARCH)
HALFLIT_INLINE F vfloor(F x) { return F(_mm512_roundscale_ps(x, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC)) + F(0.0f); }
#elif defined(__AVX2__) && defined(HALFLIT_ARCH)
HALFLIT_INLINE F vfloor(F x) { return F(_mm256_floor_ps(x)) + F(0.0f); }
#elif defined(__SSE4_1__) && defined(HALFLIT_ARCH)
HALFLIT_INLINE F vfloor(F x) { return F(_mm_floor_ps(x)) + F(0.0f); }
#else
HALFLIT_INLINE F vfloor(F x) {
    const F r = round_near(x);
    return r - sel(r > x, F(1.0f), F(0.0f));
}
#endif
/// Hint: the memory at p is read soon.
HALFLIT_INLINE void prefetch(const void* p) { __builtin_prefetch(p); }
/// max(lo, min(x, hi)); NaN gives lo.
HALFLIT_INLINE F clamp(F x, F lo, F hi) { return vmin(vmax(x, lo), hi); }

// ---- Q: one record of four floats (an attribute slot of a vertex, a texel), 128 bits wide on every set --------------------------

#if !defined(HALFLIT_ARCH)

struct Q {
    float v[4];
};
/// The memory may hold integers, as with all of these loads and stores.
HALFLIT_INLINE Q q_load(const float* p) {
    Q a;
    __builtin_memcpy(&a, p, sizeof a);
    return a;
}
HALFLIT_INLINE void q_store(float* p, Q a) { __builtin_memcpy(p, &a, sizeof a); }
HALFLIT_INLINE Q q_set(float x) { return {{x, x, x, x}}; }
HALFLIT_INLINE Q q_add(Q a, Q b) { return {{a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2], a.v[3] + b.v[3]}}; }
HALFLIT_INLINE Q q_sub(Q a, Q b) { return {{a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2], a.v[3] - b.v[3]}}; }
HALFLIT_INLINE Q q_mul(Q a, Q b) { return {{a.v[0] * b.v[0], a.v[1] * b.v[1], a.v[2] * b.v[2], a.v[3] * b.v[3]}}; }
/// Four unsigned 16-bit integers as floats, exact.
HALFLIT_INLINE Q q_load_u16(const std::uint16_t* p) {
    return {{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]), static_cast<float>(p[3])}};
}
HALFLIT_INLINE void q_transpose(Q& a, Q& b, Q& c, Q& d) {
    const Q t[4] = {a, b, c, d};
    Q* out[4] = {&a, &b, &c, &d};
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) out[i]->v[j] = t[j].v[i];
}

#elif defined(HALFLIT_X86_VECTORS)

using Q = __m128;
HALFLIT_INLINE Q q_load(const float* p) { return _mm_loadu_ps(p); }
HALFLIT_INLINE void q_store(float* p, Q a) { _mm_storeu_ps(p, a); }
HALFLIT_INLINE Q q_set(float x) { return _mm_set1_ps(x); }
HALFLIT_INLINE Q q_add(Q a, Q b) { return _mm_add_ps(a, b); }
HALFLIT_INLINE Q q_sub(Q a, Q b) { return _mm_sub_ps(a, b); }
HALFLIT_INLINE Q q_mul(Q a, Q b) { return _mm_mul_ps(a, b); }
HALFLIT_INLINE Q q_load_u16(const std::uint16_t* p) {
    const __m128i raw = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(p));
    return _mm_cvtepi32_ps(_mm_unpacklo_epi16(raw, _mm_setzero_si128()));
}
HALFLIT_INLINE void q_transpose(Q& a, Q& b, Q& c, Q& d) {
    const __m128 ab_lo = _mm_unpacklo_ps(a, b), ab_hi = _mm_unpackhi_ps(a, b);
    const __m128 cd_lo = _mm_unpacklo_ps(c, d), cd_hi = _mm_unpackhi_ps(c, d);
    a = _mm_movelh_ps(ab_lo, cd_lo);
    b = _mm_movehl_ps(cd_lo, ab_lo);
    c = _mm_movelh_ps(ab_hi, cd_hi);
    d = _mm_movehl_ps(cd_hi, ab_hi);
}

#elif defined(__aarch64__)

using Q = float32x4_t;
HALFLIT_INLINE Q q_load(const float* p) {
    Q a;
    __builtin_memcpy(&a, p, sizeof a);
    return a;
}
HALFLIT_INLINE void q_store(float* p, Q a) { __builtin_memcpy(p, &a, sizeof a); }
HALFLIT_INLINE Q q_set(float x) { return vdupq_n_f32(x); }
HALFLIT_INLINE Q q_add(Q a, Q b) { return vaddq_f32(a, b); }
HALFLIT_INLINE Q q_sub(Q a, Q b) { return vsubq_f32(a, b); }
HALFLIT_INLINE Q q_mul(Q a, Q b) { return vmulq_f32(a, b); }
HALFLIT_INLINE Q q_load_u16(const std::uint16_t* p) { return vcvtq_f32_u32(vmovl_u16(vld1_u16(p))); }
HALFLIT_INLINE void q_transpose(Q& a, Q& b, Q& c, Q& d) {
    const float32x4x2_t ab = vtrnq_f32(a, b), cd = vtrnq_f32(c, d);
    a = vcombine_f32(vget_low_f32(ab.val[0]), vget_low_f32(cd.val[0]));
    b = vcombine_f32(vget_low_f32(ab.val[1]), vget_low_f32(cd.val[1]));
    c = vcombine_f32(vget_high_f32(ab.val[0]), vget_high_f32(cd.val[0]));
    d = vcombine_f32(vget_high_f32(ab.val[1]), vget_high_f32(cd.val[1]));
}

#endif

/// a * b + c with two roundings.
HALFLIT_INLINE Q q_mad(Q a, Q b, Q c) { return q_add(q_mul(a, b), c); }
/// a + weight * (b - a): exactly a for weight 0.
HALFLIT_INLINE Q q_lerp(Q a, Q b, Q weight) { return q_mad(weight, q_sub(b, a), a); }

// ---- QQ: two records side by side, in one register where the set has 256-bit ones -------------------------------

#if defined(__AVX2__)

using QQ = __m256;
HALFLIT_INLINE QQ qq_load(const float* p) { return _mm256_loadu_ps(p); }
HALFLIT_INLINE QQ qq_load_u16(const std::uint16_t* low, const std::uint16_t* high) {
    const __m128 first = _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(low)));
    const __m128 both = _mm_loadh_pi(first, reinterpret_cast<const __m64*>(high));
    return _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(_mm_castps_si128(both)));
}
HALFLIT_INLINE QQ qq_lerp(QQ a, QQ b, float weight) { return _mm256_add_ps(_mm256_mul_ps(_mm256_set1_ps(weight), _mm256_sub_ps(b, a)), a); }
HALFLIT_INLINE Q qq_low(QQ a) { return _mm256_castps256_ps128(a); }
HALFLIT_INLINE Q qq_high(QQ a) { return _mm256_extractf128_ps(a, 1); }

#else

struct QQ {
    Q low, high;
};
HALFLIT_INLINE QQ qq_load(const float* p) { return {q_load(p), q_load(p + 4)}; }
HALFLIT_INLINE QQ qq_load_u16(const std::uint16_t* low, const std::uint16_t* high) { return {q_load_u16(low), q_load_u16(high)}; }
HALFLIT_INLINE QQ qq_lerp(QQ a, QQ b, float weight) { return {q_lerp(a.low, b.low, q_set(weight)), q_lerp(a.high, b.high, q_set(weight))}; }
HALFLIT_INLINE Q qq_low(QQ a) { return a.low; }
HALFLIT_INLINE Q qq_high(QQ a) { return a.high; }

#endif

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
