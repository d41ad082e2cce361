// Meshes made by code: simple closed forms for demos, tests and benchmarks. Every shape is centred on the origin, wound
// counter-clockwise seen from outside, with unit outward normals and one set of texture coordinates (v points down).
// The same bits on every machine.
#pragma once

#include "halflit/export.hpp"
#include "halflit/mesh.hpp"

#include <cstdint>

namespace halflit {

/// Longitude and latitude sphere: 2 * slices * (stacks - 1) triangles, poles on the y axis, u from +z eastwards (towards +x), v from
/// the north pole down. Vertices are shared, except at the seam and the poles, where u jumps. slices >= 3, stacks >= 2 (smaller values are
/// raised).
[[nodiscard]] HALFLIT_API Mesh make_sphere(float radius, int slices, int stacks);

/// The same, with slices and stacks such that the triangle count is as close to `triangles` as nearly square quads allow. `triangles` is
/// clamped to 12..2^26.
[[nodiscard]] HALFLIT_API Mesh make_sphere_of(float radius, std::int64_t triangles);

/// Square in the plane y = 0 that faces +y, from -half_size to +half_size in x and z, in subdivisions x subdivisions quads (>= 1).
[[nodiscard]] HALFLIT_API Mesh make_plane(float half_size, int subdivisions);

/// Box with 24 vertices: each face has its own normals and the whole texture.
[[nodiscard]] HALFLIT_API Mesh make_box(Vec3f half_extents);

/// Torus around the y axis: `radius` to the middle of the tube, `tube` the tube's own radius. `slices` around the axis, `sides` around
/// the tube, both >= 3: 2 * slices * sides triangles. u runs as on the sphere; v from the inner rim over the top.
[[nodiscard]] HALFLIT_API Mesh make_torus(float radius, float tube, int slices, int sides);

}  // namespace halflit
