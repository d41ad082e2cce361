// Light in cells: where the fragments of a cell are.
#pragma once

#include "shading/kernels/shade_kernels.hpp"
#include "shading/kernels/surface_kernel.hpp"
#include "shading/light_cell.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

/// Writes centre and radii of a block's fragments as cell `cell` of the batch.
static void measure_cell(const shading::MaterialPlan& material, const shading::FragmentBlock& block, int count, shading::CellBatch& batch,
                         int cell) {
    const auto inputs = [&](int lane, F(&out)[6]) __attribute__((always_inline)) {
        TexelTaps taps;
        const V3 normal = normals(material, block, lane, taps).shading, position = row3(block, shading::kPosX, lane);
        out[0] = normal.x, out[1] = normal.y, out[2] = normal.z;
        out[3] = position.x, out[4] = position.y, out[5] = position.z;
    };
    F value[6], least[6], most[6];
    inputs(0, value);
    for (int i = 0; i < 6; ++i) least[i] = most[i] = value[i];
    for (int lane = kWidth; lane < count; lane += kWidth) {
        inputs(lane, value);
        for (int i = 0; i < 6; ++i) {
            least[i] = vmin(least[i], value[i]);
            most[i] = vmax(most[i], value[i]);
        }
    }
    float center[6];
    bool flat = true;
    for (int i = 0; i < 6; ++i) {
        float low[kWidth], high[kWidth];
        store(low, least[i]);
        store(high, most[i]);
        for (int l = 1; l < kWidth; ++l) {
            low[0] = vmin(low[0], low[l]);
            high[0] = vmax(high[0], high[l]);
        }
        center[i] = 0.5f * low[0] + 0.5f * high[0];
        if (i < 3) flat &= low[0] == high[0];
    }
    const float squared = (center[0] * center[0] + center[1] * center[1]) + center[2] * center[2];
    bool usable = squared > 0.25f;
    if (!flat) {
        const float inv = 1.0f / vsqrt(vmax(squared, 0.25f));
        for (int i = 0; i < 3; ++i) center[i] = center[i] * inv;
    }
    // The largest distances from the centre. Minima and maxima lose NaN, so it is looked for here.
    F normal_squared(0.0f), position_squared(0.0f);
    for (int lane = 0; lane < count; lane += kWidth) {
        inputs(lane, value);
        for (int i = 0; i < 6; ++i) value[i] = value[i] - F(center[i]);
        const F n = dot(V3{value[0], value[1], value[2]}, V3{value[0], value[1], value[2]});
        const F p = dot(V3{value[3], value[4], value[5]}, V3{value[3], value[4], value[5]});
        usable = usable && all((n < F(8.0f)) & (p < F(1e36f)));
        normal_squared = vmax(n, normal_squared);
        position_squared = vmax(p, position_squared);
    }
    float n[kWidth], p[kWidth];
    store(n, normal_squared);
    store(p, position_squared);
    for (int l = 1; l < kWidth; ++l) {
        n[0] = vmax(n[0], n[l]);
        p[0] = vmax(p[0], p[l]);
    }
    for (int i = 0; i < 3; ++i) {
        batch.normal[i][cell] = usable ? center[i] : i == 2 ? 1.0f : 0.0f;
        batch.position[i][cell] = usable ? center[i + 3] : 0.0f;
    }
    constexpr float kMargin = 1.00001f;
    batch.normal_radius[cell] = !usable ? shading::kNoCell : flat ? 0.0f : kMargin * vsqrt(n[0]) + 1e-6f;
    batch.position_radius[cell] = usable ? kMargin * vsqrt(p[0]) + 2e-19f : shading::kNoCell;  // squares below that are 0
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
