// Shadow look-ups of coarse meshes. A point of a flat triangle lies below the smooth surface given by the vertex normals, so that
// neighbouring triangles would shadow it before the smooth surface turns away from the light. [Hanika21]: each vertex defines a plane at a
// right angle to its normal. The point is moved onto each plane that it lies below, and the three offsets are blended by its barycentric
// coordinates.
#pragma once

#include "shading/kernels/vector.hpp"

namespace halflit::raster {
inline namespace HALFLIT_ISA_NAMESPACE {

/// World-space position and normal (any length) of a triangle's vertices.
struct CornerLanes {
    V3 position[3], normal[3];
};

/// Offset from `point` to the plane of corner k; 0 if the point is above the plane. side: -1 if the triangle's back is seen, else +1.
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
