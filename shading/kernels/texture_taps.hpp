// Taps of a texture look-up: the texels that each lane reads, and their weights. Lanes are computed side by side.
//
// A texel's centre is at (i + 0.5) / size. Textures of a material that are read in the same way share their taps (TexturePlan::taps).
#pragma once

#include "shading/fragment_block.hpp"
#include "shading/kernels/pow.hpp"
#include "shading/plan/plan.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Coordinates are clamped to +-this. It is an even integer, so that repeat and mirror read it as 0. NaN becomes the lower limit, which
/// every wrap mode reads as 0.
inline constexpr float kCoordinateLimit = 1048576.0f;  // 2^20

/// Bilinear taps of one level: texel indices of the four corners, and the weights of the right and the lower ones.
struct LevelTaps {
    alignas(64) std::int32_t index[4][kWidth];  // upper left, upper right, lower left, lower right
    alignas(64) float right[kWidth], down[kWidth];
};

/// Taps of kWidth lanes, one place each.
struct PlaceTaps {
    bool linear;  ///< false: only the upper left corner of the one level is read
    bool two_levels;
    bool neighbours;  ///< in all lanes the right corners follow the left ones in memory
    LevelTaps near, far;
    alignas(64) float blend[kWidth];  ///< weight of the far level
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

/// Taps along one axis, before wrapping: `first` is in [-1, size]. The second is the next texel, or with the nearest filter the same.
struct AxisTaps {
    I first;
    F weight;  ///< weight of the second
};
HALFLIT_INLINE AxisTaps axis_taps(F unit, I size, TapMode mode, M nearest) {
    const F x = unit * to_float(size);
    if (mode == TapMode::nearest) return {round_to_int(vfloor(x)), F(0.0f)};
    const F centred = x - F(0.5f);
    F low = vfloor(centred);
    F weight = centred - low;
    if (mode == TapMode::mixed) {
        low = sel(nearest, vfloor(x), low);
        weight = sel(nearest, F(0.0f), weight);
    }
    return {round_to_int(low), weight};
}

/// Sizes and offsets of the levels that lanes read.
struct LevelShape {
    I width, height, offset;
};
HALFLIT_INLINE LevelShape one_level(const shading::TexturePlan& texture, std::int32_t level) {
    return {I(texture.width[level]), I(texture.height[level]), I(texture.offset[level])};
}
/// Mostly all lanes read one level, or two neighbouring ones: then nothing is gathered.
HALFLIT_INLINE LevelShape level_shape(const shading::TexturePlan& texture, I level) {
    const std::int32_t first = first_lane(level);
    if (all(equal(level, I(first)))) return one_level(texture, first);
    const std::int32_t low = any(less(level, I(first))) ? first - 1 : first;
    const M upper = equal(level, I(low + 1));
    if (!all(equal(level, I(low)) | upper))
        return {gather(texture.width, level), gather(texture.height, level), gather(texture.offset, level)};
    const LevelShape a = one_level(texture, low), b = one_level(texture, low + 1);
    return {sel(upper, b.width, a.width), sel(upper, b.height, a.height), sel(upper, b.offset, a.offset)};
}

/// Stores the taps of one level. True if in all lanes the right corners follow the left ones in memory.
HALFLIT_INLINE bool level_taps(const shading::TexturePlan& texture, F unit_u, F unit_v, const LevelShape& level, TapMode mode, M nearest,
                               LevelTaps& out) {
    const AxisTaps x = axis_taps(unit_u, level.width, mode, nearest), y = axis_taps(unit_v, level.height, mode, nearest);
    store(out.right, x.weight);
    store(out.down, y.weight);
    const I step(mode == TapMode::nearest ? 0 : 1), none(-1);
    I left = x.first, right = left + step, upper = y.first, lower = upper + step;
    const M inside = (less(none, left) & less(right, level.width)) & (less(none, upper) & less(lower, level.height));
    if (all(inside)) {
        const I at = level.offset + upper * level.width + left;
        store(out.index[0], at);
        store(out.index[1], at + step);
        store(out.index[2], at + level.width);
        store(out.index[3], at + level.width + step);
        return true;
    }
    left = wrap_index(left, level.width, texture.wrap_u), right = wrap_index(right, level.width, texture.wrap_u);
    const I above = level.offset + wrap_index(upper, level.height, texture.wrap_v) * level.width;
    const I below = level.offset + wrap_index(lower, level.height, texture.wrap_v) * level.width;
    store(out.index[0], above + left);
    store(out.index[1], above + right);
    store(out.index[2], below + left);
    store(out.index[3], below + right);
    return false;
}

/// Change of the texel coordinates at level 0 by a step of one pixel to the right and down.
struct TexelSteps {
    F ux, vx, uy, vy;
};
HALFLIT_INLINE TexelSteps texel_steps(const shading::TexturePlan& texture, const shading::FragmentBlock& block, int lane) {
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
    return {du_dx * width, dv_dx * height, du_dy * width, dv_dy * height};
}

/// log2 of a length, from its square: clamped below infinity; NaN counts as no length.
HALFLIT_INLINE F log2_of_length(F squared) {
    const Log2 log = log2_parts(kLog2Degree5, clamp(squared, F(0.0f), F(1e30f)));
    return F(0.5f) * (log.exponent + log.fraction);
}

/// log2 of the larger of the two lengths, in texels of level 0, that a step of one pixel right or down covers. 0 or less: magnified.
HALFLIT_INLINE F level_of_detail(const shading::TexturePlan& texture, const shading::FragmentBlock& block, int lane) {
    const TexelSteps step = texel_steps(texture, block, lane);
    const F right = mad(step.ux, step.ux, step.vx * step.vx), down = mad(step.uy, step.uy, step.vy * step.vy);
    return log2_of_length(vmax(right, down));
}

/// The levels that lanes read, and the weight of the second.
struct LevelPair {
    I near, far;
    F blend;
};
HALFLIT_INLINE LevelPair level_pair(const shading::TexturePlan& texture, F lod) {
    const std::int32_t last = texture.level_count - 1;
    const F held = clamp(lod, F(0.0f), F(static_cast<float>(last)));
    const bool nearest = texture.mip == MipFilter::nearest;
    const F low = nearest ? round_near(held) : vfloor(held);
    const I level = round_to_int(low);
    return {level, level + sel(less(level, I(last)), I(1), I(0)), nearest ? F(0.0f) : held - low};
}

/// A place in a texture, its transform applied.
struct TexelPlace {
    F u, v;
};
HALFLIT_INLINE TexelPlace texel_place(const shading::TexturePlan& texture, const shading::FragmentBlock& block, int lane) {
    const F u = load(&block.lane[texture.uv_set == 1 ? shading::kU1 : shading::kU0][lane]);
    const F v = load(&block.lane[texture.uv_set == 1 ? shading::kV1 : shading::kV0][lane]);
    if (!texture.transform) return {u, v};
    return {mad(F(texture.row_u[0]), u, F(texture.row_u[1]) * v) + F(texture.row_u[2]),
            mad(F(texture.row_v[0]), u, F(texture.row_v[1]) * v) + F(texture.row_v[2])};
}

/// Taps around a place, for footprints of 2^lod texels.
HALFLIT_INLINE void make_taps_at(const shading::TexturePlan& texture, TexelPlace at, F lod, PlaceTaps& out) {
    const F unit_u = wrap_unit(at.u, texture.wrap_u), unit_v = wrap_unit(at.v, texture.wrap_v);
    const bool one_filter = texture.mag == texture.min;
    out.linear = !(one_filter && texture.mag == TextureFilter::nearest);
    const TapMode mode = !one_filter ? TapMode::mixed : out.linear ? TapMode::linear : TapMode::nearest;
    const M magnified = lod <= F(0.0f);
    const M nearest = texture.mag == TextureFilter::nearest ? magnified : !magnified;
    // If all lanes are magnified they read level 0 alone, which gives the same bits as a blend of 0.
    const bool levels = texture.mip != MipFilter::none && texture.level_count > 1 && !all(magnified);
    const LevelPair pair = levels ? level_pair(texture, lod) : LevelPair{I(0), I(0), F(0.0f)};
    out.two_levels = !all(pair.blend == F(0.0f));
    out.neighbours = level_taps(texture, unit_u, unit_v, level_shape(texture, pair.near), mode, nearest, out.near) && out.linear;
    if (!out.two_levels) return;
    store(out.blend, pair.blend);
    out.neighbours = level_taps(texture, unit_u, unit_v, level_shape(texture, pair.far), mode, nearest, out.far) && out.neighbours;
}

/// Not inlined: a material has up to five textures.
[[gnu::noinline]] static void make_taps(const shading::TexturePlan& texture, const shading::FragmentBlock& block, int lane,
                                        PlaceTaps& out) {
    const TexelPlace at = texel_place(texture, block, lane);
    make_taps_at(texture, at, texture.needs_lod ? level_of_detail(texture, block, lane) : F(0.0f), out);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
