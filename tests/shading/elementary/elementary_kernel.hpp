// Included by elementary_<isa>.cpp after HALFLIT_ISA and HALFLIT_ARCH are defined.
#pragma once

#include "elementary.hpp"
#include "shading/kernels/color_kernel.hpp"
#include "shading/kernels/simd_double.hpp"
#include "shading/kernels/simd_records.hpp"
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

HALFLIT_INLINE F sum(Log2 log) { return log.exponent + log.fraction; }
/// n - 1, split into a part that power_of_unit multiplies exactly and the rest.
struct SplitPower {
    explicit SplitPower(float n)
        : minus_one(n - 1.0f), high(from_bits(bits(minus_one) & static_cast<std::int32_t>(0xffffffc0u))), low(minus_one - high) {}
    float minus_one, high, low;
};
HALFLIT_INLINE F power_to(F t, float n) {
    const SplitPower split(n);
    return power_of_unit(clamp(t, F(0.0f), F(1.0f)), split.minus_one, split.high, split.low);
}
HALFLIT_INLINE F display_power_to(F t, float n) {
    return short_power_of_unit(kLog2Degree5, kExp2Degree4, clamp(t, F(0.0f), F(1.0f)), n - 1.0f);
}
HALFLIT_INLINE F fast_power_to(F t, float n) {
    return short_power_of_unit(kLog2Degree3, kExp2Degree3, clamp(t, F(0.0f), F(1.0f)), n - 1.0f);
}
HALFLIT_INLINE F sharp_power_to(F one_minus_t, float n) {
    const F held = clamp(one_minus_t, F(0.0f), F(1.0f));
    return sharp_power_of_unit(F(1.0f) - held, held, F(n));
}
HALFLIT_INLINE F cosine_power_to(F sine_squared, float half_exponent, shading::PowTier tier = shading::PowTier::exact) {
    const F held = clamp(sine_squared, F(0.0f), F(1.0f));
    return power_of_cosine(tier, F(1.0f) - held, held, F(half_exponent));
}

/// Functions of x written as records of four and read in place.
HALFLIT_INLINE F records_there_and_back(F x) {
    alignas(64) float records[4 * kWidth];
    store4(records, x, x * F(2.0f), x + F(1.0f), x * x);
    const float* at[kWidth];
    for (int l = 0; l < kWidth; ++l) at[l] = records + 4 * l;
    F a, b, c, d;
    load4(at, a, b, c, d);
    return (a + b * F(3.0f)) + (c * F(5.0f) - d);
}

/// x and functions of it written one after the other, and read as pairs, triples and quadruples.
HALFLIT_INLINE F packed_there_and_back(F x) {
    float lanes[kWidth], pairs[2 * kWidth], triples[3 * kWidth], quadruples[4 * kWidth], apart[5 * kWidth];
    store(lanes, x);
    for (int l = 0; l < kWidth; ++l) {
        for (int i = 0; i < 4; ++i) {
            const float value = i == 0 ? lanes[l] : i == 1 ? lanes[l] * 2.0f : i == 2 ? lanes[l] + 1.0f : lanes[l] * 0.5f;
            if (i < 2) pairs[2 * l + i] = value;
            if (i < 3) triples[3 * l + i] = value;
            quadruples[4 * l + i] = value;
        }
    }
    F a, b, c, d, e, f, g, h, i;
    load2(pairs, a, b);
    load3(triples, c, d, e);
    load4(quadruples, f, g, h, i);
    store4(apart, 5, a - b, d + c, e, i);
    F sum = (f + g * F(3.0f)) + (h * F(5.0f) - i);
    for (int k = 0; k < 4; ++k) {
        for (int l = 0; l < kWidth; ++l) lanes[l] = apart[5 * l + k];
        sum = sum * F(0.75f) + load(lanes);
    }
    return sum;
}

HALFLIT_UNARY(run_sqrt, vsqrt(x))
HALFLIT_UNARY(run_reciprocal, vdiv(F(1.0f), x))
HALFLIT_UNARY(run_reciprocal_sqrt, vdiv(F(1.0f), vsqrt(x)))
HALFLIT_UNARY(run_times_sqrt, vsqrt(x) * x)
HALFLIT_UNARY(run_int_to_float, to_float(shr<7>(bits(x))))
HALFLIT_UNARY(run_round_even, to_float(shr<7>(round_even(clamp(x, F(-2e9f), F(2e9f))))))
HALFLIT_UNARY(run_abs, vabs(x))
HALFLIT_UNARY(run_negate, vneg(x))
HALFLIT_UNARY(run_round, round_near(clamp(x, F(-4e6f), F(4e6f))))
HALFLIT_UNARY(run_floor, vfloor(clamp(x, F(-4e6f), F(4e6f))))
HALFLIT_UNARY(run_round_to_int, to_float(round_to_int(clamp(x, F(-4e6f), F(4e6f)))))
HALFLIT_UNARY(run_shift, from_bits(shl<3>(shr<5>(bits(x)))))
HALFLIT_UNARY(run_double, to_single(to_double(x) * d_set(0.7) - d_set(1.0) / to_double(x)))
HALFLIT_UNARY(run_int_to_double, to_single(to_double(bits(x)) + d_set(0.3)))
HALFLIT_UNARY(run_records, records_there_and_back(x))
HALFLIT_UNARY(run_packed, packed_there_and_back(x))
HALFLIT_UNARY(run_nan, sel(is_nan(x), F(1.0f), F(0.0f)))
HALFLIT_UNARY(run_exp2, exp2_floored(kExp2Degree6, clamp(x, F(-2e3f), F(126.0f))))
HALFLIT_UNARY(run_exp2_degree4, exp2_floored(kExp2Degree4, clamp(x, F(-2e3f), F(126.0f))))
HALFLIT_UNARY(run_exp2_degree5, exp2_floored(kExp2Degree5, clamp(x, F(-2e3f), F(126.0f))))
HALFLIT_UNARY(run_srgb_curve, srgb_curve(clamp(x, F(0.0f), F(1.0f))))
HALFLIT_UNARY(run_srgb8, to_float(srgb8(x)))
HALFLIT_UNARY(run_unorm8, to_float(unorm8(x)))
HALFLIT_UNARY(run_log2_degree5, sum(log2_parts(kLog2Degree5, vmax(x, F(0.0f)))))
HALFLIT_UNARY(run_log2_degree7, sum(log2_parts(kLog2Degree7, vmax(x, F(0.0f)))))
HALFLIT_UNARY(run_log2, sum(log2_parts(kLog2Degree8, vmax(x, F(0.0f)))))
HALFLIT_UNARY(run_power_05, power_to(x, 0.5f))
HALFLIT_UNARY(run_power_13, power_to(x, 1.3f))
HALFLIT_UNARY(run_power_165, power_to(x, 16.5f))
HALFLIT_UNARY(run_power_1000, power_to(x, 1000.0f))
HALFLIT_UNARY(run_display_power_13, display_power_to(x, 1.3f))
HALFLIT_UNARY(run_display_power_165, display_power_to(x, 16.5f))
HALFLIT_UNARY(run_fast_power_13, fast_power_to(x, 1.3f))
HALFLIT_UNARY(run_fast_power_165, fast_power_to(x, 16.5f))
HALFLIT_UNARY(run_sharp_power_100, sharp_power_to(x, 100.0f))
HALFLIT_UNARY(run_sharp_power_10000, sharp_power_to(x, 10000.0f))
HALFLIT_UNARY(run_cosine_power_1, cosine_power_to(x, 1.0f))
HALFLIT_UNARY(run_cosine_power_20, cosine_power_to(x, 20.0f))
HALFLIT_UNARY(run_cosine_power_30000, cosine_power_to(x, 30000.0f))
HALFLIT_UNARY(run_display_cosine_power_20, cosine_power_to(x, 20.0f, shading::PowTier::display))
HALFLIT_UNARY(run_display_cosine_power_30000, cosine_power_to(x, 30000.0f, shading::PowTier::display))
HALFLIT_UNARY(run_fast_cosine_power_20, cosine_power_to(x, 20.0f, shading::PowTier::fast))
HALFLIT_UNARY(run_fast_cosine_power_30000, cosine_power_to(x, 30000.0f, shading::PowTier::fast))
HALFLIT_TERNARY(run_min, vmin(a, b))
HALFLIT_TERNARY(run_max, vmax(a, b))
HALFLIT_TERNARY(run_min_of_integers, from_bits(vmin(bits(a), bits(b))))
HALFLIT_TERNARY(run_max_of_integers, from_bits(vmax(bits(a), bits(b))))
HALFLIT_TERNARY(run_divide, vdiv(a, b))
HALFLIT_TERNARY(run_mad, mad(a, b, c))
HALFLIT_TERNARY(run_clamp, clamp(a, b, c))
HALFLIT_TERNARY(run_select, sel(a < b, b, c))
HALFLIT_TERNARY(run_select_equal, sel(a == b, a, c))
HALFLIT_TERNARY(run_integers, from_bits(sel(less(bits(a), bits(b)), bits(b) ^ bits(c), bits(a) & bits(c))))

static void power(const float* t, float n, float* out, int count) {
    const SplitPower split(n);
    for (int i = 0; i < count; i += kWidth) store(out + i, power_of_unit(load(t + i), split.minus_one, split.high, split.low));
}
static void cosine_power(const float* cosine_squared, const float* sine_squared, const float* half_exponent, float* out, int count) {
    for (int i = 0; i < count; i += kWidth)
        store(out + i, power_of_cosine(shading::PowTier::exact, load(cosine_squared + i), load(sine_squared + i), load(half_exponent + i)));
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
    {"sqrt", run_sqrt},
    {"reciprocal", run_reciprocal},
    {"reciprocal of sqrt", run_reciprocal_sqrt},
    {"x sqrt(x)", run_times_sqrt},
    {"abs", run_abs},
    {"negate", run_negate},
    {"round", run_round},
    {"floor", run_floor},
    {"round to int", run_round_to_int},
    {"round even", run_round_even},
    {"int to float", run_int_to_float},
    {"shift", run_shift},
    {"double", run_double},
    {"int to double", run_int_to_double},
    {"records of four", run_records},
    {"pairs, triples and quadruples", run_packed},
    {"is nan", run_nan},
    {"log2 of degree 5", run_log2_degree5},
    {"log2 of degree 7", run_log2_degree7},
    {"log2", run_log2},
    {"exp2 of degree 4", run_exp2_degree4},
    {"exp2 of degree 5", run_exp2_degree5},
    {"exp2", run_exp2},
    {"power 0.5", run_power_05},
    {"power 1.3", run_power_13},
    {"power 16.5", run_power_165},
    {"power 1000", run_power_1000},
    {"display power 1.3", run_display_power_13},
    {"display power 16.5", run_display_power_165},
    {"fast power 1.3", run_fast_power_13},
    {"fast power 16.5", run_fast_power_165},
    {"sharp power 100", run_sharp_power_100},
    {"sharp power 10000", run_sharp_power_10000},
    {"cosine power 2", run_cosine_power_1},
    {"cosine power 40", run_cosine_power_20},
    {"cosine power 60000", run_cosine_power_30000},
    {"display cosine power 40", run_display_cosine_power_20},
    {"display cosine power 60000", run_display_cosine_power_30000},
    {"fast cosine power 40", run_fast_cosine_power_20},
    {"fast cosine power 60000", run_fast_cosine_power_30000},
    {"srgb curve", run_srgb_curve},
    {"srgb8", run_srgb8},
    {"unorm8", run_unorm8},
};
static const testing::NamedTernary kTernary[] = {
    {"min", run_min},
    {"max", run_max},
    {"min of integers", run_min_of_integers},
    {"max of integers", run_max_of_integers},
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
const Elementary HALFLIT_ELEMENTARY = {kUnary,         static_cast<int>(sizeof(kUnary) / sizeof(kUnary[0])),
                                       kTernary,       static_cast<int>(sizeof(kTernary) / sizeof(kTernary[0])),
                                       power,          cosine_power,
                                       normalize_rows, mask_of_less,
                                       kWidth};
}  // namespace testing
}  // namespace halflit
