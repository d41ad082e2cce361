// The scene of halflit.h: a C++ scene, its prepared form, and what changed between the two.
#pragma once

#include "apps/c/world.hpp"
#include "halflit/halflit.h"

#include <halflit/error.hpp>
#include <halflit/model.hpp>
#include <halflit/prepared_scene.hpp>
#include <halflit/scene.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace halflit::c {

/// Changes of a scene since it was prepared.
class Changes {
public:
    /// Numbers of meshes, instances or materials: all has to be prepared anew.
    void structure() { structure_ = true; }
    void instance(std::size_t index) { note(index, changes_.changed_instances, moved_); }
    void mesh(std::size_t index) { note(index, changes_.deformed_meshes, deformed_); }
    void materials() { changes_.materials = true; }

    [[nodiscard]] bool any() const {
        return !changes_.changed_instances.empty() || !changes_.deformed_meshes.empty() || changes_.materials;
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

/// Places of a list that were removed, and may be used again.
class FreePlaces {
public:
    [[nodiscard]] bool has(std::size_t index) const { return free_.contains(index); }
    [[nodiscard]] const std::set<std::size_t>& all() const { return free_; }
    [[nodiscard]] std::size_t kept() const { return kept_; }
    void add(std::size_t index) { free_.insert(index); }
    /// The places below `count` are a file's: animations move what lies there, so that they are not used again.
    void keep(std::size_t count) { kept_ = count; }
    /// The place of a new entry: the lowest free one, or the list's end.
    [[nodiscard]] std::size_t next(std::size_t count) const {
        const auto first = free_.lower_bound(kept_);
        return first != free_.end() ? *first : count;
    }
    /// A place was filled.
    void fill(std::size_t index) { free_.erase(index); }

private:
    std::set<std::size_t> free_;
    std::size_t kept_ = 0;
};

/// A mesh as it was given, if the scene's mesh has normals or tangents that the library made: its vertices may be split.
using GivenMeshes = std::map<std::size_t, Mesh>;

}  // namespace halflit::c

struct halflit_scene {
    halflit::Scene scene;
    std::string name = "scene";              ///< of the file; for messages
    std::optional<halflit::SceneInfo> info;  ///< of the file
    std::vector<std::string> warnings;
    std::vector<halflit::AnimationInfo> animations;
    std::shared_ptr<const halflit::Motion> motion;      ///< null: not kept
    halflit::c::World world;                            ///< what is passed in and returned goes through it
    bool up_is_set = false;                             ///< by the caller
    std::vector<halflit::Node> nodes;                   ///< of the file; their instances with the skinned ones
    std::vector<int> node_of_instance;                  ///< of the first instances, which a file may have brought; -1: none
    std::map<std::size_t, std::string> instance_names;  ///< of those that the caller named
    halflit::c::FreePlaces free_meshes, free_instances, free_lights, free_textures;
    std::size_t file_meshes = 0;                        ///< the first meshes, which a file or the library brought
    std::map<std::size_t, bool> added_without_normals;  ///< meshes that the caller added so, and whether they are smooth
    halflit::c::GivenMeshes given_meshes;

    mutable std::mutex access;  ///< held while the scene is read or changed; not while it is drawn
    mutable int drawing = 0;    ///< frames that are being drawn: the scene must stay as it is
    mutable halflit::c::Changes changes;
    mutable std::mutex preparing;  ///< held while `prepared` is made or updated
    mutable std::optional<halflit::PreparedScene> prepared;

    /// Makes `given` the mesh at `index`, which may be the next one. Adds the normals and tangents that its material and those of its
    /// instances require. Requires: indices and material in range.
    void put_mesh(std::size_t index, halflit::Mesh given);
    /// The same for a mesh that the caller gives whole. Remembers whether it came without normals. smooth: it gets them then.
    void put_given_mesh(std::size_t index, halflit::Mesh given, bool smooth);
    /// Adds what an instance's own material requires of its mesh.
    void complete_mesh_of(const halflit::Instance& instance);
    /// Adds what a material, which has changed, requires of its meshes.
    void complete_meshes_of(std::size_t material);

    /// Writes Node::instances by node_of_instance: skinned ones too.
    void list_instances_of_nodes();
    /// Sets the world of an instance, its mesh, and so on. The index may be the next one. Requires: indices in range.
    void put_instance(std::size_t index, const halflit::Instance& given);

    /// Adds what a material requires of a mesh.
    void complete(std::size_t mesh, int material);

    /// Brings `prepared` up to date. Called for a frame that counts in `drawing`.
    [[nodiscard]] halflit::Result<void> prepare(const halflit::Execution& execution) const;
};

/// The light of a picture that halflit_choose_picture chose.
struct halflit_lighting {
    halflit::Lighting light;
    std::size_t scene_lights = 0;  ///< the first ones, which are the scene's
};
