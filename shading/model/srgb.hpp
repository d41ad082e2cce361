// Decoding of the sRGB curve of IEC 61966-2-1. The kernels encode (kernels/color_kernel.hpp); the curve's slope bounds errors
// (code_bounds.hpp).
#pragma once

namespace halflit::shading {

/// End of the curve's straight part, whose slope is 12.92: in linear light, and as an encoded value.
inline constexpr double kSrgbLinearEnd = 0.0031308, kSrgbEncodedEnd = 0.04045;

/// x^2.4 for x in (0, 1]: the twelfth power of the fifth root, which Newton's iteration finds with + - * / alone. The C library's pow
/// may differ in the last bit between CPUs; this does not.
constexpr double power_2_4(double x) {
    double root = 1.0;
    for (int i = 0; i < 64; ++i) {
        const double next = (4.0 * root + x / (root * root * root * root)) / 5.0;
        if (next == root) break;  // all further ones are
        root = next;
    }
    const double cube = root * root * root;
    const double sixth = cube * cube;
    return sixth * sixth;
}

/// Linear light of an encoded value in [0, 1], error below 1e-15.
constexpr double linear_from_srgb(double encoded) {
    return encoded <= kSrgbEncodedEnd ? encoded / 12.92 : power_2_4((encoded + 0.055) / 1.055);
}

}  // namespace halflit::shading
