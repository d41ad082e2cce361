// Where coarse meshes look their shadows up: a point of a flat triangle lies below the smooth surface that its vertex normals
// describe, and would be shaded by its neighbours before the smooth surface turns away from the light. [Hanika21]: each vertex
// sets up a plane at a right angle to its normal; the point is moved onto those that it lies below, and the three results are blended
// by its barycentric coordinates.
#pragma once

#include "shading/kernels/vector.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

/// World-space position and normal (any length) of a triangle's vertices.
struct CornerLanes {
    V3 position[3], normal[3];
};

/// From `point` up to the plane of corner k; 0 where it is above it. side: -1 where the back of the triangle is seen.
HALFLIT_INLINE V3 onto_plane(const CornerLanes& corners, int k, V3 point, F side) {
    const V3 normal = normalize_any(corners.normal[k]) * side;
    return normal * vmax(dot(corners.position[k] - point, normal), F(0.0f));
}

HALFLIT_INLINE V3 terminator_offset(const CornerLanes& corners, V3 point, F b1, F b2, F side) {
    const F b0 = vmax((F(1.0f) - b1) - b2, F(0.0f));
    return (onto_plane(corners, 0, point, side) * b0 + onto_plane(corners, 1, point, side) * b1) + onto_plane(corners, 2, point, side) * b2;
}

HALFLIT_INLINE void store_terminator_offset(shading::FragmentBlock& block, int at, V3 offset) {
    store(block.lane[shading::kShadowX] + at, offset.x);
    store(block.lane[shading::kShadowY] + at, offset.y);
    store(block.lane[shading::kShadowZ] + at, offset.z);
}

}  // namespace HALFLIT_ISA_NAMESPACE
}  // namespace halflit::raster
