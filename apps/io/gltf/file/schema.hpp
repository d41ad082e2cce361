// The parts of the glTF 2.0 schema that this loader reads, as a tree over keys. It gives each value's type, the array that an index refers
// to, and the place of each value in a file::File.
#pragma once

#include "apps/io/gltf/file/target.hpp"
#include "apps/io/gltf/text/json_scan.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

namespace halflit::io::detail {

class GltfFiller;

enum class Rule : std::uint8_t {
    any,
    open,  ///< any; the members of an object are followed
    object,
    array,
    string,
    boolean,
    number,  ///< integer or not
    size,    ///< integer in [0, 2^53]
    code,    ///< integer in [0, 2^31)
    index    ///< integer in [0, length of the target array)
};

/// Takes a value, or the start or the end of an object or array. For these, `value` holds only type and offset.
using Action = void (*)(GltfFiller& filler, const JsonValue& value);

/// Values that a number may have. One outside is warned of, with what is done instead.
struct Range {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    bool low_open = false, high_open = false;
    const int* codes = nullptr;     ///< the values that are allowed, ended by -1; null: all of the interval
    const char* instead = nullptr;  ///< the value is not stored, and this is said; null: the nearest end of the interval is stored

    [[nodiscard]] bool holds(double value) const;
};

/// True for the names of members that are read.
using Reads = bool (*)(std::string_view name);

struct SchemaNode {
    Rule rule = Rule::any;
    Target target = Target::none;
    bool required = false;  ///< within its parent object
    bool closed = false;    ///< an object that refuses keys outside `members`
    bool mild = false;      ///< nothing that is drawn depends on it: a wrong type or index is warned of
    Reads reads = nullptr;  ///< of a member with a free name: which names are read. A fault in any other is mild. Null: all are
    bool ranged = false;    ///< `range` restricts the value
    Range range;
    std::size_t length = 0;  ///< elements of an array; 0: any number
    Action put = nullptr, end = nullptr;
    std::uint32_t required_mask = 0;    ///< bit i: members[i] is required
    const SchemaNode* every = nullptr;  ///< schema of each element, or of each member with a free name
    std::vector<std::pair<std::string_view, const SchemaNode*>> members;

    [[nodiscard]] int find(std::string_view key) const;  ///< position in members, or -1
};

/// One line of the table from which the tree is made.
struct SchemaRow {
    std::string_view path;  ///< '/' between keys; '#': each element of an array; '*': each member of an object; "!" at the end: required
    Rule rule;
    Action put = nullptr;
    Target target = Target::none;  ///< of an index: what it refers to; of an object: the array whose element it is
    Action end = nullptr;
    std::size_t length = 0;
    bool closed = false;
    bool mild = false;
    Reads reads = nullptr;
    bool ranged = false;
    Range range{};
};

[[nodiscard]] const SchemaNode& gltf_schema();  ///< the root; made once

}  // namespace halflit::io::detail
