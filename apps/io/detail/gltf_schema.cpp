#include "apps/io/detail/gltf_schema.hpp"

#include <deque>

namespace halflit::io::detail {

namespace {

struct Row {
    std::string_view path;  ///< '/' between keys; '#': each element of an array; '*': each member of an object; "!" at the end: required
    Rule rule;
    Target target{};
    Capture capture = Capture::none;
    bool dropped = false;
};

using enum Rule;
constexpr Target kNone{};

// Keys that are not here are not looked at, neither by this check nor by the loader.
constexpr Row kRows[] = {
    {"asset!", object},
    {"asset/version!", string, kNone, Capture::version},
    {"asset/minVersion", string, kNone, Capture::min_version},
    {"asset/extras", any, kNone, Capture::none, true},
    {"extensionsUsed/#", string, kNone, Capture::extension_used},
    {"extensionsRequired/#", string, kNone, Capture::extension_required},
    {"extras", any, kNone, Capture::none, true},
    {"scene", index, Target::scenes},
    {"scenes/#/nodes/#", index, Target::nodes},
    {"scenes/#/extras", any, kNone, Capture::none, true},

    {"buffers", array, kNone, Capture::none, true},
    {"buffers/#", object, kNone, Capture::buffer},
    {"buffers/#/uri", string, kNone, Capture::buffer_uri},
    {"buffers/#/byteLength!", size, kNone, Capture::buffer_length},
    {"images", array, kNone, Capture::none, true},
    {"images/#", object, kNone, Capture::image},
    {"images/#/uri", string, kNone, Capture::image_uri},
    {"images/#/bufferView", index, Target::buffer_views, Capture::image_view},
    {"animations", array, kNone, Capture::none, true},
    {"animations/#", object, kNone, Capture::animation},

    {"bufferViews/#/buffer!", index, Target::buffers},
    {"bufferViews/#/byteOffset", size},
    {"bufferViews/#/byteLength!", size},
    {"bufferViews/#/byteStride", code},
    {"bufferViews/#/extras", any, kNone, Capture::none, true},

    {"accessors/#/bufferView", index, Target::buffer_views},
    {"accessors/#/byteOffset", size},
    {"accessors/#/componentType!", code},
    {"accessors/#/normalized", boolean},
    {"accessors/#/count!", size},
    {"accessors/#/type!", string},
    {"accessors/#/sparse/count!", code},
    {"accessors/#/sparse/indices!", object},
    {"accessors/#/sparse/indices/bufferView!", index, Target::buffer_views},
    {"accessors/#/sparse/indices/byteOffset", code},
    {"accessors/#/sparse/indices/componentType!", code},
    {"accessors/#/sparse/values!", object},
    {"accessors/#/sparse/values/bufferView!", index, Target::buffer_views},
    {"accessors/#/sparse/values/byteOffset", code},
    {"accessors/#/min", any, kNone, Capture::none, true},
    {"accessors/#/max", any, kNone, Capture::none, true},
    {"accessors/#/extras", any, kNone, Capture::none, true},

    {"meshes/#/name", string},
    {"meshes/#/weights/#", number},
    {"meshes/#/extras", any, kNone, Capture::none, true},
    {"meshes/#/primitives!", array},
    {"meshes/#/primitives/#", object, kNone, Capture::primitive},
    {"meshes/#/primitives/#/attributes!", object},
    {"meshes/#/primitives/#/attributes/*", index, Target::accessors},
    {"meshes/#/primitives/#/indices", index, Target::accessors},
    {"meshes/#/primitives/#/material", index, Target::materials},
    {"meshes/#/primitives/#/mode", code},
    {"meshes/#/primitives/#/targets/#/*", index, Target::accessors},
    {"meshes/#/primitives/#/extras", any, kNone, Capture::none, true},

    {"nodes/#/name", string},
    {"nodes/#/mesh", index, Target::meshes},
    {"nodes/#/skin", index, Target::skins},
    {"nodes/#/camera", index, Target::cameras},
    {"nodes/#/children/#", index, Target::nodes},
    {"nodes/#/matrix/#", number},
    {"nodes/#/translation/#", number},
    {"nodes/#/rotation/#", number},
    {"nodes/#/scale/#", number},
    {"nodes/#/weights/#", number},
    {"nodes/#/extensions/KHR_lights_punctual/light!", index, Target::lights},
    {"nodes/#/extras", any, kNone, Capture::none, true},

    {"skins/#/joints!", array},
    {"skins/#/joints/#", index, Target::nodes},
    {"skins/#/inverseBindMatrices", index, Target::accessors},
    {"skins/#/skeleton", index, Target::nodes},
    {"skins/#/extras", any, kNone, Capture::none, true},

    {"cameras/#/name", string},
    {"cameras/#/type!", string},
    {"cameras/#/perspective/yfov!", number},
    {"cameras/#/perspective/znear!", number},
    {"cameras/#/perspective/zfar", number},
    {"cameras/#/perspective/aspectRatio", number},
    {"cameras/#/orthographic/xmag!", number},
    {"cameras/#/orthographic/ymag!", number},
    {"cameras/#/orthographic/znear!", number},
    {"cameras/#/orthographic/zfar!", number},
    {"cameras/#/extras", any, kNone, Capture::none, true},

    {"textures/#/source", index, Target::images},
    {"textures/#/sampler", index, Target::samplers},
    {"textures/#/extras", any, kNone, Capture::none, true},
    {"samplers/#/magFilter", code},
    {"samplers/#/minFilter", code},
    {"samplers/#/wrapS", code},
    {"samplers/#/wrapT", code},
    {"samplers/#/extras", any, kNone, Capture::none, true},

    {"materials/#/name", string},
    {"materials/#/emissiveFactor/#", number},
    {"materials/#/alphaMode", string},
    {"materials/#/alphaCutoff", number},
    {"materials/#/doubleSided", boolean},
    {"materials/#/pbrMetallicRoughness/baseColorFactor/#", number},
    {"materials/#/pbrMetallicRoughness/metallicFactor", number},
    {"materials/#/pbrMetallicRoughness/roughnessFactor", number},
    {"materials/#/extensions/KHR_materials_emissive_strength/emissiveStrength", number},

    {"extensions/KHR_lights_punctual/lights!", array},
    {"extensions/KHR_lights_punctual/lights/#/type!", string},
    {"extensions/KHR_lights_punctual/lights/#/name", string},
    {"extensions/KHR_lights_punctual/lights/#/color/#", number},
    {"extensions/KHR_lights_punctual/lights/#/intensity", number},
    {"extensions/KHR_lights_punctual/lights/#/range", number},
    {"extensions/KHR_lights_punctual/lights/#/spot/innerConeAngle", number},
    {"extensions/KHR_lights_punctual/lights/#/spot/outerConeAngle", number},
    {"extensions/KHR_lights_punctual/lights/#/extras", any, kNone, Capture::none, true},
};

// Below each place of a texture in a material.
constexpr std::string_view kTexturePlaces[] = {"materials/#/pbrMetallicRoughness/baseColorTexture",
                                               "materials/#/pbrMetallicRoughness/metallicRoughnessTexture", "materials/#/normalTexture",
                                               "materials/#/occlusionTexture", "materials/#/emissiveTexture"};
constexpr Row kTextureRows[] = {
    {"index!", index, Target::textures},
    {"texCoord", code},
    {"scale", number},
    {"strength", number},
    {"extensions/KHR_texture_transform/offset/#", number},
    {"extensions/KHR_texture_transform/rotation", number},
    {"extensions/KHR_texture_transform/scale/#", number},
    {"extensions/KHR_texture_transform/texCoord", code},
    {"extras", any, kNone, Capture::none, true},
};

constexpr std::pair<std::string_view, Target> kCounted[] = {
    {"accessors", Target::accessors}, {"buffers", Target::buffers}, {"bufferViews", Target::buffer_views},
    {"cameras", Target::cameras},     {"images", Target::images},   {"extensions/KHR_lights_punctual/lights", Target::lights},
    {"materials", Target::materials}, {"meshes", Target::meshes},   {"nodes", Target::nodes},
    {"samplers", Target::samplers},   {"scenes", Target::scenes},   {"skins", Target::skins},
    {"textures", Target::textures}};

class Schema {
public:
    Schema() {
        nodes_.emplace_back().rule = object;
        for (const Row& row : kRows) apply(row, make(nodes_.front(), row.path));
        for (const std::string_view place : kTexturePlaces)
            for (const Row& row : kTextureRows) apply(row, make(make(nodes_.front(), place), row.path));
        for (const auto& [path, target] : kCounted) make(nodes_.front(), path).counted_as = static_cast<int>(target);
        for (SchemaNode& node : nodes_)
            for (std::size_t i = 0; i < node.members.size(); ++i)
                if (node.members[i].second->required) node.required_mask |= 1u << i;
    }
    [[nodiscard]] const SchemaNode& root() const { return nodes_.front(); }

private:
    static void apply(const Row& row, SchemaNode& node) {
        if (row.rule != any) node.rule = row.rule;
        node.target = row.target;
        node.capture = row.capture;
        node.dropped = row.dropped;
        node.required = row.path.back() == '!';
    }

    SchemaNode& make(SchemaNode& from, std::string_view path) {
        SchemaNode* node = &from;
        if (path.back() == '!') path.remove_suffix(1);
        while (!path.empty()) {
            const std::size_t slash = path.find('/');
            const std::string_view key = path.substr(0, slash);
            path = slash == std::string_view::npos ? std::string_view{} : path.substr(slash + 1);
            node->rule = key == "#" ? array : object;
            node = key == "#" || key == "*" ? &child(node->every) : &member(*node, key);
        }
        return *node;
    }
    SchemaNode& child(const SchemaNode*& every) {
        if (every == nullptr) every = &nodes_.emplace_back();
        return const_cast<SchemaNode&>(*every);  // all nodes are ours, in nodes_
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
    static constexpr const char* kNames[kTargetCount] = {"accessors", "buffers", "bufferViews", "cameras", "images", "lights",  "materials",
                                                         "meshes",    "nodes",   "samplers",    "scenes",  "skins",  "textures"};
    return kNames[static_cast<int>(target)];
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
