// Rows of smaller texture levels. Loops over lists of one number, for the compiler's vectors.
#pragma once

#include "shading/kernels/simd.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

static void halve_texels(const std::uint16_t* upper, const std::uint16_t* lower, int width, std::uint16_t* to) {
    for (int x = 0; x < width; ++x, upper += 8, lower += 8, to += 4)
        for (int c = 0; c < 4; ++c) {
            const std::uint32_t sum = std::uint32_t{upper[c]} + upper[c + 4] + lower[c] + lower[c + 4];
            to[c] = static_cast<std::uint16_t>((sum + 2) >> 2);
        }
}

static void unit_normals(const std::uint16_t* texels, int width, double* x, double* y, double* z) {
    constexpr double kUnit = 2.0 / 65535.0;
    for (int i = 0; i < width; ++i) {
        x[i] = texels[4 * i] * kUnit - 1.0;
        y[i] = texels[4 * i + 1] * kUnit - 1.0;
        z[i] = texels[4 * i + 2] * kUnit - 1.0;
    }
    for (int i = 0; i < width; ++i) {
        const double length = __builtin_sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
        const bool has_length = length > 0.0;
        x[i] = has_length ? x[i] / length : 0.0;
        y[i] = has_length ? y[i] / length : 0.0;
        z[i] = has_length ? z[i] / length : 1.0;
    }
}

/// The products are exact.
static void halve_means(const double* upper, const double* lower, int width, double* to) {
    for (int i = 0; i < width; ++i)
        to[i] = ((0.25 * upper[2 * i] + 0.25 * upper[2 * i + 1]) + 0.25 * lower[2 * i]) + 0.25 * lower[2 * i + 1];
}

/// [Tok05]: 1 / s grows by (1 - l) / l, l being the mean's length, and alpha^2 is 2 / s.
static void lost_lengths(const double* x, const double* y, const double* z, int width, std::uint16_t* to) {
    constexpr int kAtOnce = 64;
    std::int32_t lost[kAtOnce];
    for (int first = 0; first < width; first += kAtOnce) {
        const int count = width - first < kAtOnce ? width - first : kAtOnce;
        for (int i = 0; i < count; ++i) {
            const double a = x[first + i], b = y[first + i], c = z[first + i];
            const double l = __builtin_sqrt(a * a + b * b + c * c), scaled = 65535.0 * __builtin_sqrt(2.0 * (1.0 - l) / l);
            const double value = l < 1.0 ? l > 0.0 ? scaled : 65535.0 : 0.0;
            lost[i] = static_cast<std::int32_t>(value < 65535.0 ? value + 0.5 : 65535.0);
        }
        for (int i = 0; i < count; ++i) to[4 * (first + i)] = static_cast<std::uint16_t>(lost[i]);
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
