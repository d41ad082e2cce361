// Triangles, lines or points and their vertices, in object space. One mesh has one material (a glTF primitive becomes a mesh).
#pragma once

#include "halflit/export.hpp"
#include "halflit/math.hpp"
#include "halflit/splats.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace halflit {

/// Primitives that a mesh is made of. Lines and points are drawn as shapes that face the screen: a line as a rectangle of
/// Settings::line_width pixels around it, without caps, a point as a circle of Settings::point_size pixels (a square below 3). They are
/// seen from all sides, hide each other and triangles by depth, receive shadows and cast none.
enum class Topology : std::uint8_t { triangles, lines, points };

/// Entries of Mesh::indices for each primitive.
[[nodiscard]] constexpr std::size_t corners_of(Topology topology) {
    return topology == Topology::triangles ? 3 : topology == Topology::lines ? 2 : 1;
}

/// Counter-clockwise triangles are front faces. Attribute arrays are empty or as long as `positions`.
struct Mesh {
    std::string name{};              ///< for messages; may be empty
    std::vector<Vec3f> positions{};  ///< object space, any unit
    std::vector<Vec3f> normals{};    ///< any length > 0; lit materials need them (see generate_flat_normals), a frame that draws a lit mesh
                                     ///< without them has a warning
    std::vector<Vec4f> tangents{};   ///< xyz any length > 0, w = +1 or -1: bitangent = cross(normal, tangent) * w
    std::vector<Vec2f> uv0{}, uv1{};       ///< v points down: v = 0 is the first row of the texture
    std::vector<Vec4f> colors{};           ///< linear RGBA
    std::vector<std::uint32_t> indices{};  ///< three per triangle, two per line, one per point; each < positions.size()
    int material = -1;  ///< index into Scene::materials; -1: the default material, white, rough and metallic as glTF has it
    /// Lit lines and points need normals as triangles do; those without should have an unlit material.
    Topology topology = Topology::triangles;
    /// The first positions are the middles of 3D Gaussians, and nothing else is drawn; for points alone. `indices` are the positions to
    /// which views of the scene are fitted. null: there are none.
    std::shared_ptr<const Splats> splats{};
};

/// Number of triangles; 0 for lines and points.
[[nodiscard]] inline std::size_t triangles_of(const Mesh& mesh) {
    return mesh.topology == Topology::triangles ? mesh.indices.size() / 3 : 0;
}

/// True for points that are drawn as such, not as splats.
[[nodiscard]] inline bool is_cloud(const Mesh& mesh) { return mesh.topology == Topology::points && mesh.splats == nullptr; }

/// A mesh placed in the world.
struct Instance {
    int mesh = 0;              ///< index into Scene::meshes
    Mat4 world_from_object{};  ///< any affine matrix; the last row is 0 0 0 1
    int material = -1;         ///< index into Scene::materials, in place of the mesh's; -1: the mesh's
    Vec4f color{1, 1, 1, 1};   ///< linear, times the material's base colour; alpha counts where the material masks or blends
    bool visible = true;       ///< false: it is not drawn, casts no shadow, and views do not look at it
    bool backdrop = false;     ///< a view of the whole scene leaves it out, if there is something else; not in C and Python
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
/// has no area or is not finite gets (0, 0, 1). Requires: indices in range. Lines and points are left as they are, here and below.
HALFLIT_API void generate_flat_normals(Mesh& mesh);

/// Makes mesh.normals those of the smooth surface through the vertices: the mean of the triangles around each, by their areas, of length 1.
/// Vertices at one position count as one, so that a seam of texture coordinates does not show; where their triangles face away from the
/// mean, as on the two sides of a sheet, they count alone. A vertex without a triangle, or whose triangles cancel each other, has +y.
/// Vertices are not split. Triangles alone.
HALFLIT_API void generate_smooth_normals(Mesh& mesh);

/// Fills mesh.tangents from positions, normals and a set of texture coordinates (0 or 1, v down); the mesh must have all three, and indices
/// in range. A vertex whose triangles disagree (mirrored or separate charts) is split, and its other attributes are copied. Indices change,
/// the order of triangles does not. w is +1 or -1 by glTF's rule: bitangent = cross(normal, tangent) * w points up in the texture (along
/// -v). The rules are those of MikkTSpace [Mikk08]; raster/README.md gives them, and the one difference.
HALFLIT_API void generate_tangents(Mesh& mesh, int uv_set);

/// A mesh of 3D Gaussians around these positions. Those with a number that is not finite are left out; rotations do not count there:
/// those of a length near 0, or that are not finite, become none. Views are fitted to Gaussians of an opacity above 0.1, or else to
/// all, but for the outermost hundredth on each side of each axis; where they are few, to the ends of their axes, which are appended to the
/// positions. Requires: a degree from 0 to 4, and arrays of the lengths that Splats says.
[[nodiscard]] HALFLIT_API Mesh make_splat_mesh(std::vector<Vec3f> positions, Splats splats);

}  // namespace halflit
