// Triangles and their vertices, in object space. One mesh has one material (a glTF primitive becomes a mesh).
#pragma once

#include "sh/mat4.hpp"
#include "sh/vec3.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace halflit::raster {

/// Counter-clockwise triangles are front faces. Attribute arrays are empty or as long as `positions`.
struct Mesh {
    std::string name;
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;          ///< any length > 0; required for lit materials (see generate_flat_normals)
    std::vector<Vec4f> tangents;         ///< xyz any length > 0, w = +1 or -1: bitangent = cross(normal, tangent) * w
    std::vector<Vec2f> uv0, uv1;         ///< v points down: v = 0 is the first row of the texture
    std::vector<Vec4f> colors;           ///< linear RGBA
    std::vector<std::uint32_t> indices;  ///< three per triangle, each < positions.size()
    int material = -1;                   ///< index into Scene::materials; -1: the default material
};

/// A mesh placed in the world.
struct Instance {
    int mesh = 0;
    Mat4 world_from_object;
};

}  // namespace halflit::raster
