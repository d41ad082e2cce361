// Parts of a model, as people count and name them: what one node of its file places.
#pragma once

#include "halflit/model.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace halflit::engine {

struct Part {
    std::string name;            ///< of the node; else of its mesh; may be empty
    std::vector<int> instances;  ///< indices into Scene::instances, one for each material
    int group = -1;              ///< index into Parts::groups() of the node above its own; -1: none
    int node = -1;               ///< its own, index into Parts::groups(); -1: the scene has no file
};

/// A node of the file, with or without a part. It may have parts below it.
struct PartGroup {
    std::string name;  ///< may be empty
    int parent = -1;   ///< index into Parts::groups(); -1: none
};

/// A part's name for people; `instance` is an index into Scene::instances. Empty: it has none, or belongs to no part, as a ground.
using NameOfInstance = std::function<std::string(std::size_t instance)>;

/// Numbers of parts begin at 1 where people see them.
class Parts {
public:
    /// Makes the parts of a scene without a file: each instance is a part.
    explicit Parts(const Scene& scene);
    /// In the order of the file's nodes.
    explicit Parts(const LoadedScene& loaded);

    [[nodiscard]] const std::vector<Part>& list() const { return parts_; }
    /// All nodes of the file, by their numbers in it; empty for other scenes.
    [[nodiscard]] const std::vector<PartGroup>& groups() const { return groups_; }
    /// Index into list() of the part that an instance belongs to; -1: none, as a ground that was added.
    [[nodiscard]] int of_instance(std::size_t instance) const { return instance < of_instance_.size() ? of_instance_[instance] : -1; }
    [[nodiscard]] const std::vector<int>& of_instances() const { return of_instance_; }
    /// An instance that was added, such as the cap of a section.
    void add_instance(std::size_t instance, int part);

private:
    void name_by_meshes(const Scene& scene);

    std::vector<Part> parts_;
    std::vector<PartGroup> groups_;
    std::vector<int> of_instance_;
};

[[nodiscard]] NameOfInstance names_of(std::shared_ptr<const Parts> parts);

}  // namespace halflit::engine
