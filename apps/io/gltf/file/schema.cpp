#include "apps/io/gltf/file/schema.hpp"

#include "apps/io/gltf/file/schema_rows.hpp"
#include "sh/config.hpp"

#include <deque>

namespace halflit::io::detail {

namespace {

class Schema {
public:
    Schema() {
        nodes_.emplace_back().rule = Rule::object;
        for (const SchemaRow& row : schema_rows()) apply(row, make(nodes_.front(), row.path));
        for (const SchemaRow& row : texture_place_rows()) {
            SchemaNode& place = make(nodes_.front(), row.path);
            apply(row, place);
            for (const SchemaRow& below : texture_rows()) apply(below, make(place, below.path));
        }
        for ([[maybe_unused]] const SchemaNode& node : nodes_) HALFLIT_ASSERT(node.members.size() <= 32);  // bits of required_mask
        for (SchemaNode& node : nodes_)
            for (std::size_t i = 0; i < node.members.size(); ++i)
                if (node.members[i].second->required) node.required_mask |= 1u << i;
    }
    [[nodiscard]] const SchemaNode& root() const { return nodes_.front(); }

private:
    static void apply(const SchemaRow& row, SchemaNode& node) {
        node.rule = row.rule;
        node.target = row.target;
        node.put = row.put;
        node.end = row.end;
        node.length = row.length;
        node.closed = row.closed;
        node.mild = row.mild;
        node.reads = row.reads;
        node.ranged = row.ranged;
        node.range = row.range;
        node.required = row.path.back() == '!';
    }

    SchemaNode& make(SchemaNode& from, std::string_view path) {
        SchemaNode* node = &from;
        if (path.back() == '!') path.remove_suffix(1);
        while (!path.empty()) {
            const std::size_t slash = path.find('/');
            const std::string_view key = path.substr(0, slash);
            path = slash == std::string_view::npos ? std::string_view{} : path.substr(slash + 1);
            if (node->rule == Rule::any) node->rule = key == "#" ? Rule::array : Rule::object;
            node = key == "#" || key == "*" ? &child(node->every) : &member(*node, key);
        }
        return *node;
    }
    SchemaNode& child(const SchemaNode*& every) {
        if (every == nullptr) every = &nodes_.emplace_back();
        return const_cast<SchemaNode&>(*every);  // every node is in nodes_, which is not const
    }
    SchemaNode& member(SchemaNode& node, std::string_view key) {
        const int at = node.find(key);
        if (at >= 0) return const_cast<SchemaNode&>(*node.members[static_cast<std::size_t>(at)].second);
        SchemaNode& made = nodes_.emplace_back();
        node.members.emplace_back(key, &made);
        return made;
    }

    std::deque<SchemaNode> nodes_;  // a deque: addresses stay
};

}  // namespace

const char* name_of(Target target) {
    static constexpr const char* kNames[] = {"",        "accessors", "animations", "buffers",   "bufferViews",
                                             "cameras", "images",    "lights",     "materials", "meshes",
                                             "nodes",   "samplers",  "scenes",     "skins",     "textures"};
    return kNames[static_cast<int>(target)];
}

std::size_t count_of(Target target, const file::File& file) {
    switch (target) {
        case Target::none:
            break;
        case Target::accessors:
            return file.accessors.size();
        case Target::animations:
            return file.animations.size();
        case Target::buffers:
            return file.buffers.size();
        case Target::buffer_views:
            return file.buffer_views.size();
        case Target::cameras:
            return file.cameras.size();
        case Target::images:
            return file.images.size();
        case Target::lights:
            return file.lights.size();
        case Target::materials:
            return file.materials.size();
        case Target::meshes:
            return file.meshes.size();
        case Target::nodes:
            return file.nodes.size();
        case Target::samplers:
            return file.samplers.size();
        case Target::scenes:
            return file.scenes.size();
        case Target::skins:
            return file.skins.size();
        case Target::textures:
            return file.textures.size();
    }
    return 0;
}

bool Range::holds(double value) const {
    if (codes != nullptr) {
        const int* code = codes;
        while (*code >= 0 && static_cast<double>(*code) != value) ++code;
        return *code >= 0;
    }
    return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

int SchemaNode::find(std::string_view key) const {
    for (std::size_t i = 0; i < members.size(); ++i)
        if (members[i].first == key) return static_cast<int>(i);
    return -1;
}

const SchemaNode& gltf_schema() {
    static const Schema schema;
    return schema.root();
}

}  // namespace halflit::io::detail
