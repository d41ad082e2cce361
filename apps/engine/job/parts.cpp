#include "apps/engine/job/parts.hpp"

#include <algorithm>
#include <utility>

namespace halflit::engine {

Parts::Parts(const Scene& scene) {
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        of_instance_.push_back(static_cast<int>(i));
        parts_.push_back({"", {static_cast<int>(i)}});
    }
    name_by_meshes(scene);
}

Parts::Parts(const LoadedScene& loaded) {
    const std::vector<int>& nodes = loaded.node_of_instance;
    of_instance_.assign(nodes.size(), -1);
    std::vector<int> part_of_node(loaded.nodes.size(), -1);
    for (const int node : nodes)
        if (node >= 0) part_of_node[static_cast<std::size_t>(node)] = 0;
    for (std::size_t node = 0; node < part_of_node.size(); ++node) {
        if (part_of_node[node] < 0) continue;
        part_of_node[node] = static_cast<int>(parts_.size());
        parts_.push_back({loaded.nodes[node].name, {}, loaded.nodes[node].parent, static_cast<int>(node)});
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i] < 0) continue;
        of_instance_[i] = part_of_node[static_cast<std::size_t>(nodes[i])];
        parts_[static_cast<std::size_t>(of_instance_[i])].instances.push_back(static_cast<int>(i));
    }
    for (const Node& node : loaded.nodes) groups_.push_back({node.name, node.parent});
    name_by_meshes(loaded.scene);
}

void Parts::name_by_meshes(const Scene& scene) {
    for (Part& part : parts_)
        if (part.name.empty() && !part.instances.empty()) {
            const int mesh = scene.instances[static_cast<std::size_t>(part.instances.front())].mesh;
            if (mesh >= 0 && static_cast<std::size_t>(mesh) < scene.meshes.size())
                part.name = scene.meshes[static_cast<std::size_t>(mesh)].name;
        }
}

void Parts::add_instance(std::size_t instance, int part) {
    if (of_instance_.size() <= instance) of_instance_.resize(instance + 1, -1);
    of_instance_[instance] = part;
    if (part >= 0) parts_[static_cast<std::size_t>(part)].instances.push_back(static_cast<int>(instance));
}

NameOfInstance names_of(std::shared_ptr<const Parts> parts) {
    return [parts = std::move(parts)](std::size_t instance) -> std::string {
        const int part = parts ? parts->of_instance(instance) : -1;
        return part < 0 ? "" : parts->list()[static_cast<std::size_t>(part)].name;
    };
}

}  // namespace halflit::engine
