// Meshes whose vertices depend on the pose: morph targets are added, joints move the vertices, and normals and tangents that the file lacks
// are made. A mesh is posed by the same function while loading and later.
#pragma once

#include "apps/io/gltf/file/transform.hpp"
#include "halflit/mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace halflit::io::detail {

/// Differences to the mesh's arrays, each as long as they are, or empty.
struct MorphTarget {
    std::vector<Vec3f> positions, normals, tangents;
    std::vector<Vec2f> uv0, uv1;
    std::vector<Vec4f> colors;
};

/// Four joints of a vertex and their weights. A weight that does not count is 0.
struct Influence {
    std::uint32_t joint[4];  ///< index into the skin's joints
    float weight[4];
};

/// A mesh before it is posed.
struct MeshSource {
    Mesh mesh;                          ///< as the file has it
    std::vector<MorphTarget> targets;   ///< those that are never used have no arrays
    std::vector<Influence> influences;  ///< sets * vertices, by vertex; empty: not skinned
    std::size_t sets = 0;               ///< influences of a vertex
    bool flat_normals = false;          ///< the file has no normals
    int tangents_of = -1;               ///< set of texture coordinates to make tangents for; -1: not needed
};

struct Skin {
    std::vector<int> joints;           ///< nodes
    std::vector<Affine> inverse_bind;  ///< a matrix for each joint
};

/// Transform of each joint, from the mesh to the world.
[[nodiscard]] std::vector<Affine> joint_matrices(const Skin& skin, std::span<const Affine> world_from_node);

struct Posed {
    Mesh mesh;
    Vec3d place;  ///< skinned: point of the world at which the mesh lies
};

/// The mesh with these morph weights, of which there may be fewer or more than targets, moved by its joints. `base` is source.mesh or a
/// copy of it. Positions are computed in double and rounded once. place: subtracted from a skinned mesh's positions; none: its middle, if
/// it is far from the origin, in a number that float holds.
[[nodiscard]] Posed pose_mesh(Mesh base, const MeshSource& source, std::span<const double> weights, std::span<const Affine> joints,
                              std::optional<Vec3d> place);

}  // namespace halflit::io::detail
