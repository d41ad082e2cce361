#include "tests/support/schema_files.hpp"

#include "apps/io/gltf/file/schema.hpp"
#include "apps/io/gltf/file/schema_rows.hpp"

#include <string_view>

namespace halflit::test {

using io::detail::Rule;
using io::detail::SchemaNode;
using io::detail::SchemaRow;
using Json = nlohmann::json;

namespace {

std::vector<std::string> keys_of(std::string path) {
    std::vector<std::string> keys;
    for (std::size_t slash; !path.empty(); path = slash == std::string::npos ? "" : path.substr(slash + 1)) {
        slash = path.find('/');
        keys.push_back(path.substr(0, slash));
    }
    return keys;
}

/// A value that a required member may have.
Json sound(const SchemaNode& node) {
    switch (node.rule) {
        case Rule::array:
            return Json::array();
        case Rule::string:
            return "";
        case Rule::boolean:
            return true;
        case Rule::number:
            return 1.0;
        case Rule::size:
        case Rule::code:
        case Rule::index:
            return 0;
        default:
            return Json::object();
    }
}

void add_rows(const std::string& start, std::span<const SchemaRow> rows, std::vector<IndexRow>& out) {
    constexpr std::string_view kNames[] = {"POSITION", "TEXCOORD_0", "JOINTS_0", "TRANSLATION", "ROTATION", "SCALE", "_AGE"};
    for (const SchemaRow& row : rows) {
        if (row.rule != Rule::index) continue;
        std::string path = start + std::string(row.path);
        if (path.back() == '!') path.pop_back();
        std::vector<std::string> paths{path};
        if (path.back() == '*') {
            paths.clear();
            for (const std::string_view name : kNames) paths.push_back(path.substr(0, path.size() - 1) + std::string(name));
        }
        for (const std::string& each : paths) {
            std::string place;
            for (const std::string& key : keys_of(each)) place += key == "#" ? "[0]" : (place.empty() ? "" : ".") + key;
            out.push_back({each, place, row.put != nullptr});
        }
    }
}

}  // namespace

std::vector<IndexRow> index_rows() {
    std::vector<IndexRow> out;
    add_rows("", io::detail::schema_rows(), out);
    for (const SchemaRow& place : io::detail::texture_place_rows())
        add_rows(std::string(place.path) + "/", io::detail::texture_rows(), out);
    return out;
}

Json scene_of_all_arrays() {
    Json scene = Json::parse(R"({
        "asset": {"version": "2.0"}, "scene": 0,
        "scenes": [{"nodes": [0, 1]}, {}, {}],
        "nodes": [{"mesh": 0, "camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}, {"mesh": 0, "skin": 0}, {}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}, "material": 0,
                                    "targets": [{"POSITION": 0}]}], "weights": [0.5]},
                   {"primitives": [{"attributes": {}}]}, {"primitives": [{"attributes": {}}]}],
        "skins": [{"joints": [0]}, {"joints": [0]}, {"joints": [0]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}},
                    {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}},
                    {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}, {}, {}],
        "textures": [{"source": 0, "sampler": 0}, {}, {}],
        "samplers": [{}, {}, {}],
        "images": [{}, {}, {}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5121, "count": 3, "type": "VEC4"},
                      {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC4"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteLength": 12}, {"buffer": 0, "byteLength": 48}],
        "buffers": [{"byteLength": 48, "uri": "data:;base64,AACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAA"},
                    {"byteLength": 1, "uri": "data:;base64,AA=="}, {"byteLength": 1, "uri": "data:;base64,AA=="}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                        "samplers": [{"input": 0, "output": 0}]}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}, {"type": "point"}, {"type": "point"}]},
                       "KHR_materials_variants": {"variants": [{"name": "a"}]}}
    })");
    scene["images"][0]["uri"] =  // one texel
        "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR4nGNgYGBgAAAABQABpfZFQAAAAABJRU5ErkJggg==";
    return scene;
}

void put(Json& scene, const IndexRow& row, const Json& value) {
    Json* at = &scene;
    const SchemaNode* node = &io::detail::gltf_schema();
    for (const std::string& key : keys_of(row.path)) {
        if (key == "#") {
            if (!at->is_array()) *at = Json::array();
            if (at->empty()) at->push_back(nullptr);
            at = &(*at)[0];
            node = node->every;
        } else {
            if (!at->is_object()) *at = Json::object();
            const int member = node->find(key);
            const SchemaNode* next = member < 0 ? node->every : node->members[static_cast<std::size_t>(member)].second;
            for (const auto& [name, beside] : node->members)
                if (beside->required && !at->contains(name)) (*at)[std::string(name)] = sound(*beside);
            at = &(*at)[key];
            node = next;
        }
    }
    *at = value;
    for (const std::string& key : keys_of(row.path))
        if (key.starts_with("KHR_") || key.starts_with("EXT_")) scene["extensionsUsed"] = Json::array({key});
}

}  // namespace halflit::test
