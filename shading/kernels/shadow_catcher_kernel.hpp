// A surface that is invisible but for the shadows on it.
#pragma once

#include "shading/kernels/environment_kernel.hpp"
#include "shading/kernels/light_kernel.hpp"
#include "shading/kernels/shade_rows.hpp"
#include "shading/model/tone.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Sets the block's colour to black, and its alpha to the share of the light, by luminance, that shadows hide. rows: the light that
/// arrives. Light that nothing hides keeps its bits, so its share is exactly 0. around(lane, normal): light of the surroundings.
template <class Around>
[[gnu::noinline]] static void catch_shadows(const shading::ShadingPlan& frame, const shading::MaterialPlan& material,
                                            shading::LightList lights, const ShadeRows& rows, shading::FragmentBlock& block, int count,
                                            const Around& around) {
    using namespace shading;
    const F none(0.0f), full(1.0f);
    const auto luminance = [](V3 c) __attribute__((always_inline)) {
        return mad(F(static_cast<float>(kLumaBlue)), c.z,
                   mad(F(static_cast<float>(kLumaGreen)), c.y, F(static_cast<float>(kLumaRed)) * c.x));
    };
    for (int lane = 0; lane < count; lane += kWidth) {
        const V3 position = row3(block, kPosX, lane), normal = load3(rows.normal, lane);
        V3 seen{none, none, none}, all = seen;
        if (has(material, kStageLights)) {
            seen = load3(rows.diffuse, lane);
            all = seen;
            if (!frame.shadow_maps.empty()) {
                const ShadowReceiver nowhere{frame, position, normal, {}};
                const auto value = [&](F x) __attribute__((always_inline)) { return lobe_value(material.lobe, x); };
                all = sum_lobes<false>(value, lights.lights, lights.count, nowhere, position, normal).diffuse * F(material.lobe.scale);
            }
        }
        if (has(material, kStageAmbient)) {
            seen = seen + load3(rows.ambient, lane);
            all = all + around(normal);
        }
        const F light = luminance(all), hidden = full - vdiv(luminance(seen), light);
        store(block.red + lane, none);
        store(block.green + lane, none);
        store(block.blue + lane, none);
        store(block.alpha + lane, sel(light > none, clamp(hidden, none, full), none) * clamp(load(rows.alpha + lane), none, full));
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
