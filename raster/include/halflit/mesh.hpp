// Triangles and their vertices, in object space. One mesh has one material (a glTF primitive becomes a mesh).
#pragma once

#include "halflit/export.hpp"
#include "halflit/math.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace halflit {

/// Counter-clockwise triangles are front faces. Attribute arrays are empty or as long as `positions`.
struct Mesh {
    std::string name;              ///< for messages; may be empty
    std::vector<Vec3f> positions;  ///< object space, any unit
    std::vector<Vec3f> normals;    ///< any length > 0; lit materials need them (see generate_flat_normals), a frame that draws a lit mesh
                                   ///< without them has a warning
    std::vector<Vec4f> tangents;   ///< xyz any length > 0, w = +1 or -1: bitangent = cross(normal, tangent) * w
    std::vector<Vec2f> uv0, uv1;   ///< v points down: v = 0 is the first row of the texture
    std::vector<Vec4f> colors;     ///< linear RGBA
    std::vector<std::uint32_t> indices;  ///< three per triangle, each < positions.size()
    int material = -1;                   ///< index into Scene::materials; -1: the default material
};

/// A mesh placed in the world.
struct Instance {
    int mesh = 0;            ///< index into Scene::meshes
    Mat4 world_from_object;  ///< any affine matrix; the last row is 0 0 0 1
};

/// Smallest axis-aligned box around a set of points, in the points' space.
struct Bounds {
    Vec3f min{0, 0, 0}, max{0, 0, 0};  ///< corners; meaningless while `empty`
    bool empty = true;                 ///< no point was added yet
    /// Adds a point; ignores it if it is not finite.
    HALFLIT_API void add(Vec3f p);
    /// Adds a box; ignores it if it is empty.
    HALFLIT_API void include(const Bounds& other);
    [[nodiscard]] HALFLIT_API Vec3f center() const;  ///< middle between min and max
    [[nodiscard]] HALFLIT_API float radius() const;  ///< half the diagonal
};

/// Gives each triangle three vertices of its own, with the triangle's normal; the counter-clockwise side is outside. No vertex is shared
/// afterwards, and index i is i. Other attributes are copied. Tangents are removed, because they belong to other normals. A triangle that
/// has no area or is not finite gets (0, 0, 1). Requires: indices in range.
HALFLIT_API void generate_flat_normals(Mesh& mesh);

/// Fills mesh.tangents from positions, normals and a set of texture coordinates (0 or 1, v down); the mesh must have all three, and indices
/// in range. A vertex whose triangles disagree (mirrored or separate charts) is split, and its other attributes are copied. Indices change,
/// the order of triangles does not. w is +1 or -1 by glTF's rule: bitangent = cross(normal, tangent) * w points up in the texture (along
/// -v). The rules are those of MikkTSpace [Mikk08]; raster/README.md gives them, and the one difference.
HALFLIT_API void generate_tangents(Mesh& mesh, int uv_set);

}  // namespace halflit
