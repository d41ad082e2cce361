// The scene of halflit.h: a C++ scene, its prepared form, and what changed between the two.
#pragma once

#include "halflit/halflit.h"

#include <halflit/error.hpp>
#include <halflit/gltf.hpp>
#include <halflit/prepared_scene.hpp>
#include <halflit/scene.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace halflit::c {

/// Changes of a scene since it was prepared.
class Changes {
public:
    /// Numbers of meshes, instances or materials: all has to be prepared anew.
    void structure() { structure_ = true; }
    void instance(std::size_t index) { note(index, changes_.moved_instances, moved_); }
    void mesh(std::size_t index) { note(index, changes_.deformed_meshes, deformed_); }
    void materials() { changes_.materials = true; }
    void lights() { changes_.lights = true; }

    [[nodiscard]] bool any() const {
        return !changes_.moved_instances.empty() || !changes_.deformed_meshes.empty() || changes_.materials || changes_.lights;
    }
    [[nodiscard]] bool of_structure() const { return structure_; }
    [[nodiscard]] const SceneChanges& list() const { return changes_; }
    void clear();

private:
    /// Lists an index once.
    void note(std::size_t index, std::vector<std::size_t>& list, std::vector<bool>& listed);

    bool structure_ = false;
    SceneChanges changes_;
    std::vector<bool> moved_, deformed_;
};

/// A mesh as it was given, if the scene's mesh has normals or tangents that the library made: its vertices may be split.
using GivenMeshes = std::unordered_map<std::size_t, Mesh>;

}  // namespace halflit::c

struct halflit_scene {
    halflit::Scene scene;
    std::vector<std::string> warnings;
    std::vector<halflit::AnimationInfo> animations;
    std::shared_ptr<const halflit::Motion> motion;  ///< null: not kept
    std::optional<halflit::Lighting> chosen_light;  ///< by the last setup; empty: the scene's own is drawn
    halflit::Vec3d origin{0, 0, 0};                 ///< a point p of the file is drawn at (p - origin) * scale
    double scale = 1.0;
    std::size_t file_meshes = 0;       ///< the first meshes, which a file or the library brought
    std::set<std::size_t> added_flat;  ///< meshes that the caller added without normals
    halflit::c::GivenMeshes given_meshes;

    mutable std::mutex access;  ///< held while the scene is read or changed; not while it is drawn
    mutable int drawing = 0;    ///< frames that are being drawn: the scene must stay as it is
    mutable halflit::c::Changes changes;
    mutable std::mutex preparing;  ///< held while `prepared` is made or updated
    mutable std::optional<halflit::PreparedScene> prepared;

    /// The light that is drawn.
    [[nodiscard]] const halflit::Lighting& light() const { return chosen_light ? *chosen_light : scene; }

    /// Makes `given` the mesh at `index`, which may be the next one. Adds the normals and tangents that its material requires. Requires:
    /// indices and material in range.
    void put_mesh(std::size_t index, halflit::Mesh given);
    /// The same for a mesh that the caller gives whole. Remembers whether it came without normals.
    void put_given_mesh(std::size_t index, halflit::Mesh given);
    /// Adds what a material, which has changed, requires of its meshes.
    void complete_meshes_of(std::size_t material);

    /// Moves the scene's lights in the light that a setup chose as they were moved in the scene.
    void follow_pose();

    /// Brings `prepared` up to date. Called for a frame that counts in `drawing`.
    [[nodiscard]] halflit::Result<void> prepare(const halflit::Execution& execution) const;
};
