// Sums of lobes and highlights over all lights.
//
// With its highlight a light is one chain of more than a hundred operations, with two roots and three divisions, each of which waits for
// the one before; a processor looks ahead over two or three lights. So eight lights at a time go through the chain in stages, and each
// stage has eight short chains that do not depend on each other. The sums are added in list order.
#pragma once

#include "shading/kernels/light_kernel.hpp"
#include "shading/kernels/specular_kernel.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Lights between two stages, at kWidth fragments.
struct LightBatch {
    static constexpr int kSize = 8;
    using Rows = float[kSize][kWidth];
    alignas(64) Rows x, y, z;  ///< direction to the light
    alignas(64) Rows attenuation;
    alignas(64) Rows n_dot_l, lobe;                         ///< N.L, and f(N.L)
    alignas(64) Rows cosine_squared, sine_squared, height;  ///< SpecularArgument
    bool shines[kSize];
};

template <bool kShadows, class LobeValue, class Highlight>
HALFLIT_INLINE LightSums sum_highlights(const LobeValue& lobe_value_at, const Highlight& highlight, const shading::LightPlan* lights,
                                        int count, const ShadowReceiver& receiver, V3 position, V3 normal, V3 to_eye) {
    LightSums sums;
    LightBatch batch;
    for (; count > 0; lights += LightBatch::kSize, count -= LightBatch::kSize) {
        const int size = count < LightBatch::kSize ? count : LightBatch::kSize;
        for (int i = 0; i < size; ++i) {
            V3 direction = broadcast(lights[i].to_light);
            F attenuation(1.0f);
            if (lights[i].type != LightType::directional) local_light(lights[i], position, direction, attenuation);
            store(batch.x[i], direction.x);
            store(batch.y[i], direction.y);
            store(batch.z[i], direction.z);
            store(batch.attenuation[i], attenuation);
        }
        for (int i = 0; i < size; ++i) {
            const V3 direction{load(batch.x[i]), load(batch.y[i]), load(batch.z[i])};
            const F n_dot_l = dot(normal, direction), brightness = load(batch.attenuation[i]) * F(lights[i].brightness);
            store(batch.lobe[i], lobe_value_at(n_dot_l));
            if constexpr (kShadows) store(batch.n_dot_l[i], n_dot_l);
            SpecularArgument at{F(0.0f), F(0.0f), F(0.0f)};
            batch.shines[i] = highlight.argument(normal, to_eye, direction, n_dot_l, brightness, at);
            store(batch.cosine_squared[i], at.cosine_squared);
            if constexpr (Highlight::kNeedsSine) store(batch.sine_squared[i], at.sine_squared);
            store(batch.height[i], at.height);
        }
        for (int i = 0; i < size; ++i) {
            const V3 color = broadcast(lights[i].color);
            const F attenuation = load(batch.attenuation[i]);
            F diffuse = load(batch.lobe[i]), specular(0.0f);
            if constexpr (!kShadows) {
                sums.diffuse = sums.diffuse + color * (diffuse * attenuation);
                if (!batch.shines[i]) continue;
            }
            if (batch.shines[i]) {
                F sine_squared(0.0f);
                if constexpr (Highlight::kNeedsSine) sine_squared = load(batch.sine_squared[i]);
                specular = highlight.value(load(batch.cosine_squared[i]), sine_squared, load(batch.height[i]));
            }
            if constexpr (kShadows) {
                if (lights[i].shadow_map >= 0)
                    cast_shadow<true>(receiver, lights[i], {load(batch.x[i]), load(batch.y[i]), load(batch.z[i])}, attenuation,
                                      load(batch.n_dot_l[i]), diffuse, specular);
                sums.diffuse = sums.diffuse + color * (diffuse * attenuation);
            }
            sums.specular = sums.specular + color * (specular * attenuation);
        }
    }
    return sums;
}

template <bool kSpecular>
HALFLIT_INLINE LightSums sum_lights(const shading::LightPlan* lights, int count, const shading::LobePlan& lobe,
                                    const ShadowReceiver& receiver, V3 position, V3 normal, V3 to_eye, const SpecularShape& shape) {
    if constexpr (!kSpecular) return sum_lobes(lights, count, lobe, receiver, position, normal);
    const auto any_lobe = [&](F x) __attribute__((always_inline)) { return lobe_value(lobe, x); };
    const auto sum = [&]<bool kShadows>(const auto& highlight) __attribute__((always_inline)) {
        return sum_highlights<kShadows>(any_lobe, highlight, lights, count, receiver, position, normal, to_eye);
    };
    const bool shadows = !receiver.frame.shadow_maps.empty();
    if (shape.curve.squarings >= 0) {
        if (shadows) return sum.template operator()<true>(CurveHighlight{shape});
        return sum.template operator()<false>(CurveHighlight{shape});
    }
    if (shadows) return sum.template operator()<true>(PowerHighlight{shape});
    return sum.template operator()<false>(PowerHighlight{shape});
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
