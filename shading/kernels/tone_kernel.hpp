// Tone curves: light after exposure to display light.
#pragma once

#include "shading/kernels/simd_records.hpp"
#include "shading/kernels/vector.hpp"
#include "shading/model/tone.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

HALFLIT_INLINE F constant(double x) { return F(static_cast<float>(x)); }

HALFLIT_INLINE V3 toned_reinhard(V3 c) {
    using namespace shading;
    const F luminance = mad(constant(kLumaBlue), c.z, mad(constant(kLumaGreen), c.y, constant(kLumaRed) * c.x));
    return c * vdiv(F(1.0f), F(1.0f) + luminance);
}

HALFLIT_INLINE F toned_aces(F x) {
    using namespace shading;
    const F numerator = x * mad(constant(kAcesA), x, constant(kAcesB));
    return vdiv(numerator, mad(x, mad(constant(kAcesC), x, constant(kAcesD)), constant(kAcesE)));
}

/// [PBRN]'s p, p_n and g with g p_n / p as `scale` and p_n (1 - g) as `lift`. 1 - g = K_d (p - p_n) g, without a difference.
HALFLIT_INLINE V3 toned_neutral(V3 c) {
    using namespace shading;
    constexpr double kRoom = 1.0 - kNeutralStart;
    const F least = vmin(vmin(c.x, c.y), c.z);
    const F curved = least - constant(1.0 / (4.0 * kNeutralF90)) * least * least;
    const F offset = sel(least < constant(2.0 * kNeutralF90), curved, constant(kNeutralF90));
    const V3 a{c.x - offset, c.y - offset, c.z - offset};
    const F highest = vmax(vmax(a.x, a.y), a.z);
    const F peak = vmax(highest, constant(kNeutralStart));
    const F new_peak = F(1.0f) - vdiv(constant(kRoom * kRoom), peak - constant(kNeutralStart - kRoom));
    const F desaturated = constant(kNeutralDesaturation) * (peak - new_peak);
    const F scale = vdiv(new_peak, peak * (F(1.0f) + desaturated)), lift = desaturated * peak * scale;
    const M kept = highest < constant(kNeutralStart);
    return {sel(kept, a.x, mad(a.x, scale, lift)), sel(kept, a.y, mad(a.y, scale, lift)), sel(kept, a.z, mad(a.z, scale, lift))};
}

template <ToneCurve kCurve>
HALFLIT_INLINE V3 toned(V3 c) {
    if constexpr (kCurve == ToneCurve::reinhard) return toned_reinhard(c);
    if constexpr (kCurve == ToneCurve::aces) return {toned_aces(c.x), toned_aces(c.y), toned_aces(c.z)};
    return toned_neutral(c);
}

template <ToneCurve kCurve>
static void tone_block(const float* const light[3], float exposure, float* const display[3], int count) {
    const F factor(exposure), none(0.0f), full(1.0f), most(shading::kMostTonedLight);
    for (int i = 0; i < count; i += kWidth) {
        const V3 out = toned<kCurve>({clamp(load(light[0] + i) * factor, none, most), clamp(load(light[1] + i) * factor, none, most),
                                      clamp(load(light[2] + i) * factor, none, most)});
        store(display[0] + i, vmin(out.x, full));
        store(display[1] + i, vmin(out.y, full));
        store(display[2] + i, vmin(out.z, full));
    }
}

/// See ShadeKernels::tone_samples.
template <ToneCurve kCurve>
static int toned_sums(const shading::SampleRows& in, int count, float* const sums[4]) {
    const F none(0.0f), full(1.0f), most(shading::kMostTonedLight);
    const V3 back{F(in.background[0]), F(in.background[1]), F(in.background[2])};
    const F back_alpha(in.background[3]);
    int i = 0;
    for (; i + kWidth <= count; i += kWidth) {
        V3 sum{none, none, none};
        F alpha_sum = none;
        for (int s = 0; s < in.samples; ++s) {
            V3 light;
            F alpha;
            load4(in.color + s * in.color_stride + 4 * i, light.x, light.y, light.z, alpha);
            const F share = load(in.backing + s * in.backing_stride + i);
            const M opaque = (alpha == full) & (share == none);
            const M empty = ((share == full) & (alpha == back_alpha)) & ((light.x == back.x) & (light.y == back.y) & (light.z == back.z));
            if (!all(opaque | empty)) return i;
            V3 out = back;
            if (any(opaque)) {
                out = toned<kCurve>({clamp(light.x, none, most), clamp(light.y, none, most), clamp(light.z, none, most)});
                out = {sel(empty, back.x, vmin(out.x, full)), sel(empty, back.y, vmin(out.y, full)), sel(empty, back.z, vmin(out.z, full))};
            }
            sum = sum + out;
            alpha_sum = alpha_sum + alpha;
        }
        store(sums[0] + i, sum.x);
        store(sums[1] + i, sum.y);
        store(sums[2] + i, sum.z);
        store(sums[3] + i, alpha_sum);
    }
    return i;
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
