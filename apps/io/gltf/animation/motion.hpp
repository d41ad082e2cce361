// Animations of a loaded file and what they move, apart from the file's text and buffers.
#pragma once

#include "apps/io/gltf/animation/animation.hpp"
#include "apps/io/gltf/build/nodes.hpp"
#include "apps/io/gltf/build/pose_sources.hpp"
#include "halflit/gltf.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace halflit {

class Motion {
public:
    /// Keeps of the file what poses need. To be called before an animation is applied to it.
    Motion(const io::detail::file::File& file, const io::detail::NodeTree& tree, bool recentre);

    /// A copy of a material of the file, whose factors follow it.
    void add_copy(int material, int copy) { copies_.emplace_back(material, copy); }
    /// To be called when all else is loaded.
    void finish(io::detail::PoseSources sources, const LoadedScene& loaded, std::vector<io::detail::Animation> animations,
                const std::vector<bool>& hides);

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
    io::detail::PoseSources sources_;
    std::vector<std::pair<int, int>> cameras_, lights_;                 // node, and index in the scene
    std::vector<std::pair<int, int>> copies_;                           // of materials: the original, and the copy
    std::vector<bool> hides_;                                           // by node: it is shown and hidden
    std::vector<bool> moved_materials_, moved_cameras_, moved_lights_;  // by number in the file
    std::size_t nodes_ = 0;
    bool recentre_;  // LoadOptions
    Placement placement_;
};

}  // namespace halflit
