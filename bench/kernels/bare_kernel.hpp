// One source for all instruction sets, as in shading/kernels.
#pragma once

#include "bench/kernels/bare_kernels.hpp"
#include "shading/kernels/environment_kernel.hpp"
#include "shading/kernels/highlight_sums.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

HALFLIT_INLINE void store3(shading::FragmentBlock& block, int row, int lane, V3 v) {
    store(&block.lane[row][lane], v.x);
    store(&block.lane[row + 1][lane], v.y);
    store(&block.lane[row + 2][lane], v.z);
}

HALFLIT_INLINE void store_color(shading::FragmentBlock& block, int lane, V3 v) {
    store(block.red + lane, v.x);
    store(block.green + lane, v.y);
    store(block.blue + lane, v.z);
}

template <bool kHighlight>
static void bare_sum(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::FragmentBlock& block) {
    const int count = static_cast<int>(frame.lights.size());
    for (int lane = 0; lane < shading::kBlockSize; lane += kWidth) {
        const V3 normal = row3(block, shading::kNormalX, lane);
        V3 to_eye = normal;
        if constexpr (kHighlight) to_eye = row3(block, shading::kTangentX, lane);
        const V3 position = row3(block, shading::kPosX, lane);
        const ShadowReceiver receiver{frame, position, normal, {}};
        const SpecularShape shape{frame.specular, material.specular_tier, 0.0f, material.specular_curve, F(bench::kHalfExponent), F(1.0f)};
        const LightSums sums = sum_lights<kHighlight>(frame.lights.data(), count, material.lobe, receiver, position, normal, to_eye, shape);
        store_color(block, lane, sums.diffuse);
        if constexpr (kHighlight) store3(block, shading::kColorR, lane, sums.specular);
    }
}

static void bare_environment(const shading::ShadingPlan& frame, const shading::MaterialPlan&, shading::FragmentBlock& block) {
    for (int lane = 0; lane < shading::kBlockSize; lane += kWidth)
        store_color(block, lane, environment_light(frame.environments.front(), row3(block, shading::kNormalX, lane)));
}

static void bare_peak(const shading::ShadingPlan&, const shading::MaterialPlan&, shading::FragmentBlock& block) {
    const F factor = load(&block.lane[shading::kPosX][0]), term = load(&block.lane[shading::kPosY][0]);
    for (int lane = 0; lane < shading::kBlockSize; lane += kWidth) {
        F chain[bench::kPeakChains];
#pragma GCC unroll 16
        for (int i = 0; i < bench::kPeakChains; ++i) chain[i] = load(&block.lane[i][lane]);
        for (int step = 0; step < bench::kPeakSteps; ++step) {
#pragma GCC unroll 16
            for (int i = 0; i < bench::kPeakChains; ++i) chain[i] = mad(chain[i], factor, term);
        }
        F sum(0.0f);
#pragma GCC unroll 16
        for (int i = 0; i < bench::kPeakChains; ++i) sum = sum + chain[i];
        store(block.red + lane, sum);
    }
}

}  // namespace HALFLIT_ISA_NAMESPACE

namespace bench {
#define HALFLIT_BARE_KERNELS HALFLIT_CONCAT(bare_kernels_, HALFLIT_ISA)
extern const BareKernels HALFLIT_BARE_KERNELS;
const BareKernels HALFLIT_BARE_KERNELS = {bare_sum<false>, bare_sum<true>, bare_environment, bare_peak};
}  // namespace bench
}  // namespace halflit
