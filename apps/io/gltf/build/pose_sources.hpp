// The sources of meshes and instances that another pose needs.
#pragma once

#include "apps/io/gltf/build/deform.hpp"
#include "apps/io/gltf/file/file.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace halflit::io::detail {

/// The morph weights of a node: its own, or else its mesh's.
[[nodiscard]] std::span<const double> weights_of(const file::File& file, std::size_t node);

/// A mesh without vertices, with the same name and material: what is hidden.
[[nodiscard]] Mesh without_triangles(const Mesh& mesh);

/// Memory of a mesh's arrays.
[[nodiscard]] std::uint64_t bytes_of(const Mesh& mesh);

/// A mesh of the scene whose vertices change.
struct DeformedMesh {
    int mesh = -1, node = -1;
    int skin = -1;  ///< of the file; -1: none
    MeshSource source{};
    Vec3d place{};       ///< subtracted from a skinned mesh
    double scale = 1.0;  ///< of the positions, by the placement
};

/// An instance of the scene, and the node that placed it.
struct PlacedInstance {
    int instance = -1, node = -1;
    std::optional<Vec3d> at_world{};  ///< skinned: where it lies, without the node's transform
    std::optional<Affine> in_node{};  ///< its transform to the node; empty: the identity
};

struct PoseSources {
    std::vector<DeformedMesh> deformed;
    std::vector<PlacedInstance> placed;  ///< all instances of the file, in order
    std::map<int, Skin> skins;
};

}  // namespace halflit::io::detail
