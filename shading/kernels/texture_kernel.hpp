// Texture sampling. Each lane fetches its texels as records of four channels, filters them as records, and a transpose turns the
// records into channel rows.
//
// Taps are combined by lerps a + w (b - a), first down, then right, then between levels. Weight 0 gives exactly a, so leaving out taps
// whose weights are zero for all lanes changes nothing.
#pragma once

#include "shading/kernels/simd_texels.hpp"
#include "shading/kernels/texture_taps.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Four channels, R G B A, in [0, 1].
struct Sample {
    F r, g, b, a;
};

HALFLIT_INLINE const std::uint16_t* texel(const std::uint16_t* data, std::int32_t index) {
    return data + 4 * static_cast<std::int64_t>(index);
}

/// Four taps anywhere.
HALFLIT_INLINE Q scattered(const std::uint16_t* data, const LevelTaps& taps, int lane) {
    const QQ upper = qq_load_u16(texel(data, taps.index[0][lane]), texel(data, taps.index[1][lane]));
    const QQ lower = qq_load_u16(texel(data, taps.index[2][lane]), texel(data, taps.index[3][lane]));
    const QQ column = qq_lerp(upper, lower, taps.down[lane]);
    return q_lerp(qq_low(column), qq_high(column), q_set(taps.right[lane]));
}

HALFLIT_INLINE TexelRows rows_of(const std::uint16_t* data, const LevelTaps& taps, int lane) {
    return {texel(data, taps.index[0][lane]), texel(data, taps.index[2][lane])};
}
HALFLIT_INLINE TapWeights weights_of(const LevelTaps& taps, int lane) { return {taps.right[lane], taps.down[lane]}; }

/// fetch(lane) for all lanes, as rows.
template <class Fetch>
HALFLIT_INLINE Sample rows_of_lanes(const Fetch& fetch) {
    Q records[kWidth];
    for (int lane = 0; lane < kWidth; ++lane) records[lane] = fetch(lane);
    Sample sample;
    lanes_of_records(records, sample.r, sample.g, sample.b, sample.a);
    return sample;
}

/// Texels' values are multiples of this.
inline constexpr float kTexelUnit = 1.0f / 65535.0f;

HALFLIT_INLINE Sample scaled(const Sample& sample, F factor) {
    return {sample.r * factor, sample.g * factor, sample.b * factor, sample.a * factor};
}

template <class Fetch>
HALFLIT_INLINE Sample sample_lanes(const Fetch& fetch) {
    return scaled(rows_of_lanes(fetch), F(kTexelUnit));
}

/// Not inlined: five textures times the paths below would not fit the instruction cache, and a call per vector of lanes is cheap.
[[gnu::noinline]] static Sample filter_texels(const std::uint16_t* data, const PlaceTaps& taps) {
    const LevelTaps &near = taps.near, &far = taps.far;
    if (taps.neighbours) {
        if (taps.two_levels)
            return sample_lanes([&](int l) __attribute__((always_inline)) {
                return trilinear(rows_of(data, near, l), rows_of(data, far, l), weights_of(near, l), weights_of(far, l), taps.blend[l]);
            });
        return sample_lanes([&](int l) __attribute__((always_inline)) { return bilinear(rows_of(data, near, l), weights_of(near, l)); });
    }
    if (!taps.linear) {
        const auto first = [&](const LevelTaps& level, int l) __attribute__((always_inline)) {
            return q_load_u16(texel(data, level.index[0][l]));
        };
        if (!taps.two_levels) return sample_lanes([&](int l) __attribute__((always_inline)) { return first(near, l); });
        return sample_lanes([&](int l)
                                __attribute__((always_inline)) { return q_lerp(first(near, l), first(far, l), q_set(taps.blend[l])); });
    }
    if (taps.two_levels)
        return sample_lanes([&](int l) __attribute__((always_inline)) {
            return q_lerp(scattered(data, near, l), scattered(data, far, l), q_set(taps.blend[l]));
        });
    return sample_lanes([&](int l) __attribute__((always_inline)) { return scattered(data, near, l); });
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
