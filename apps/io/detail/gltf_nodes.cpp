#include "apps/io/detail/gltf_nodes.hpp"

#include <fmt/format.h>

namespace halflit::io::detail {

namespace {

void check_length(const std::vector<double>& values, std::size_t expected, std::size_t node, const char* key) {
    if (!values.empty() && values.size() != expected)
        refuse(fmt::format("nodes[{}].{}", node, key), fmt::format("expected {} numbers, found {}", expected, values.size()));
}

/// Rotation by a quaternion of any length but zero; zero means none.
Affine rotation_of(double x, double y, double z, double w) {
    const double length2 = ((x * x + y * y) + z * z) + w * w;
    if (!(length2 > 1e-200 && length2 < 1e200)) return {};
    const double s = 2.0 / length2;
    return {{{1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)},
             {s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)},
             {s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)},
             {0, 0, 0}}};
}

Affine local_transform(const tinygltf::Node& node, std::size_t index) {
    check_length(node.matrix, 16, index, "matrix");
    check_length(node.translation, 3, index, "translation");
    check_length(node.rotation, 4, index, "rotation");
    check_length(node.scale, 3, index, "scale");
    Affine m;
    if (!node.matrix.empty()) {  // column major; the last row of an affine transform is 0 0 0 1
        for (std::size_t j = 0; j < 4; ++j) m.c[j] = {node.matrix[4 * j], node.matrix[4 * j + 1], node.matrix[4 * j + 2]};
        return m;
    }
    if (!node.rotation.empty()) m = rotation_of(node.rotation[0], node.rotation[1], node.rotation[2], node.rotation[3]);
    if (!node.scale.empty())
        for (std::size_t j = 0; j < 3; ++j) m.c[j] = m.c[j] * node.scale[j];
    if (!node.translation.empty()) m.c[3] = {node.translation[0], node.translation[1], node.translation[2]};
    return m;
}

std::vector<int> find_parents(const std::vector<tinygltf::Node>& nodes) {
    std::vector<int> parent(nodes.size(), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (const int child : nodes[i].children) {
            int& found = parent[static_cast<std::size_t>(child)];
            if (static_cast<std::size_t>(child) == i) refuse(fmt::format("nodes[{}].children", i), "the node is its own child");
            if (found >= 0)
                refuse(fmt::format("nodes[{}].children", i), fmt::format("node {} is a child of node {} already", child, found));
            found = static_cast<int>(i);
        }
    }
    return parent;
}

/// Appends the trees of `roots`, parents first and children in their order, leaving out what is there already.
void append_trees(const std::vector<tinygltf::Node>& nodes, const std::vector<int>& roots, std::vector<bool>& seen, std::vector<int>& out) {
    std::vector<int> open(roots.rbegin(), roots.rend());
    while (!open.empty()) {
        const int node = open.back();
        open.pop_back();
        if (seen[static_cast<std::size_t>(node)]) continue;
        seen[static_cast<std::size_t>(node)] = true;
        out.push_back(node);
        const std::vector<int>& children = nodes[static_cast<std::size_t>(node)].children;
        open.insert(open.end(), children.rbegin(), children.rend());
    }
}

}  // namespace

NodeTree place_nodes(const Document& document) {
    const std::vector<tinygltf::Node>& nodes = document.model.nodes;
    const std::vector<int> parent = find_parents(nodes);
    std::vector<int> roots, order;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (parent[i] < 0) roots.push_back(static_cast<int>(i));
    std::vector<bool> seen(nodes.size(), false);
    append_trees(nodes, roots, seen, order);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (!seen[i]) refuse(fmt::format("nodes[{}].children", i), "the node is its own ancestor");

    NodeTree tree;
    tree.world_from_node.resize(nodes.size());
    for (const int i : order) {
        const auto node = static_cast<std::size_t>(i);
        const Affine local = local_transform(nodes[node], node);
        tree.world_from_node[node] = parent[node] < 0 ? local : tree.world_from_node[static_cast<std::size_t>(parent[node])] * local;
    }
    if (document.model.scenes.empty()) {
        tree.drawn = std::move(order);
    } else {
        const std::size_t scene = document.model.defaultScene < 0 ? 0 : static_cast<std::size_t>(document.model.defaultScene);
        seen.assign(nodes.size(), false);
        append_trees(nodes, document.model.scenes[scene].nodes, seen, tree.drawn);
    }
    return tree;
}

}  // namespace halflit::io::detail
