// Vectors of lanes: reading rows of a block, and normalising without overflow.
#pragma once

#include "halflit/math.hpp"
#include "shading/fragment_block.hpp"
#include "shading/kernels/simd.hpp"

namespace halflit {
inline namespace HALFLIT_ISA_NAMESPACE {

using V3 = Vec3<F>;

HALFLIT_INLINE F row(const shading::FragmentBlock& block, int index, int lane) { return load(&block.lane[index][lane]); }

/// Three consecutive rows, from `index` on.
HALFLIT_INLINE V3 row3(const shading::FragmentBlock& block, int index, int lane) {
    return {row(block, index, lane), row(block, index + 1, lane), row(block, index + 2, lane)};
}

HALFLIT_INLINE V3 broadcast(const float (&v)[3]) { return {F(v[0]), F(v[1]), F(v[2])}; }
HALFLIT_INLINE V3 broadcast(Vec3f v) { return {F(v.x), F(v.y), F(v.z)}; }

/// v / |v| for |v| in [1e-15, 1e19]; the zero vector stays zero.
HALFLIT_INLINE V3 normalize(V3 v) { return v * vdiv(F(1.0f), vsqrt(vmax(dot(v, v), F(1e-30f)))); }

/// v / |v| for every finite vector up to 1.7e38, denormals included. v is first scaled by the power of two that brings the largest
/// component into [1, 2). The zero vector stays zero, and its N.L is 0 for every light.
HALFLIT_INLINE V3 normalize_any(V3 v) {
    const F largest = vmax(vabs(v.x), vmax(vabs(v.y), vabs(v.z)));
    const F scale = from_bits(I(0x7f000000) - (bits(largest) & I(0x7f800000)));
    return normalize(v * scale);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit
