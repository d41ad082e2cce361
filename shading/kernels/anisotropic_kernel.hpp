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

/// Not inlined, as filter_texels.
[[gnu::noinline]] static Sample sample_anisotropic(const shading::TexturePlan& texture, const shading::FragmentBlock& block, int lane) {
    const TexelPlace middle = texel_place(texture, block, lane);
    const Ellipse ellipse = ellipse_of(texture, texel_steps(texture, block, lane));
    TexelTaps taps;
    const auto probe = [&](F along) __attribute__((always_inline)) {
        make_taps_at(texture, {mad(along, ellipse.du, middle.u), mad(along, ellipse.dv, middle.v)}, ellipse.lod, taps);
        return filter_texels(texture.data, taps);
    };
    Sample sum = probe(F(0.0f));
    const F none(0.0f), one(1.0f);
    if (!any(ellipse.ratio > one)) return sum;
    for (int i = 1; i <= shading::kMostAnisotropy / 2; ++i) {
        // Weight of the two probes i steps away. A lane without them adds 0.
        const F weight = clamp(F(0.5f) * (ellipse.ratio - F(static_cast<float>(2 * i - 1))), none, one);
        if (!any(weight > none)) break;
        const Sample before = probe(F(static_cast<float>(-i))), behind = probe(F(static_cast<float>(i)));
        sum.r = mad(weight, before.r + behind.r, sum.r);
        sum.g = mad(weight, before.g + behind.g, sum.g);
        sum.b = mad(weight, before.b + behind.b, sum.b);
        sum.a = mad(weight, before.a + behind.a, sum.a);
    }
    const F share = vdiv(one, ellipse.ratio);
    return {sum.r * share, sum.g * share, sum.b * share, sum.a * share};
}

/// A texture's value. `taps`: memory of this vector of lanes; a new one starts with key 0.
HALFLIT_INLINE Sample sample_texture(const shading::TexturePlan& texture, const shading::FragmentBlock& block, int lane, TexelTaps& taps) {
    if (texture.anisotropy > 1) return sample_anisotropic(texture, block, lane);
    if (taps.key != texture.taps) make_taps(texture, block, lane, taps);
    return filter_texels(texture.data, taps);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
