// Distances of a shadow map from the depths of its view.
#pragma once

#include "raster/kernels/raster_kernels.hpp"
#include "shading/kernels/simd.hpp"
#include "shading/plan/shadow_map_plan.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

template <class V>
HALFLIT_INLINE V distance_of(const DepthRange& range, V z) {
    const V none(shading::kNoBlocker);
    V d = V(range.far_z) - z * V(range.far_z - range.near_z);
    if (range.perspective) d = vdiv(V(range.near_z), z);
    return sel((z > V(0.0f)) & (d < none), d, none);
}

inline void distances(const DepthRange& range, const float* depth, int count, float* distance) {
    int i = 0;
    for (; i + kWidth <= count; i += kWidth) store(distance + i, distance_of<F>(range, load(depth + i)));
    for (; i < count; ++i) distance[i] = distance_of<float>(range, depth[i]);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
