// Sky shadows: how much of the light of the surroundings reaches a surface, from shadow maps of a few directions all around, or from the
// grid of what hides it.
//
// The share that is hidden is a ratio of two sums over the directions: what the lobe receives from those that are hidden, and from all. So
// a surface from which nothing is hidden keeps its light bit for bit, and one that sees nothing is exactly black; the sums' own error of
// quadrature enters only where a part is hidden.
#pragma once

#include "shading/kernels/light_kernel.hpp"
#include "shading/kernels/sky_grid_kernel.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Shares of light that are seen, in [0, 1].
struct SkyVisibility {
    V3 diffuse;  ///< of the light through the lobe, channel by channel
    F mirrored;
};

HALFLIT_INLINE F seen_share(F hidden, F total) {
    const F share = vdiv(hidden, vmax(total, F(1e-30f)));
    return F(1.0f) - vmin(share, F(1.0f));
}

/// `reflection`: the mirrored view, unit; unused without highlights.
template <bool kSpecular>
HALFLIT_INLINE SkyVisibility sky_visibility(const ShadowReceiver& receiver, const shading::LobePlan& lobe, V3 normal, V3 reflection,
                                            F roughness) {
    if (const shading::SkyGridPlan& grid = receiver.frame.sky_grid; grid.hidden != nullptr) {
        const F seen = seen_in_grid(grid, grid_light(grid, receiver.position, receiver.surface_normal), normal);
        return {{seen, seen, seen}, seen};
    }
    const F none(0.0f);
    const bool split = receiver.frame.shadow_mode == ShadowMode::soft_split;
    const bool soft = split && receiver.fade.scale > 0.0f;
    const F focus = vmin(F(receiver.frame.sky_focus), F(1.0f) - F(shading::kSkyFocusByAlpha) * (roughness * roughness));
    V3 total{none, none, none}, hidden{none, none, none};
    F mirrored(0.0f), mirrored_hidden(0.0f);
    for (const shading::LightPlan& light : receiver.frame.sky) {
        const V3 direction = broadcast(light.to_light), color = broadcast(light.color);
        const F cosine = dot(normal, direction), value = lobe_value(lobe, cosine);
        total = total + color * value;
        M counts = value > none;
        F glance(0.0f);
        if constexpr (kSpecular) {
            const F beyond = vmax(dot(reflection, direction) - focus, none);
            glance = (beyond * beyond) * F(light.brightness);
            mirrored = mirrored + glance;
            counts = counts | (glance > none);
        }
        if (light.shadow_map < 0 || !any(counts)) continue;
        const HiddenShares share = hidden_share(receiver.frame.shadow_maps[light.shadow_map], receiver.position, receiver.surface_normal,
                                                direction, receiver.fade, soft);
        const F core = split ? vmin(value, vmax(cosine, none)) : value;
        hidden = hidden + color * (share.hard * core + share.soft * (value - core));
        if constexpr (kSpecular) mirrored_hidden = mirrored_hidden + share.hard * glance;
    }
    return {{seen_share(hidden.x, total.x), seen_share(hidden.y, total.y), seen_share(hidden.z, total.z)},
            kSpecular ? seen_share(mirrored_hidden, mirrored) : F(1.0f)};
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
