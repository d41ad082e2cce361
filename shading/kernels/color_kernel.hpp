// Linear light to 8-bit codes.
#pragma once

#include "shading/kernels/pow.hpp"
#include "shading/model/srgb.hpp"

#include <bit>

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// x in [0, 1] to its nearest integer code in [0, 255] (ties to even); NaN gives 0.
HALFLIT_INLINE I unorm8(F x) { return round_to_int(clamp(x, F(0.0f), F(1.0f)) * F(255.0f)); }

/// 1.055 x^(1/2.4) - 0.055 as a polynomial in u = x^(1/4), for x from the end of the curve's straight part to 1: minimax, within 0.0004
/// codes. The two square roots run beside the polynomials of other lanes. A logarithm and an exponential would be three times as many
/// operations.
inline constexpr float kSrgbByFourthRoot[] = {-0.0595466085f, 0.139604136f,  1.36592102f,  -0.852957428f,
                                              0.657188296f,   -0.318415970f, 0.0682079792f};

/// The sRGB curve of IEC 61966-2-1: 1.055 x^(1/2.4) - 0.055, 12.92 x below 0.0031308. x in [0, 1]. The code that it rounds to is at
/// most 0.501 from the exact value.
HALFLIT_INLINE F srgb_curve(F x) {
    return sel(x > F(static_cast<float>(shading::kSrgbLinearEnd)), horner(kSrgbByFourthRoot, vsqrt(vsqrt(x))), F(12.92f) * x);
}

HALFLIT_INLINE I srgb8(F linear) { return unorm8(srgb_curve(clamp(linear, F(0.0f), F(1.0f)))); }

HALFLIT_INLINE void encode_srgb8(const float* red, const float* green, const float* blue, const float* alpha, float exposure,
                                 std::uint32_t* rgba8, int count) {
    const F factor(exposure);
    for (int i = 0; i < count; i += kWidth) {
        const I r = srgb8(load(red + i) * factor), g = srgb8(load(green + i) * factor), b = srgb8(load(blue + i) * factor);
        const I a = unorm8(load(alpha + i));
        // Red is the first byte of a pixel in memory.
        const I pixel = std::endian::native == std::endian::little ? (r | shl<8>(g)) | (shl<16>(b) | shl<24>(a))
                                                                   : (a | shl<8>(b)) | (shl<16>(g) | shl<24>(r));
        store(reinterpret_cast<std::int32_t*>(rgba8 + i), pixel);
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
