// The insides of the shading kernels, called on their own, and the arithmetic peak to compare them with.
#pragma once

#include "shading/fragment_block.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/plan/plan.hpp"

namespace halflit::bench {

/// Unit vectors to the eye lie in a block's tangent rows, which these calls do not use otherwise; normals are of unit length.
struct BareKernels {
    /// Sums over the lights, without the surface: diffuse light to the result's colour rows, highlights to the rows of the vertex colour.
    void (*sum)(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::FragmentBlock& block);
    void (*sum_with_specular)(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::FragmentBlock& block);

    /// Environment 0 of the frame at the normals.
    void (*environment)(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::FragmentBlock& block);

    /// kPeakFlops multiplications and additions in registers alone, on every lane of the block.
    void (*peak)(const shading::ShadingPlan& frame, const shading::MaterialPlan& material, shading::FragmentBlock& block);
};

/// x = x a + b in so many chains at once that latencies are hidden, and the sum of the chains.
inline constexpr int kPeakChains = 12, kPeakSteps = 32;
inline constexpr int kPeakFlops = 2 * kPeakChains * kPeakSteps + kPeakChains;

/// The exponent of the highlights, halved: roughness 0.4.
inline constexpr float kHalfExponent = 1.0f / (0.16f * 0.16f) - 1.0f;

}  // namespace halflit::bench
