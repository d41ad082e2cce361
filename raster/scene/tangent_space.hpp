// Tangents for normal mapping, for meshes that have none. The rules are those of MikkTSpace [Mikk08]: glTF names it as the default, and
// tools bake normal maps with it.
#pragma once

#include "raster/scene/mesh.hpp"

namespace halflit::raster {

/// Fills mesh.tangents from positions, normals and a set of texture coordinates (0 or 1, v down); the mesh must have all three. A
/// vertex whose triangles disagree (mirrored or separate charts) is split, and its other attributes are copied. Indices change, the order
/// of triangles does not. w is +1 or -1 by glTF's rule: bitangent = cross(normal, tangent) * w points up in the texture (along -v).
///
/// As in MikkTSpace: vertices with equal position, normal and texture coordinates are welded first. The triangles at a vertex that share
/// edges and have the same orientation in texture space form a group. A group's tangent is the sum of its triangles' tangents, projected
/// to the normal's plane and weighted by the angle at the vertex. Triangles without area take the tangent of a neighbour. Triangles without
/// area in texture space join any group.
/// differs: MikkTSpace splits a group where two projected tangents are exactly opposite. Here the group is not split, so that the cost
/// grows with the number of triangles, and not with the square of the number at a vertex.
void generate_tangents(Mesh& mesh, int uv_set);

}  // namespace halflit::raster
