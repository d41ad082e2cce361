// Included by elementary_<isa>.cpp after HALFLIT_ISA and HALFLIT_ARCH are defined.
#pragma once

#include "elementary.hpp"
#include "shading/kernels/color_kernel.hpp"
#include "shading/kernels/vector.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

#define HALFLIT_UNARY(name, expression)                        \
    static void name(const float* in, float* out, int count) { \
        for (int i = 0; i < count; i += kWidth) {              \
            const F x = load(in + i);                          \
            store(out + i, expression);                        \
        }                                                      \
    }
#define HALFLIT_TERNARY(name, expression)                                                              \
    static void name(const float* in_a, const float* in_b, const float* in_c, float* out, int count) { \
        for (int i = 0; i < count; i += kWidth) {                                                      \
            const F a = load(in_a + i), b = load(in_b + i), c = load(in_c + i);                        \
            (void)b, (void)c;                                                                          \
            store(out + i, expression);                                                                \
        }                                                                                              \
    }

HALFLIT_UNARY(run_sqrt, vsqrt(x))
HALFLIT_UNARY(run_reciprocal, vdiv(F(1.0f), x))
HALFLIT_UNARY(run_abs, vabs(x))
HALFLIT_UNARY(run_negate, vneg(x))
HALFLIT_UNARY(run_round, round_near(clamp(x, F(-4e6f), F(4e6f))))
HALFLIT_UNARY(run_floor, vfloor(clamp(x, F(-4e6f), F(4e6f))))
HALFLIT_UNARY(run_round_to_int, to_float(round_to_int(clamp(x, F(-4e6f), F(4e6f)))))
HALFLIT_UNARY(run_shift, from_bits(shl<3>(shr<5>(bits(x)))))
HALFLIT_UNARY(run_nan, sel(is_nan(x), F(1.0f), F(0.0f)))
HALFLIT_UNARY(run_exp2, exp2_floored(kExp2Degree6, clamp(x, F(-2e3f), F(126.0f))))
HALFLIT_UNARY(run_srgb_curve, srgb_curve(clamp(x, F(0.0f), F(1.0f))))
HALFLIT_UNARY(run_srgb8, to_float(srgb8(x)))
HALFLIT_UNARY(run_unorm8, to_float(unorm8(x)))
static void run_log2(const float* in, float* out, int count) {
    for (int i = 0; i < count; i += kWidth) {
        const Log2 log = log2_parts(kLog2Degree8, vmax(load(in + i), F(0.0f)));
        store(out + i, log.exponent + log.fraction);
    }
}
HALFLIT_TERNARY(run_min, vmin(a, b))
HALFLIT_TERNARY(run_max, vmax(a, b))
HALFLIT_TERNARY(run_divide, vdiv(a, b))
HALFLIT_TERNARY(run_mad, mad(a, b, c))
HALFLIT_TERNARY(run_clamp, clamp(a, b, c))
HALFLIT_TERNARY(run_select, sel(a < b, b, c))
HALFLIT_TERNARY(run_select_equal, sel(a == b, a, c))
HALFLIT_TERNARY(run_integers, from_bits(sel(less(bits(a), bits(b)), bits(b) ^ bits(c), bits(a) & bits(c))))

static void power(const float* t, float n, float* out, int count) {
    const float a = n - 1.0f, high = from_bits(bits(a) & static_cast<std::int32_t>(0xffffffc0u));
    for (int i = 0; i < count; i += kWidth) store(out + i, power_of_unit(load(t + i), a, high, a - high));
}
static void cosine_power(const float* cosine_squared, const float* sine_squared, const float* half_exponent, float* out, int count) {
    for (int i = 0; i < count; i += kWidth)
        store(out + i, power_of_cosine(load(cosine_squared + i), load(sine_squared + i), load(half_exponent + i)));
}
static void normalize_rows(const float* x, const float* y, const float* z, float* out_x, float* out_y, float* out_z, int count) {
    for (int i = 0; i < count; i += kWidth) {
        const V3 v = normalize_any({load(x + i), load(y + i), load(z + i)});
        store(out_x + i, v.x);
        store(out_y + i, v.y);
        store(out_z + i, v.z);
    }
}
static std::uint32_t mask_of_less(const float* a, const float* b) { return mask_bits(load(a) < load(b)); }

static const testing::NamedUnary kUnary[] = {
    {"sqrt", run_sqrt},   {"reciprocal", run_reciprocal},     {"abs", run_abs},     {"negate", run_negate}, {"round", run_round},
    {"floor", run_floor}, {"round to int", run_round_to_int}, {"shift", run_shift}, {"is nan", run_nan},    {"log2", run_log2},
    {"exp2", run_exp2},   {"srgb curve", run_srgb_curve},     {"srgb8", run_srgb8}, {"unorm8", run_unorm8},
};
static const testing::NamedTernary kTernary[] = {
    {"min", run_min},
    {"max", run_max},
    {"divide", run_divide},
    {"mad", run_mad},
    {"clamp", run_clamp},
    {"select", run_select},
    {"select equal", run_select_equal},
    {"integers", run_integers},
};

}  // namespace HALFLIT_ISA_NAMESPACE

namespace testing {
#define HALFLIT_ELEMENTARY HALFLIT_CONCAT(elementary_, HALFLIT_ISA)
extern const Elementary HALFLIT_ELEMENTARY;
const Elementary HALFLIT_ELEMENTARY = {kUnary, 14, kTernary, 8, power, cosine_power, normalize_rows, mask_of_less, kWidth};
}  // namespace testing
}  // namespace halflit
