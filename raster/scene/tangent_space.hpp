// Tangents for normal mapping, for meshes that bring none. The rules are MikkTSpace's [Mikk08], which glTF names as the default: what
// tools bake normal maps against.
#pragma once

#include "raster/scene/mesh.hpp"

namespace halflit::raster {

/// Fills mesh.tangents from positions, normals and a set of texture coordinates (0 or 1, v down); the mesh must have all three. A
/// vertex whose triangles disagree (mirrored or separate charts) is split, its other attributes copied; indices change, the order of
/// triangles does not. w is +1 or -1 by glTF's rule: bitangent = cross(normal, tangent) * w points up in the picture (along -v).
///
/// As in MikkTSpace: equal vertices are welded first; the triangles at a vertex form groups over shared edges with the same
/// orientation in texture space; a group's tangent is the sum of its triangles', projected to the normal's plane, weighted by the
/// angle; triangles without an area take the tangent of a neighbour, those without an area in texture space join any group.
/// differs: MikkTSpace splits a group where two projected tangents are exactly opposite; here the group stays one, so that the cost
/// grows with the number of triangles and not with the square of a vertex's.
void generate_tangents(Mesh& mesh, int uv_set);

}  // namespace halflit::raster
