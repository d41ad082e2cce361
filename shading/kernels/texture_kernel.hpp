// Texture sampling. Lanes compute level, texel addresses and weights side by side. Then each lane fetches its texels as records of four
// channels, and the vertical lerp takes two records at a time. A transpose turns the records into channel rows again.
//
// A texel's centre is at (i + 0.5) / size. Taps are combined by lerps a + w (b - a), first down, then right, then between levels. Weight 0
// gives exactly a, so leaving out taps whose weights are zero for all lanes changes nothing.
#pragma once

#include "shading/fragment_block.hpp"
#include "shading/kernels/pow.hpp"
#include "shading/plan/plan.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Coordinates are clamped to +-this. It is an even integer, so that repeat and mirror read it as 0. NaN becomes the lower limit, which
/// every wrap mode reads as 0.
inline constexpr float kCoordinateLimit = 1048576.0f;  // 2^20

/// Four channels, R G B A, in [0, 1].
struct Sample {
    F r, g, b, a;
};

/// Bilinear taps of one level: texel indices of the four corners, and the weights of the right and the lower ones.
struct LevelTaps {
    alignas(64) std::int32_t index[4][kWidth];  // upper left, upper right, lower left, lower right
    alignas(64) float right[kWidth], down[kWidth];
};

/// Filter of the lanes within a level; with `mixed` a mask decides.
enum class TapMode { linear, nearest, mixed };

/// Brings a coordinate into [0, 1], repeat: into [0, 1).
HALFLIT_INLINE F wrap_unit(F u, TextureWrap mode) {
    const F held = clamp(u, F(-kCoordinateLimit), F(kCoordinateLimit));
    switch (mode) {
        case TextureWrap::repeat:
            // Just below a whole number the difference rounds to 1. It is kept below 1, so that the last texel is read.
            return vmin(held - vfloor(held), F(0.99999994f));
        case TextureWrap::mirror: {
            const F period = held - F(2.0f) * vfloor(held * F(0.5f));
            return vmin(period, F(2.0f) - period);
        }
        case TextureWrap::clamp:
            break;
    }
    return clamp(held, F(0.0f), F(1.0f));
}

/// Brings a texel index from [-1, size] into [0, size). Repeat wraps around; mirror and clamp repeat the texel at the edge.
HALFLIT_INLINE I wrap_index(I i, I size, TextureWrap mode) {
    const I last = size - I(1);
    const M below = less(i, I(0)), above = less(last, i);
    if (mode == TextureWrap::repeat) return sel(below, i + size, sel(above, i - size, i));
    return sel(below, I(0), sel(above, last, i));
}

struct AxisTaps {
    I first, second;
    F weight;  ///< weight of `second`
};
HALFLIT_INLINE AxisTaps axis_taps(F unit, I size, TextureWrap mode, TapMode taps, M nearest) {
    const F x = unit * to_float(size);
    if (taps == TapMode::nearest) {
        const I i = wrap_index(round_to_int(vfloor(x)), size, mode);
        return {i, i, F(0.0f)};
    }
    const F centred = x - F(0.5f);
    F low = vfloor(centred);
    F weight = centred - low;
    if (taps == TapMode::mixed) {
        low = sel(nearest, vfloor(x), low);
        weight = sel(nearest, F(0.0f), weight);
    }
    const I first = round_to_int(low);
    return {wrap_index(first, size, mode), wrap_index(first + I(1), size, mode), weight};
}

HALFLIT_INLINE void level_taps(const shading::TexturePlan& texture, F unit_u, F unit_v, I width, I height, I offset, TapMode taps,
                               M nearest, LevelTaps& out) {
    const AxisTaps x = axis_taps(unit_u, width, texture.wrap_u, taps, nearest);
    const AxisTaps y = axis_taps(unit_v, height, texture.wrap_v, taps, nearest);
    const I upper = offset + y.first * width;
    store(out.index[0], upper + x.first);
    if (taps == TapMode::nearest) return;
    const I lower = offset + y.second * width;
    store(out.index[1], upper + x.second);
    store(out.index[2], lower + x.first);
    store(out.index[3], lower + x.second);
    store(out.right, x.weight);
    store(out.down, y.weight);
}

HALFLIT_INLINE const std::uint16_t* texel(const std::uint16_t* data, std::int32_t index) {
    return data + 4 * static_cast<std::int64_t>(index);
}

template <bool kLinear>
HALFLIT_INLINE Q fetch(const std::uint16_t* data, const LevelTaps& taps, int lane) {
    if constexpr (!kLinear) {
        return q_load_u16(texel(data, taps.index[0][lane]));
    } else {
        const QQ upper = qq_load_u16(texel(data, taps.index[0][lane]), texel(data, taps.index[1][lane]));
        const QQ lower = qq_load_u16(texel(data, taps.index[2][lane]), texel(data, taps.index[3][lane]));
        const QQ column = qq_lerp(upper, lower, taps.down[lane]);
        return q_lerp(qq_low(column), qq_high(column), q_set(taps.right[lane]));
    }
}

/// One lane's record from one level, or from two and `blend` between them.
template <bool kLinear, bool kTwoLevels>
HALFLIT_INLINE Q fetch_levels(const std::uint16_t* data, const LevelTaps& near, const LevelTaps& far, const float* blend, int lane) {
    const Q a = fetch<kLinear>(data, near, lane);
    if constexpr (!kTwoLevels)
        return a;
    else
        return q_lerp(a, fetch<kLinear>(data, far, lane), q_set(blend[lane]));
}

template <bool kLinear, bool kTwoLevels>
HALFLIT_INLINE Sample gather_sample(const std::uint16_t* data, const LevelTaps& near, const LevelTaps& far, const float* blend) {
    alignas(64) float rows[4][kWidth < 4 ? 4 : kWidth];
    if constexpr (kWidth == 1) {
        const Q q = fetch_levels<kLinear, kTwoLevels>(data, near, far, blend, 0);
        alignas(16) float record[4];
        q_store(record, q);
        for (int c = 0; c < 4; ++c) rows[c][0] = record[c];
    } else {
        for (int lane = 0; lane < kWidth; lane += 4) {
            Q r = fetch_levels<kLinear, kTwoLevels>(data, near, far, blend, lane);
            Q g = fetch_levels<kLinear, kTwoLevels>(data, near, far, blend, lane + 1);
            Q b = fetch_levels<kLinear, kTwoLevels>(data, near, far, blend, lane + 2);
            Q a = fetch_levels<kLinear, kTwoLevels>(data, near, far, blend, lane + 3);
            q_transpose(r, g, b, a);
            q_store(rows[0] + lane, r);
            q_store(rows[1] + lane, g);
            q_store(rows[2] + lane, b);
            q_store(rows[3] + lane, a);
        }
    }
    const F unit(1.0f / 65535.0f);
    return {load(rows[0]) * unit, load(rows[1]) * unit, load(rows[2]) * unit, load(rows[3]) * unit};
}

/// log2 of the larger of the two lengths, in texels of level 0, that a step of one pixel right or down covers. 0 or less: magnified.
HALFLIT_INLINE F level_of_detail(const shading::TexturePlan& texture, const shading::FragmentBlock& block, int lane) {
    const int first = texture.uv_set == 1 ? shading::kDu1Dx : shading::kDu0Dx;
    F du_dx = load(&block.lane[first][lane]), dv_dx = load(&block.lane[first + 1][lane]);
    F du_dy = load(&block.lane[first + 2][lane]), dv_dy = load(&block.lane[first + 3][lane]);
    if (texture.transform) {
        const F uu(texture.row_u[0]), uv(texture.row_u[1]), vu(texture.row_v[0]), vv(texture.row_v[1]);
        const F du_dx_in = du_dx, du_dy_in = du_dy;
        du_dx = mad(uu, du_dx_in, uv * dv_dx);
        dv_dx = mad(vu, du_dx_in, vv * dv_dx);
        du_dy = mad(uu, du_dy_in, uv * dv_dy);
        dv_dy = mad(vu, du_dy_in, vv * dv_dy);
    }
    const F width(static_cast<float>(texture.width[0])), height(static_cast<float>(texture.height[0]));
    const F ux = du_dx * width, vx = dv_dx * height, uy = du_dy * width, vy = dv_dy * height;
    const F right = mad(ux, ux, vx * vx), down = mad(uy, uy, vy * vy);
    // Clamped below infinity; NaN counts as no footprint.
    const F squared = clamp(vmax(right, down), F(0.0f), F(1e30f));
    const Log2 log = log2_parts(kLog2Degree5, squared);
    return F(0.5f) * (log.exponent + log.fraction);
}

/// All lanes read level 0.
template <bool kLinear>
HALFLIT_INLINE Sample sample_level0(const shading::TexturePlan& texture, F unit_u, F unit_v, TapMode taps, M nearest) {
    LevelTaps at;
    level_taps(texture, unit_u, unit_v, I(texture.width[0]), I(texture.height[0]), I(texture.offset[0]), taps, nearest, at);
    return gather_sample<kLinear, false>(texture.data, at, at, nullptr);
}

template <bool kLinear>
HALFLIT_INLINE Sample sample_levels(const shading::TexturePlan& texture, F unit_u, F unit_v, F lod, TapMode taps, M nearest) {
    const std::int32_t last = texture.level_count - 1;
    const F held = clamp(lod, F(0.0f), F(static_cast<float>(last)));
    const F low = texture.mip == MipFilter::nearest ? round_near(held) : vfloor(held);
    const F weight = texture.mip == MipFilter::nearest ? F(0.0f) : held - low;
    const I level = round_to_int(low);
    LevelTaps near;
    level_taps(texture, unit_u, unit_v, gather(texture.width, level), gather(texture.height, level), gather(texture.offset, level), taps,
               nearest, near);
    if (all(weight == F(0.0f))) return gather_sample<kLinear, false>(texture.data, near, near, nullptr);
    const I next = level + sel(less(level, I(last)), I(1), I(0));
    LevelTaps far;
    level_taps(texture, unit_u, unit_v, gather(texture.width, next), gather(texture.height, next), gather(texture.offset, next), taps,
               nearest, far);
    alignas(64) float blend[kWidth];
    store(blend, weight);
    return gather_sample<kLinear, true>(texture.data, near, far, blend);
}

/// Not inlined: five textures times the paths below would not fit the instruction cache, and a call per vector of lanes is cheap.
[[gnu::noinline]] static Sample sample_texture(const shading::TexturePlan& texture, const shading::FragmentBlock& block, int lane) {
    F u = load(&block.lane[texture.uv_set == 1 ? shading::kU1 : shading::kU0][lane]);
    F v = load(&block.lane[texture.uv_set == 1 ? shading::kV1 : shading::kV0][lane]);
    if (texture.transform) {
        const F u_in = u;
        u = mad(F(texture.row_u[0]), u_in, F(texture.row_u[1]) * v) + F(texture.row_u[2]);
        v = mad(F(texture.row_v[0]), u_in, F(texture.row_v[1]) * v) + F(texture.row_v[2]);
    }
    const F unit_u = wrap_unit(u, texture.wrap_u), unit_v = wrap_unit(v, texture.wrap_v);
    const M never = F(1.0f) < F(0.0f);
    const bool levels = texture.needs_lod && texture.mip != MipFilter::none && texture.level_count > 1;
    const F lod = texture.needs_lod ? level_of_detail(texture, block, lane) : F(0.0f);
    if (texture.mag == texture.min) {
        if (texture.mag == TextureFilter::nearest) {
            if (levels) return sample_levels<false>(texture, unit_u, unit_v, lod, TapMode::nearest, never);
            return sample_level0<false>(texture, unit_u, unit_v, TapMode::nearest, never);
        }
        // If all lanes are magnified they read level 0 alone, which gives the same bits as a blend of 0.
        if (levels && any(lod > F(0.0f))) return sample_levels<true>(texture, unit_u, unit_v, lod, TapMode::linear, never);
        return sample_level0<true>(texture, unit_u, unit_v, TapMode::linear, never);
    }
    const M magnified = lod <= F(0.0f);
    const M nearest = texture.mag == TextureFilter::nearest ? magnified : !magnified;
    if (levels) return sample_levels<true>(texture, unit_u, unit_v, lod, TapMode::mixed, nearest);
    return sample_level0<true>(texture, unit_u, unit_v, TapMode::mixed, nearest);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
