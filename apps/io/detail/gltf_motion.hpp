// Animations of a loaded file and what they move, apart from the file's text and buffers.
#pragma once

#include "apps/io/detail/gltf_animation.hpp"
#include "apps/io/detail/gltf_deform.hpp"
#include "apps/io/detail/gltf_nodes.hpp"
#include "halflit/gltf.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
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
    double scale = 1.0;  ///< of the positions, by recentre()
};

/// An instance of the scene, and the node that placed it.
struct PlacedInstance {
    int instance = -1, node = -1;
    std::optional<Vec3d> at_world{};  ///< skinned: where it lies, without the node's transform
    std::optional<Affine> in_node{};  ///< its transform to the node; empty: the identity
    double mesh_scale = 1.0;          ///< of its mesh's positions
};

}  // namespace halflit::io::detail

namespace halflit {

class Motion {
public:
    /// Keeps of the file what poses need. To be called before an animation is applied to it.
    Motion(const io::detail::file::File& file, const io::detail::NodeTree& tree);

    void add(io::detail::DeformedMesh mesh) { deformed_.push_back(std::move(mesh)); }
    void add(io::detail::PlacedInstance instance) { placed_.push_back(instance); }
    /// A copy of a material of the file, whose factors follow it.
    void add_copy(int material, int copy) { copies_.emplace_back(material, copy); }
    void add(int index, const io::detail::Skin& skin) { skins_.emplace(index, skin); }
    /// To be called when all else is loaded. mesh_scales: recentre()'s.
    void finish(const LoadedScene& loaded, std::vector<io::detail::Animation> animations, const std::vector<bool>& hides,
                const std::vector<double>& mesh_scales);

    [[nodiscard]] Result<SceneChanges> pose(const std::string& animation, double time_s, Scene& scene, std::span<Node> nodes) const;

private:
    [[nodiscard]] Result<void> check(const Scene& scene, std::span<const Node> nodes) const;
    void move_instances(const io::detail::file::File& file, const io::detail::NodeTree& tree, Scene& scene, SceneChanges& changes) const;
    void deform(const io::detail::file::File& file, const io::detail::NodeTree& tree, Scene& scene, SceneChanges& changes) const;
    void set_lights(const io::detail::file::File& file, const io::detail::NodeTree& tree, Scene& scene, SceneChanges& changes) const;

    io::detail::file::File rest_;  // without texts, geometry and buffers
    io::detail::NodeTree tree_;    // without transforms
    std::vector<std::string> names_;
    std::vector<io::detail::Animation> animations_;  // all of the file
    std::vector<io::detail::DeformedMesh> deformed_;
    std::vector<io::detail::PlacedInstance> placed_;  // all instances of the file, in order
    std::map<int, io::detail::Skin> skins_;
    std::vector<std::pair<int, int>> cameras_, lights_;                 // node, and index in the scene
    std::vector<std::pair<int, int>> copies_;                           // of materials: the original, and the copy
    std::vector<bool> hides_;                                           // by node: it is shown and hidden
    std::vector<bool> moved_materials_, moved_cameras_, moved_lights_;  // by number in the file
    std::size_t nodes_ = 0;
    Vec3d origin_{};
    double scale_ = 1.0;
};

}  // namespace halflit
