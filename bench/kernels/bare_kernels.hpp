// Inner functions of the shading kernels as kernels of their own, and the arithmetic peak to compare them with.
#pragma once

#include "shading/fragment_block.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/plan/plan.hpp"

namespace halflit::bench {

/// Input: unit vectors to the eye in the block's tangent rows, which these kernels do not need otherwise; normals of unit length.
struct BareKernels {
    /// Sums over the lights, without the surface. Diffuse light goes to the result's colour rows, highlights to the vertex colour's rows.
    void (*sum)(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::FragmentBlock& block);
    void (*sum_with_specular)(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::FragmentBlock& block);

    /// Environment 0 of the frame at the normals.
    void (*environment)(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::FragmentBlock& block);

    /// kPeakFlops multiplications and additions, in registers only, on every lane of the block.
    void (*peak)(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::FragmentBlock& block);
};

/// x = x a + b in kPeakSteps steps, with enough chains at once to hide latencies; then the sum of the chains.
inline constexpr int kPeakChains = 12, kPeakSteps = 32;
inline constexpr int kPeakFlops = 2 * kPeakChains * kPeakSteps + kPeakChains;

/// Half the exponent of the highlights, for roughness 0.4: 1 / alpha^2 - 1, alpha = 0.16.
inline constexpr float kHalfExponent = 1.0f / (0.16f * 0.16f) - 1.0f;

}  // namespace halflit::bench
