// The vocabulary's packing: some lanes of a vector, stored side by side.
#pragma once

#include "shading/kernels/simd.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

#if defined(__AVX2__) && !defined(__AVX512F__)
/// For each set of eight lanes, their numbers in order, as bytes.
struct LaneOrders {
    std::uint64_t of[256] = {};
    constexpr LaneOrders() {
        for (std::uint64_t lanes = 0; lanes < 256; ++lanes) {
            int place = 0;
            for (std::uint64_t l = 0; l < 8; ++l)
                if ((lanes >> l & 1) != 0) of[lanes] |= l << (8 * place++);
        }
    }
};
inline constexpr LaneOrders kLaneOrders;
#elif defined(__SSE4_1__) || defined(__aarch64__)
/// For each set of four lanes, the bytes of these lanes in order.
struct ByteOrders {
    alignas(16) std::uint8_t of[16][16] = {};
    constexpr ByteOrders() {
        for (unsigned lanes = 0; lanes < 16; ++lanes) {
            int place = 0;
            for (unsigned l = 0; l < 4; ++l)
                if ((lanes >> l & 1) != 0)
                    for (unsigned byte = 0; byte < 4; ++byte) of[lanes][place++] = static_cast<std::uint8_t>(4 * l + byte);
        }
    }
};
inline constexpr ByteOrders kByteOrders;
#endif

/// Stores the lanes of x whose bits are set in `lanes` at p[0], p[1] .., in order. Up to kWidth numbers from p on are overwritten.
HALFLIT_INLINE void store_packed(std::int32_t* p, I x, std::uint32_t lanes) {
#if defined(HALFLIT_ARCH) && defined(__AVX512F__)
    _mm512_storeu_si512(p, _mm512_maskz_compress_epi32(static_cast<__mmask16>(lanes), x));
#elif defined(HALFLIT_ARCH) && defined(__AVX2__)
    const __m256i order = _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(&kLaneOrders.of[lanes])));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm256_permutevar8x32_epi32(x, order));
#elif defined(HALFLIT_ARCH) && defined(__SSE4_1__)
    const __m128i order = _mm_load_si128(reinterpret_cast<const __m128i*>(kByteOrders.of[lanes]));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm_shuffle_epi8(x, order));
#elif defined(HALFLIT_ARCH) && defined(__aarch64__)
    const uint8x16_t order = vld1q_u8(kByteOrders.of[lanes]);
    vst1q_s32(p, vreinterpretq_s32_u8(vqtbl1q_u8(vreinterpretq_u8_s32(x), order)));
#else
    alignas(16) std::int32_t all[kWidth];
    store(all, x);
    for (; lanes != 0; lanes &= lanes - 1) *p++ = all[__builtin_ctz(lanes)];
#endif
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
