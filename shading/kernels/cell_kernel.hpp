// Light in cells: which lights are fitted in a cell, and the sum of their expansions.
#pragma once

#include "shading/kernels/cell_expansion.hpp"
#include "shading/kernels/cell_extent.hpp"
#include "shading/kernels/cell_value.hpp"
#include "shading/kernels/shade_kernels.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// kFlat: all cells are flat, and terms with n are not needed.
template <bool kSpecular, bool kFlat>
HALFLIT_INLINE void fit_lanes(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::LightList lights,
                              shading::CellBatch& batch, std::uint16_t* exact, int lane) {
    const F none(0.0f), one(1.0f);
    const V3 normal{load(batch.normal[0] + lane), load(batch.normal[1] + lane), load(batch.normal[2] + lane)};
    const V3 position{load(batch.position[0] + lane), load(batch.position[1] + lane), load(batch.position[2] + lane)};
    const F nu = load(batch.normal_radius + lane), radius = load(batch.position_radius + lane);
    const shading::CellTolerance& tolerance = material.cells;
    const F relative(tolerance.relative), absolute(tolerance.absolute), exponent(2.0f * tolerance.half_exponent);
    const bool no_edge =
        material.lobe.wrap == 1.0f && (material.lobe.path == shading::LobePath::linear || material.lobe.path == shading::LobePath::square);
    const M cell_usable = nu < F(0.25f);
    CellEye eye{};
    if constexpr (kSpecular) eye = cell_eye(frame, position, radius);
    F error[3] = {none, none, none}, known[3] = {none, none, none}, dropped(0.0f);
    F term[shading::kCellTerms][3], highlight[shading::kCellTerms][3];
    for (int t = 0; t < shading::kCellTerms; ++t)
        for (int c = 0; c < 3; ++c) term[t][c] = highlight[t][c] = none;
    std::uint32_t shining = 0;

    for (int i = 0; i < lights.count; ++i) {
        const shading::LightPlan& light = lights.lights[i];
        if (light.shadow_map >= 0) {
            exact[i] = 0xffff;
            continue;
        }
        const CellArrival at = cell_arrival(light, position, radius);
        const F x = dot(normal, at.direction), move = nu + at.turn + F(1e-6f);
        const M known_turn = at.usable & cell_usable;  // elsewhere the turn has no meaning
        const M dark = at.outside | (known_turn & (x + move + F(1e-5f) <= F(-material.lobe.wrap)));
        if (all(dark)) continue;
        const M candidate = known_turn & !dark;
        const LobeSpan f = lobe_span(material.lobe, x, move);
        const M whole = no_edge ? one > none : f.whole;
        // Bounds along any line from the centre into the cell: on N.L, the lobe, the attenuation.
        const F turn = at.turn, turn2 = turn * turn, nu_turn = nu * turn, reach = at.share * (one + at.share);
        const Bounds cosine{clamp(x + move, none, one), nu + turn, F(2.0f) * nu_turn + F(1.5f) * turn2,
                            (F(4.5f) * nu_turn + F(3.75f) * turn2) * turn};
        const F c1 = cosine.d1, c1c1 = c1 * c1;
        const Bounds lobe{f.most, f.most1 * c1, f.most2 * c1c1 + f.most1 * cosine.d2,
                          f.most3 * (c1c1 * c1) + F(3.0f) * (f.most2 * (c1 * cosine.d2)) + f.most1 * cosine.d3};
        const Bounds attenuation{at.most, F(2.0f) * (turn * at.most + at.window * reach),
                                 F(6.0f) * (turn2 * at.most) + F(2.0f) * (at.window * at.share * at.share),
                                 F(24.0f) * (turn2 * turn * at.most)};
        // At the edge of the dark, the light is left out.
        F off = sel(whole, remainder(product(attenuation, lobe), F(4e-6f)) + F(kCosineError) * (at.most * f.most1), at.most * f.most);
        F shine(0.0f);
        HighlightSpan span{};
        M expanded = one < none;
        if constexpr (kSpecular) {
            span = highlight_span(frame, material, at, eye, normal, nu, attenuation, cosine, x - move);
            // A highlight that is weaker than the lobe's own error is not worth its expansion.
            expanded = (span.off < span.most) & ((F(tolerance.specular_ratio) * span.most > off) | (F(tolerance.specular_ratio) == none));
            shine = sel(expanded, span.off, span.most);
            off = off + F(tolerance.specular_ratio) * shine;
            shine = shine * F(light.brightness);
        }
        const F sure = sel(candidate, F(0.999f) * (at.least * f.least), none);
        M accept = candidate;
        if constexpr (kSpecular) accept = accept & (dropped + shine <= F(tolerance.absolute_specular));
        for (int c = 0; c < 3; ++c) {
            const F color(light.color[c]);
            known[c] = known[c] + sure * color;
            accept = accept & (error[c] + off * color <= relative * known[c] + absolute);
        }
        exact[i] = static_cast<std::uint16_t>(exact[i] | (mask_bits(!dark & !accept) << lane));
        if (!any(accept)) continue;
        for (int c = 0; c < 3; ++c) error[c] = error[c] + sel(accept, off * F(light.color[c]), none);
        const M fitted = accept & whole;
        if (any(fitted)) {
            CellArrival kept = at;
            kept.share = sel(fitted, at.share, none);
            kept.base = sel(fitted, at.base, none);  // may be infinite elsewhere
            kept.window = sel(fitted, at.window, none);
            const V3 to_light{sel(fitted, at.direction.x, none), sel(fitted, at.direction.y, none), sel(fitted, at.direction.z, none)};
            add_light<kFlat>(term,
                             expand_lobe<kFlat>(kept, to_light, normal, sel(fitted, x, none), sel(fitted, f.value, none),
                                                sel(fitted, f.slope, none), sel(fitted, f.bend, none)),
                             light.color);
        }
        if constexpr (kSpecular) {
            dropped = dropped + sel(accept, shine, none);
            const M shines = accept & expanded;
            if (!any(shines)) continue;
            shining |= mask_bits(shines);
            CellArrival kept = at;
            kept.share = sel(shines, at.share, none);
            kept.base = sel(shines, at.base, none);
            kept.window = sel(shines, at.window, none);
            CellEye kept_eye = eye;
            kept_eye.share = sel(shines, eye.share, none);
            HighlightSpan kept_span = span;
            kept_span.power = sel(shines, span.power, none);
            // Where nothing is expanded, H = N keeps the quotients finite.
            kept_span.half = {sel(shines, span.half.x, normal.x), sel(shines, span.half.y, normal.y), sel(shines, span.half.z, normal.z)};
            kept_span.squared = sel(shines, span.squared, one);
            const V3 to_light{sel(shines, at.direction.x, normal.x), sel(shines, at.direction.y, normal.y),
                              sel(shines, at.direction.z, normal.z)};
            add_light<kFlat>(highlight,
                             expand_highlight<kFlat>(kept, kept_eye, kept_span, to_light, normal, sel(shines, x, none), exponent),
                             light.color);
        }
    }
    batch.shining |= shining << lane;
    for (int t = 0; t < shading::kCellTerms; ++t)
        for (int c = 0; c < 3; ++c) {
            store(batch.term[t][c] + lane, term[t][c]);
            if constexpr (kSpecular) store(batch.highlight[t][c] + lane, highlight[t][c]);
        }
}

/// Fits the lights to each cell of the batch. exact[i], zero on entry: bit l is set if cell l leaves light i to its pixels.
static void fit_cells(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::LightList lights,
                      shading::CellBatch& batch, std::uint16_t* exact) {
    batch.shining = 0;
    for (int lane = 0; lane < batch.count; lane += kWidth) {
        const F radius = load(batch.normal_radius + lane);
        const bool flat = all((radius == F(0.0f)) | (radius == F(shading::kNoCell)));
        if (has(material, kStageSpecular))
            flat ? fit_lanes<true, true>(frame, material, lights, batch, exact, lane)
                 : fit_lanes<true, false>(frame, material, lights, batch, exact, lane);
        else
            flat ? fit_lanes<false, true>(frame, material, lights, batch, exact, lane)
                 : fit_lanes<false, false>(frame, material, lights, batch, exact, lane);
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
