// The parts of the glTF 2.0 schema that this loader reads, as a tree over keys: what type a value must have, which numbers are
// references and to what. tinygltf skips values of a wrong type and cuts integers to 32 bits; with this check neither can happen.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace halflit::io::detail {

/// Arrays that other parts refer to by index.
enum class Target : std::uint8_t {
    accessors,
    buffers,
    buffer_views,
    cameras,
    images,
    lights,
    materials,
    meshes,
    nodes,
    samplers,
    scenes,
    skins,
    textures
};
inline constexpr int kTargetCount = 13;

[[nodiscard]] const char* name_of(Target target);  ///< "accessors"

enum class Rule : std::uint8_t {
    any,
    object,
    array,
    string,
    boolean,
    number,  ///< integer or not
    size,    ///< integer in [0, 2^53]
    code,    ///< integer in [0, 2^31)
    index    ///< integer in [0, length of the target array)
};

/// A value whose text is wanted besides the check.
enum class Capture : std::uint8_t {
    none,
    version,
    min_version,
    extension_used,
    extension_required,
    buffer,
    buffer_uri,
    buffer_length,
    image,
    image_uri,
    image_view,
    animation,
    primitive
};

struct SchemaNode {
    Rule rule = Rule::any;
    Target target{};
    Capture capture = Capture::none;
    bool required = false;              ///< within its parent object
    bool dropped = false;               ///< tinygltf does not get to see the value
    int counted_as = -1;                ///< an array: its length is that of this Target
    std::uint32_t required_mask = 0;    ///< of the children, by position
    const SchemaNode* every = nullptr;  ///< for each element, or each member with a free name
    std::vector<std::pair<std::string_view, const SchemaNode*>> members;

    [[nodiscard]] int find(std::string_view key) const;  ///< position in members, or -1
};

[[nodiscard]] const SchemaNode& gltf_schema();  ///< the root; made once

}  // namespace halflit::io::detail
