// Anisotropic filtering: a pixel's footprint in the texture is an ellipse; several trilinear probes along its longer axis have the level of
// its shorter one.
//
// The map from pixels to texels has the singular values s1 >= s2, half the ellipse's axes. The ratio r = s1 / max(s2, 1), at most the
// setting, is the number of probes, and need not be whole: probes lie s1 / r apart, one in the middle; pairs at either side have the weight
// 1 as far as they fit into the length s1, and the outermost the rest. So nothing jumps where a probe is added. With r = 1 one probe is
// left.
#pragma once

#include "shading/kernels/texture_kernel.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

struct Ellipse {
    F ratio;   ///< r
    F lod;     ///< log2(s1 / r)
    F du, dv;  ///< from a probe to the next, as a share of the texture's sides
};
HALFLIT_INLINE Ellipse ellipse_of(const shading::TexturePlan& texture, const TexelSteps& given) {
    // Squares of squares of the steps must not overflow. NaN counts as no step.
    const auto held = [](F x) __attribute__((always_inline)) { return clamp(sel(x == x, x, F(0.0f)), F(-1e8f), F(1e8f)); };
    const F ux = held(given.ux), vx = held(given.vx), uy = held(given.uy), vy = held(given.vy), one(1.0f), tiny(1e-30f);
    // J J^T of the map J has the eigenvalues s1^2 and s2^2, whose product is the determinant's square.
    const F uu = mad(ux, ux, uy * uy), vv = mad(vx, vx, vy * vy), uv = mad(ux, vx, uy * vy);
    const F half = F(0.5f) * (uu - vv), root = vsqrt(mad(half, half, uv * uv));
    const F squared = mad(F(0.5f), uu + vv, root), s1 = vsqrt(squared);
    const F s2 = vdiv(vabs(ux * vy - uy * vx), vmax(s1, tiny));
    Ellipse out;
    out.ratio = clamp(vdiv(s1, vmax(s2, one)), one, F(static_cast<float>(texture.anisotropy)));
    const F between = vdiv(s1, out.ratio);
    out.lod = log2_of_length(between * between);
    const M wide = half > F(0.0f);
    const F x = sel(wide, half + root, uv), y = sel(wide, uv, root - half);
    const F step = vdiv(between, vmax(vsqrt(mad(x, x, y * y)), tiny));
    out.du = vdiv(x * step, F(static_cast<float>(texture.width[0])));
    out.dv = vdiv(y * step, F(static_cast<float>(texture.height[0])));
    return out;
}

/// Taps of the probes along footprints. A lane's missing probes have weight 0.
struct ProbeTaps {
    int pairs;                                   ///< probes at either side of the middle one, in the lane that has most
    bool plain;                                  ///< at all probes the right corners follow the left ones in memory, in all lanes
    PlaceTaps at[1 + shading::kMostAnisotropy];  ///< the middle; then a probe before it and one behind it for each pair
    alignas(64) float weight[shading::kMostAnisotropy / 2][kWidth];
    alignas(64) float ratio[kWidth];
};

/// Fetches the texels of one lane ahead, from two levels. All lanes are fetched before one is used: frames with large textures wait longer
/// for texels than they compute with them.
HALFLIT_INLINE void fetch_ahead(const std::uint16_t* data, const PlaceTaps& taps, int lane) {
    for (const LevelTaps* level : {&taps.near, &taps.far}) {
        const TexelRows rows = rows_of(data, *level, lane);
        prefetch(rows.upper);
        prefetch(rows.lower);
    }
}

/// Not inlined, as filter_texels.
[[gnu::noinline]] static void make_probes(const shading::TexturePlan& texture, const shading::FragmentBlock& block, int lane,
                                          ProbeTaps& out) {
    const TexelPlace middle = texel_place(texture, block, lane);
    const Ellipse ellipse = ellipse_of(texture, texel_steps(texture, block, lane));
    out.plain = true;
    const auto probe = [&](int number, F along) __attribute__((always_inline)) {
        const TexelPlace place{mad(along, ellipse.du, middle.u), mad(along, ellipse.dv, middle.v)};
        make_taps_at(texture, place, ellipse.lod, out.at[number]);
        out.plain = out.plain && out.at[number].neighbours;
    };
    store(out.ratio, ellipse.ratio);
    probe(0, F(0.0f));
    const F none(0.0f), one(1.0f);
    out.pairs = 0;
    while (out.pairs < shading::kMostAnisotropy / 2) {
        const int i = out.pairs + 1;
        const F weight = clamp(F(0.5f) * (ellipse.ratio - F(static_cast<float>(2 * i - 1))), none, one);
        if (!any(weight > none)) break;
        store(out.weight[out.pairs], weight);
        probe(2 * i - 1, F(static_cast<float>(-i)));
        probe(2 * i, F(static_cast<float>(i)));
        out.pairs = i;
    }
    if (!out.at[0].two_levels) return;  // magnified: many lanes read the same texels, which are in the caches
    for (int t = 0; t < texture.ahead_count; ++t)
        for (int l = 0; l < kWidth; ++l) {
            fetch_ahead(texture.ahead[t], out.at[0], l);
            for (int i = 0; i < out.pairs && out.weight[i][l] > 0.0f; ++i) {
                fetch_ahead(texture.ahead[t], out.at[2 * i + 1], l);
                fetch_ahead(texture.ahead[t], out.at[2 * i + 2], l);
            }
        }
}

/// The weighted sum of plain probes. Each lane ends with its own last probe, as the others would add 0.
template <bool kTwoLevels>
[[gnu::noinline]] static Sample sum_of_plain(const std::uint16_t* data, const ProbeTaps& probes) {
    const Q unit = q_set(kTexelUnit);
    return rows_of_lanes([&](int l) __attribute__((always_inline)) {
        const auto value = [&](const PlaceTaps& taps) __attribute__((always_inline)) {
            const TexelRows near = rows_of(data, taps.near, l);
            const TapWeights weights = weights_of(taps.near, l);
            if constexpr (!kTwoLevels) return q_mul(bilinear(near, weights), unit);
            return q_mul(trilinear(near, rows_of(data, taps.far, l), weights, weights_of(taps.far, l), taps.blend[l]), unit);
        };
        Q sum = value(probes.at[0]);
        for (int i = 0; i < probes.pairs && probes.weight[i][l] > 0.0f; ++i) {
            const Q before = value(probes.at[2 * i + 1]), behind = value(probes.at[2 * i + 2]);
            sum = q_mad(q_set(probes.weight[i][l]), q_add(before, behind), sum);
        }
        return sum;
    });
}

[[gnu::noinline]] static Sample sum_of_probes(const std::uint16_t* data, const ProbeTaps& probes) {
    Sample sum = filter_texels(data, probes.at[0]);
    for (int i = 0; i < probes.pairs; ++i) {
        const F weight = load(probes.weight[i]);
        const Sample before = filter_texels(data, probes.at[2 * i + 1]), behind = filter_texels(data, probes.at[2 * i + 2]);
        sum.r = mad(weight, before.r + behind.r, sum.r);
        sum.g = mad(weight, before.g + behind.g, sum.g);
        sum.b = mad(weight, before.b + behind.b, sum.b);
        sum.a = mad(weight, before.a + behind.a, sum.a);
    }
    return sum;
}

/// Taps of a vector of lanes, for the textures of a material that are read at the same places (TexturePlan::taps): one after the other,
/// they find what the last one made.
struct TexelTaps {
    std::int32_t place_of = 0, probes_of = 0;  ///< TexturePlan::taps; 0: not made yet
    PlaceTaps place;
    ProbeTaps probes;
};

/// A texture's value.
HALFLIT_INLINE Sample sample_texture(const shading::TexturePlan& texture, const shading::FragmentBlock& block, int lane, TexelTaps& taps) {
    if (texture.anisotropy > 1) {
        ProbeTaps& probes = taps.probes;
        if (taps.probes_of != texture.taps) make_probes(texture, block, lane, probes);
        taps.probes_of = texture.taps;
        const Sample sum = !probes.plain             ? sum_of_probes(texture.data, probes)
                           : probes.at[0].two_levels ? sum_of_plain<true>(texture.data, probes)
                                                     : sum_of_plain<false>(texture.data, probes);
        return probes.pairs == 0 ? sum : scaled(sum, vdiv(F(1.0f), load(probes.ratio)));
    }
    if (taps.place_of != texture.taps) make_taps(texture, block, lane, taps.place);
    taps.place_of = texture.taps;
    return filter_texels(texture.data, taps.place);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
