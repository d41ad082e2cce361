// KHR_materials_iridescence: interference in a thin film above the base (model/thin_film.hpp). These stages run only for materials that
// have one. What the film reflects at the view's angle becomes the F0 by which Schlick's curve gives as much there:
//
//     F0' = (I - (1 - N.V)^5) / (1 - (1 - N.V)^5), held to [0, 1];        I: the film's reflectance above a surface of F0
#pragma once

#include "shading/kernels/pow.hpp"
#include "shading/kernels/shade_rows.hpp"
#include "shading/kernels/surface_kernel.hpp"
#include "shading/model/formulas.hpp"
#include "shading/model/thin_film.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// The cosine of a number of full turns up to 2^20, within 2e-7 besides the rounding of the number itself.
HALFLIT_INLINE F cosine_of_turns(F turns) {
    constexpr float kSine[] = {6.283185005187988f, -41.34165573120117f, 81.60100555419922f, -76.5497817993164f, 39.536705017089844f};
    const F q = F(0.25f) - vabs(turns - round_near(turns));
    return q * horner(kSine, q * q);
}

/// F0 of a surface of this F0 below the film.
HALFLIT_INLINE F below_film(const ShadeRows& rows, int lane, F f0, int channel) {
    const F none(0.0f), one(1.0f), r0 = load(rows.film_r0 + lane), outer = load(rows.film_outer + lane);
    // Amplitudes add as velocities do: between air and the base, less between air and the film.
    const F air = vsqrt(clamp(f0, none, one)), amplitude = vdiv(air - r0, one - r0 * air), squared = amplitude * amplitude;
    const F inner = mad(one - squared, load(rows.film_grazing + lane), squared);
    const F loop = outer * inner, through = one - outer;
    const F sign = clamp(amplitude * F(shading::kFilmSignSlope), F(-1.0f), one);
    const F straight = vdiv((through * through) * inner, one - loop), wave = straight - through;
    const F once = vneg(sign) * vsqrt(loop) * load(rows.film_once[channel] + lane), twice = loop * load(rows.film_twice[channel] + lane);
    const F reflectance = (outer + straight) + (wave + wave) * (once + twice);
    const F schlick = load(rows.film_schlick + lane);
    const F held = clamp(vdiv(reflectance - schlick, one - schlick), none, one);
    return mad(load(rows.film_share + lane), held - f0, f0);
}
HALFLIT_INLINE V3 below_film(const ShadeRows& rows, int lane, V3 f0) {
    return {below_film(rows, lane, f0.x, 0), below_film(rows, lane, f0.y, 1), below_film(rows, lane, f0.z, 2)};
}

/// Sets the film's rows, and `dielectric` to F0 with the film.
[[gnu::noinline]] static void fetch_film(const shading::MaterialPlan& material, const shading::FragmentBlock& block, int count,
                                         ShadeRows& rows) {
    const shading::IridescencePlan& plan = material.iridescence;
    const F none(0.0f), one(1.0f), ior(plan.ior);
    const F r0 = vdiv(ior - one, ior + one), f0 = r0 * r0;
    for (int lane = 0; lane < count; lane += kWidth) {
        TexelTaps taps;
        F share(plan.factor), thickness(plan.thickness_nm);
        if (material.textures[TextureSlot::iridescence].data != nullptr)
            share = share * sample_texture(material.textures[TextureSlot::iridescence], block, lane, taps).r;
        if (material.textures[TextureSlot::iridescence_thickness].data != nullptr)
            thickness = mad(F(plan.thickness_range_nm),
                            sample_texture(material.textures[TextureSlot::iridescence_thickness], block, lane, taps).g, thickness);
        const F ramp = clamp(thickness * F(1.0f / shading::kThinFilmNm), none, one);
        const F cosine = clamp(dot(load3(rows.normal, lane), load3(rows.to_eye, lane)), F(shading::kLeastFilmCosine), one);
        const F inner = vsqrt(vmax(one - vdiv(one - cosine * cosine, ior * ior), none));
        const F schlick = fifth_power(one - cosine);
        const F way = vmin(((ior + ior) * thickness) * inner, F(shading::kMostFilmWay));
        V3 once{none, none, none}, twice = once;
        for (const shading::FilmWave& wave : shading::kFilmWaves) {
            const F fade = exp2_floored(kExp2Degree6, (way * way) * F(-wave.fade_per_nm2)), fade2 = fade * fade;
            const F cosine1 = cosine_of_turns(way * F(wave.waves_per_nm)), cosine2 = mad(cosine1 + cosine1, cosine1, F(-1.0f));
            const V3 rgb = broadcast(wave.rgb);
            once = once + rgb * (cosine1 * fade);
            twice = twice + rgb * (cosine2 * (fade2 * fade2));
        }
        store(rows.film_share + lane, share * ramp);
        store(rows.film_r0 + lane, r0);
        store(rows.film_outer + lane, mad(one - f0, schlick, f0));
        store(rows.film_grazing + lane, fifth_power(one - inner));
        store(rows.film_schlick + lane, schlick);
        store3(rows.film_once, lane, once);
        store3(rows.film_twice, lane, twice);
        store3(rows.dielectric, lane, below_film(rows, lane, load3(rows.dielectric, lane)));
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
