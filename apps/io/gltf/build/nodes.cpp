#include "apps/io/gltf/build/nodes.hpp"

#include "apps/io/gltf/file/node_transform.hpp"
#include "sh/time_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace halflit::io::detail {

namespace {

std::span<const int> children_of(const file::File& file, std::size_t node) {
    const file::Run run = file.nodes[node].children;
    return std::span(file.children).subspan(run.first, run.count);
}

/// A link to a child that breaks the tree: refused by the strict rules, otherwise not followed.
void break_link(Document& document, std::size_t node, const std::string& what) {
    const std::string where = fmt::format("nodes[{}].children", node);
    if (document.options.strict) refuse(where, what);
    document.warn(fmt::format("{}: {}; this link is left out", where, what));
}

std::vector<int> find_parents(Document& document) {
    const file::File& file = document.file;
    std::vector<int> parent(file.nodes.size(), -1);
    TimeCheck check;
    for (std::size_t i = 0; i < file.nodes.size(); ++i) {
        check();
        for (const int child : children_of(file, i)) {
            if (child < 0) continue;  // a fault already
            int& found = parent[static_cast<std::size_t>(child)];
            if (static_cast<std::size_t>(child) == i)
                break_link(document, i, "the node is its own child");
            else if (found >= 0)
                break_link(document, i, fmt::format("node {} is a child of node {} already", child, found));
            else
                found = static_cast<int>(i);
        }
    }
    return parent;
}

/// Appends the trees of `roots`, parents first and children in their order. Leaves out nodes that are marked in `seen`, and marks the
/// others. Follows no link but that from a node's parent.
void append_trees(const file::File& file, const std::vector<int>& parent, const std::vector<int>& roots, std::vector<bool>& seen,
                  std::vector<int>& out) {
    std::vector<int> open;
    for (auto root = roots.rbegin(); root != roots.rend(); ++root)
        if (static_cast<std::size_t>(*root) < seen.size()) open.push_back(*root);  // others are faults already
    TimeCheck check;
    while (!open.empty()) {
        check();
        const int node = open.back();
        open.pop_back();
        if (seen[static_cast<std::size_t>(node)]) continue;
        seen[static_cast<std::size_t>(node)] = true;
        out.push_back(node);
        const std::span<const int> children = children_of(file, static_cast<std::size_t>(node));
        for (auto child = children.rbegin(); child != children.rend(); ++child)
            if (*child >= 0 && parent[static_cast<std::size_t>(*child)] == node) open.push_back(*child);
    }
}

/// Warns of nodes that a scene lists though they are no roots, and of nodes that it lists twice.
void check_roots(Document& document, std::size_t scene, const std::vector<int>& parent) {
    const std::vector<int>& roots = document.file.scenes[scene].nodes;
    std::vector<bool> seen(parent.size(), false);
    for (std::size_t i = 0; i < roots.size(); ++i) {
        const auto node = static_cast<std::size_t>(roots[i]);
        if (node >= parent.size()) continue;
        if (seen[node] && !document.warnings_are_full())
            document.warn(fmt::format("scenes[{}].nodes[{}]: node {} is there twice, drawn once", scene, i, node));
        else if (parent[node] >= 0 && !document.warnings_are_full())
            document.warn(fmt::format("scenes[{}].nodes[{}]: node {} is a child of node {}, expected a root; drawn in its parent's space",
                                      scene, i, node, parent[node]));
        seen[node] = true;
    }
}

bool has_mesh(const file::File& file, std::span<const int> nodes) {
    return std::any_of(nodes.begin(), nodes.end(), [&](int node) { return file.nodes[static_cast<std::size_t>(node)].mesh >= 0; });
}

/// Where no node has a mesh, though the file has meshes: a node for each of them, at the origin, behind the others.
void add_nodes_of_meshes(Document& document) {
    std::vector<file::Node>& nodes = document.file.nodes;
    const std::size_t meshes = document.file.meshes.size();
    if (meshes == 0 || std::any_of(nodes.begin(), nodes.end(), [](const file::Node& node) { return node.mesh >= 0; })) return;
    document.warn("no node has a mesh; the meshes are drawn at the origin");
    document.geometry.take(meshes * sizeof(file::Node));
    for (std::size_t mesh = 0; mesh < meshes; ++mesh) nodes.emplace_back().mesh = static_cast<int>(mesh);
}

/// The first scene that has a mesh; -1: none.
int scene_with_mesh(const file::File& file, const std::vector<int>& parent) {
    std::vector<bool> seen(parent.size(), false);  // in a scene before: there is no mesh
    for (std::size_t scene = 0; scene < file.scenes.size(); ++scene) {
        std::vector<int> drawn;
        append_trees(file, parent, file.scenes[scene].nodes, seen, drawn);
        if (has_mesh(file, drawn)) return static_cast<int>(scene);
    }
    return -1;
}

}  // namespace

NodeTree walk_nodes(Document& document) {
    file::File& file = document.file;
    const std::size_t nodes_of_file = file.nodes.size();
    const bool chooses = !document.options.strict && document.options.scene.empty();  // what draws something
    if (chooses) add_nodes_of_meshes(document);
    NodeTree tree;
    tree.parent = find_parents(document);
    std::vector<int>& parent = tree.parent;
    std::vector<int> roots;
    for (std::size_t i = 0; i < parent.size(); ++i)
        if (parent[i] < 0) roots.push_back(static_cast<int>(i));
    std::vector<bool> seen(parent.size(), false);
    append_trees(file, parent, roots, seen, tree.order);
    std::vector<bool> passed(parent.size(), false);
    for (std::size_t i = 0; i < parent.size(); ++i) {
        if (seen[i]) continue;
        std::size_t at = i;  // above it is a circle, whose first node that comes again is cut from its parent
        for (; !passed[at]; at = static_cast<std::size_t>(parent[at])) passed[at] = true;
        break_link(document, static_cast<std::size_t>(parent[at]), "the node is its own ancestor");
        parent[at] = -1;
        append_trees(file, parent, {static_cast<int>(at)}, seen, tree.order);
    }
    if (file.scenes.empty()) {
        tree.drawn = tree.order;
        return tree;
    }
    const auto draw = [&](int scene) {
        check_roots(document, static_cast<std::size_t>(scene), parent);
        seen.assign(parent.size(), false);
        tree.drawn.clear();
        append_trees(file, parent, file.scenes[static_cast<std::size_t>(scene)].nodes, seen, tree.drawn);
    };
    draw(document.info.scene);
    for (std::size_t i = nodes_of_file; i < file.nodes.size(); ++i) tree.drawn.push_back(static_cast<int>(i));
    if (!chooses || has_mesh(file, tree.drawn) || !has_mesh(file, tree.order)) return tree;
    if (const int other = scene_with_mesh(file, parent); other >= 0) {
        document.warn(fmt::format("scenes[{}]: has no mesh; scenes[{}] is drawn, which has some", document.info.scene, other));
        file.scene = document.info.scene = other;
        draw(other);
    } else {
        document.warn("scenes: none has a mesh; all nodes are drawn");
        tree.drawn = tree.order;
    }
    return tree;
}

void place_nodes(const file::File& file, NodeTree& tree) {
    tree.world_from_node.resize(file.nodes.size());
    tree.hidden.clear();
    TimeCheck check;
    for (const int i : tree.order) {
        check();
        const auto node = static_cast<std::size_t>(i);
        const Affine local = local_transform(file, node);
        const int parent = tree.parent[node];
        tree.world_from_node[node] = parent < 0 ? local : tree.world_from_node[static_cast<std::size_t>(parent)] * local;
        if (file.nodes[node].visible != 0) continue;
        tree.hidden.resize(file.nodes.size(), false);
        tree.hidden[node] = true;
    }
    mark_below(tree, tree.hidden);
}

void mark_below(const NodeTree& tree, std::vector<bool>& marks) {
    if (marks.empty()) return;
    for (const int i : tree.order) {
        const auto node = static_cast<std::size_t>(i);
        if (tree.parent[node] >= 0 && marks[static_cast<std::size_t>(tree.parent[node])]) marks[node] = true;
    }
}

std::vector<Node> make_nodes(Document& document, const NodeTree& tree) {
    const file::File& file = document.file;
    document.geometry.take(file.nodes.size() * sizeof(Node));
    std::vector<Node> nodes(file.nodes.size());
    TimeCheck check;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        check();
        document.geometry.take(file.nodes[i].name.size());
        nodes[i].name = file.nodes[i].name;
        nodes[i].parent = tree.parent[i];
        nodes[i].parent_from_node = to_node_transform(local_transform(file, i));
    }
    return nodes;
}

}  // namespace halflit::io::detail
