// The table of shading kernels: one set of function pointers per instruction set, all with the same results bit for bit.
#pragma once

#include "halflit/isa.hpp"
#include "shading/fragment_block.hpp"
#include "shading/light_cell.hpp"
#include "shading/plan/plan.hpp"

#include <cstddef>
#include <cstdint>

namespace halflit::shading {

/// Lights in list order: all of the frame's, or those of them that can be other than zero where a block lies.
struct LightList {
    const LightPlan* lights = nullptr;
    int count = 0;
    const LightCell* cell = nullptr;  ///< further light, fitted for the cell that the block is; may be null
};
[[nodiscard]] inline LightList all_lights(const ShadingPlan& frame) { return {frame.lights.data(), static_cast<int>(frame.lights.size())}; }

/// The samples of a row of pixels before a tone curve.
struct SampleRows {
    const float* color;           ///< light, alpha; sample s of pixel i is the four floats from color + s color_stride + 4 i on
    std::ptrdiff_t color_stride;  ///< floats
    const float* backing;         ///< share of the background colour; sample s of pixel i: backing[s backing_stride + i]
    std::ptrdiff_t backing_stride;
    int samples;
    float background[4];  ///< what an empty sample holds, which no curve changes
};

struct ShadeKernels {
    /// Runs the stages of `material` over lanes [0, count) of the block, and writes red, green, blue, alpha there.
    /// count in [1, kBlockSize]; lanes from count up to the next multiple of the SIMD width are read (they must hold
    /// finite copies of a real lane) and written. Needs rows of the plan's slots, kFacing when double sided, gradients, kShadowX..
    /// when the frame's shadows are looked up off the position.
    void (*shade)(const ShadingPlan& frame, const MaterialPlan& material, LightList lights, FragmentBlock& block, int count);

    /// Computes light alone, for shading rates below one a pixel: with base colour b the lit colour is b X + Y. X goes to the rows kPosX..
    /// kPosZ, Y to kNormalX..kNormalZ. `shade` reads them there when the material's plan has kStagePrelit.
    void (*light)(const ShadingPlan& frame, const MaterialPlan& material, LightList lights, FragmentBlock& block, int count);

    /// Shares of the core and of the excess (shadow_mode.hpp) that a light's shadow map hides, in [0, 1], for lanes [0, count).
    void (*hidden)(const ShadingPlan& frame, const MaterialPlan& material, const LightPlan& light, const FragmentBlock& block, int count,
                   float* core, float* excess);

    /// The terms of the light that ShadingPlan::sky_grid hides (plan/sky_grid_plan.hpp), for lanes [0, count).
    void (*hidden_sky)(const ShadingPlan& frame, const MaterialPlan& material, const FragmentBlock& block, int count,
                       float (&terms)[kGridTerms][kBlockSize]);

    /// Writes centre and radii of the block's first `count` fragments as cell `cell` of the batch. Needs what `shade` needs.
    void (*measure_cell)(const MaterialPlan& material, const FragmentBlock& block, int count, CellBatch& batch, int cell);

    /// Fits the lights to each cell of the batch. `exact` holds a zero for each light on entry; bit l is set if cell l leaves the light to
    /// its pixels. Lights that are neither fitted nor left to the pixels are dark in the cell. Entries of the batch from count up to
    /// kCellLanes must have the radius kNoCell.
    void (*fit_cells)(const ShadingPlan& frame, const MaterialPlan& material, LightList lights, CellBatch& batch, std::uint16_t* exact);

    /// Computes only the alpha channel that MASK compares and BLEND uses: base colour alpha * texture alpha * vertex alpha.
    void (*alpha)(const MaterialPlan& material, FragmentBlock& block, int count);

    /// Writes the base colour to red, green, blue and alpha, and the unit normal that light falls on to kNormalX.. Needs what `shade`
    /// needs.
    void (*surface)(const MaterialPlan& material, FragmentBlock& block, int count);

    /// Writes to `number` of each lane in [0, count) how many of the lights have it in their range and cone. Needs positions.
    void (*count_lights)(LightList lights, const FragmentBlock& block, int count, std::uint32_t* number);

    /// Applies a tone curve other than none to `count` colours, light (red, green, blue) times `exposure`. Writes display light in [0, 1].
    /// NaN counts as 0, infinity as white. All arrays are padded to a multiple of 16 lanes; `display` may be `light`.
    void (*tone)(ToneCurve curve, const float* const light[3], float exposure, float* const display[3], int count);

    /// Tones each sample of a row of pixels, and writes the sums over the samples of a pixel to sums[0..3]: red, green, blue, alpha. Goes
    /// on in whole vectors of pixels while each sample is opaque or empty. Returns the number of pixels done.
    int (*tone_samples)(ToneCurve curve, const SampleRows& in, int count, float* const sums[4]);

    /// Encodes `count` linear colours, times `exposure` and clamped to [0, 1], as 8-bit sRGB codes, packed R | G << 8 | B << 16 | A << 24.
    /// A is the linear alpha in 8 bits. All are rounded to nearest; NaN gives 0. All arrays are padded to a multiple of 16 lanes.
    void (*encode_srgb8)(const float* red, const float* green, const float* blue, const float* alpha, float exposure, std::uint32_t* rgba8,
                         int count);

    // Making of textures, four values a texel:
    /// The mean of 2 x 2 texels, rounded, for `width` texels of a smaller level.
    void (*halve_texels)(const std::uint16_t* upper, const std::uint16_t* lower, int width, std::uint16_t* to);
    /// Unit normals of `width` texels; +z of one without a direction.
    void (*unit_normals)(const std::uint16_t* texels, int width, double* x, double* y, double* z);
    /// The mean of 2 x 2 numbers, for `width` of a smaller level.
    void (*halve_means)(const double* upper, const double* lower, int width, double* to);
    /// What the lengths of means of normals have lost (texture_texels.hpp), 65535 for 1, to the first value of each texel from `to` on.
    void (*lost_lengths)(const double* x, const double* y, const double* z, int width, std::uint16_t* to);
};

[[nodiscard]] const ShadeKernels& shade_kernels(Isa isa);
/// Those of default_isa(), for what is made before a frame is drawn.
[[nodiscard]] inline const ShadeKernels& usual_kernels() { return shade_kernels(default_isa().value_or(Isa::scalar)); }

}  // namespace halflit::shading
