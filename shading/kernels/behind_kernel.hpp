// The light that is seen through glass that blurs or bends light: surfaces in the picture behind it, and the surroundings where there are
// none.
#pragma once

#include "shading/kernels/environment_kernel.hpp"
#include "shading/kernels/reflection_kernel.hpp"
#include "shading/kernels/shade_rows.hpp"
#include "shading/model/constants.hpp"
#include "shading/plan/plan.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Weights of a quadratic B-spline for three texels, the middle one at floor(at).
struct Spline {
    F before, here, after;
};
HALFLIT_INLINE Spline spline(F inside) {
    const F half(0.5f), rest = F(1.0f) - inside, off = inside - half;
    return {(rest * rest) * half, F(0.75f) - off * off, (inside * inside) * half};
}

/// Nine texels of a level about a pixel's coordinates, for each lane: the first as a number of texels, and weights.
struct BehindTaps {
    alignas(64) std::int32_t first[kWidth], below[kWidth];
    alignas(64) float across[3][kWidth], down[3][kWidth];
};
HALFLIT_INLINE void behind_taps(const shading::BehindPlan& behind, F x_px, F y_px, I level, BehindTaps& out) {
    const F scale = gather(behind.scale, level), one(1.0f), none(0.0f);
    const F x = x_px * scale, y = y_px * scale;
    const F column = clamp(vfloor(x), none, gather(behind.columns, level) - one);
    const F row = clamp(vfloor(y), none, gather(behind.rows, level) - one);
    const Spline across = spline(clamp(x - column, none, one)), down = spline(clamp(y - row, none, one));
    const I below = gather(behind.below, level);
    store(out.first, gather(behind.first, level) + round_to_int(row) * below + round_to_int(column));
    store(out.below, below);
    store(out.across[0], across.before), store(out.across[1], across.here), store(out.across[2], across.after);
    store(out.down[0], down.before), store(out.down[1], down.here), store(out.down[2], down.after);
}
HALFLIT_INLINE Q behind_value(const float* rgba, const BehindTaps& taps, int lane) {
    const std::int64_t first = taps.first[lane], below = taps.below[lane];
    const Q left = q_set(taps.across[0][lane]), middle = q_set(taps.across[1][lane]), right = q_set(taps.across[2][lane]);
    const auto row = [&](std::int64_t at) __attribute__((always_inline)) {
        const float* const p = rgba + 4 * at;
        return q_mad(q_load(p + 8), right, q_mad(q_load(p + 4), middle, q_mul(q_load(p), left)));
    };
    const Q upper = q_mul(row(first), q_set(taps.down[0][lane]));
    return q_mad(row(first + 2 * below), q_set(taps.down[2][lane]), q_mad(row(first + below), q_set(taps.down[1][lane]), upper));
}

/// Light times coverage, and coverage, about a pixel's coordinates, blurred as a level in [0, levels - 1] is.
struct Behind {
    V3 light;
    F coverage;
};
[[gnu::noinline]] static Behind seen_behind(const shading::BehindPlan& behind, F x_px, F y_px, F level) {
    const F low = clamp(vfloor(level), F(0.0f), vmax(to_float(I(behind.levels - 2)), F(0.0f)));
    const I fine_level = round_to_int(low), coarse_level = vmin(fine_level + I(1), I(behind.levels - 1));
    alignas(64) float between[kWidth];
    store(between, level - low);
    BehindTaps fine, coarse;
    behind_taps(behind, x_px, y_px, fine_level, fine);
    behind_taps(behind, x_px, y_px, coarse_level, coarse);
    Q records[kWidth];
    for (int l = 0; l < kWidth; ++l)
        records[l] = q_lerp(behind_value(behind.rgba, fine, l), behind_value(behind.rgba, coarse, l), q_set(between[l]));
    Behind out;
    lanes_of_records(records, out.light.x, out.light.y, out.light.z, out.coverage);
    return out;
}

/// The view through glass: light from behind, and the share of the light behind the pixel itself that is seen too.
struct LookedThrough {
    V3 light;
    F clear;
};
/// By 1 / index of refraction. Where the thickness is 0, the ray leaves where it entered, unbent.
[[gnu::noinline]] static LookedThrough look_through(const shading::ShadingPlan& frame, const shading::MaterialPlan& material,
                                                    const ShadeRows& rows, const shading::FragmentBlock& block, int lane,
                                                    float inverse_ior) {
    const shading::BehindPlan& behind = frame.behind;
    const F none(0.0f), one(1.0f), least(shading::kMinRoughness);
    const V3 normal = load3(rows.normal, lane), to_eye = load3(rows.to_eye, lane);
    const F roughness = load(rows.roughness + lane), thickness = load(rows.thickness + lane);
    const F blur = clamp((roughness - least) * F(1.0f / (1.0f - shading::kMinRoughness)), none, one) * F(material.transmission.blur);
    // Snell's law at the surface. A body is taken for a ball: the ray turns as much again where it leaves.
    const F ratio(inverse_ior), cosine = clamp(dot(normal, to_eye), none, one);
    const F inside = vsqrt(vmax(one - (ratio * ratio) * (one - cosine * cosine), none));
    const F turn = ratio * cosine - inside;
    V3 bent{mad(normal.x, turn, vneg(ratio * to_eye.x)), mad(normal.y, turn, vneg(ratio * to_eye.y)),
            mad(normal.z, turn, vneg(ratio * to_eye.z))};
    const M thick = thickness > none;
    bent = {sel(thick, bent.x, vneg(to_eye.x)), sel(thick, bent.y, vneg(to_eye.y)), sel(thick, bent.z, vneg(to_eye.z))};
    const F twice = vneg(dot(bent, to_eye) + dot(bent, to_eye));
    const V3 out_of{mad(twice, bent.x, to_eye.x), mad(twice, bent.y, to_eye.y), mad(twice, bent.z, to_eye.z)};

    const V3 exit = row3(block, shading::kPosX, lane) + bent * thickness;
    const auto along = [&](const float(&row)[4]) __attribute__((always_inline)) {
        return mad(exit.x, F(row[0]), mad(exit.y, F(row[1]), mad(exit.z, F(row[2]), F(row[3]))));
    };
    const F w = vmax(along(behind.w), F(1e-30f));
    const F x = clamp(vdiv(along(behind.x), w), none, F(behind.width)), y = clamp(vdiv(along(behind.y), w), none, F(behind.height));
    const Behind seen = seen_behind(behind, x, y, clamp(blur * F(behind.last_level), none, to_float(I(behind.levels - 1))));
    const F open = one - clamp(seen.coverage, none, one);
    const F share = sel(thick, one, vmin(blur * F(shading::kBehindFade), one));
    V3 around;
    if (has(material, kStageEnvironment)) {
        const F width = vmax(roughness * F(material.transmission.blur), least);
        around = blurred_radiance(frame.reflections, out_of.x, out_of.y, out_of.z, mirror_shape(width, one).level0);
    } else {
        around = hemisphere(frame.ambient, out_of.y);
    }
    return {seen.light + around * (open * share), open * (one - share)};
}

/// Where the body disperses light, each channel goes its own way.
HALFLIT_INLINE LookedThrough look_through(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, const ShadeRows& rows,
                                          const shading::FragmentBlock& block, int lane) {
    const float(&inverse_ior)[3] = material.transmission.inverse_ior;
    LookedThrough seen = look_through(frame, material, rows, block, lane, inverse_ior[1]);
    if (!material.transmission.disperses) return seen;
    seen.light.x = look_through(frame, material, rows, block, lane, inverse_ior[0]).light.x;
    seen.light.z = look_through(frame, material, rows, block, lane, inverse_ior[2]).light.z;
    return seen;
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
