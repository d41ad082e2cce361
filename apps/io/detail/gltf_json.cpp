#include "apps/io/detail/gltf_json.hpp"

#include "apps/io/detail/gltf_filler.hpp"
#include "apps/io/detail/gltf_schema.hpp"
#include "apps/io/detail/gltf_versions.hpp"
#include "apps/io/detail/json_place.hpp"
#include "apps/io/text.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>

namespace halflit::io::detail {

namespace {

const char* expected_by(Rule rule) {
    switch (rule) {
        case Rule::object:
            return "an object";
        case Rule::array:
            return "an array";
        case Rule::string:
            return "a string";
        case Rule::boolean:
            return "true or false";
        case Rule::number:
            return "a number";
        default:
            return "an integer";
    }
}

[[noreturn]] void fault(std::size_t offset, std::string what) { throw JsonFault{ErrorCode::bad_input, offset, std::move(what)}; }

class GltfVisitor final : public JsonVisitor {
public:
    GltfVisitor(file::File& file, Budget& memory) : file_(file), filler_(file, memory) {}

    void on_key(const JsonValue& key) override {
        Level& top = levels_.back();
        top.next = top.node == nullptr ? nullptr : top.node->every;
        if (top.next != nullptr) filler_.key = filler_.keep(key);
        if (top.node != nullptr && !top.node->members.empty()) {
            const int at = top.node->find(key.text);
            if (at < 0 && top.node->closed) refuse_key(*top.node, key);
            top.next = at < 0 ? nullptr : top.node->members[static_cast<std::size_t>(at)].second;
            if (at >= 0) top.seen |= 1u << at;
        }
    }

    void on_begin(JsonType type, std::size_t offset) override {
        const SchemaNode* node = enter();
        const JsonValue value{.type = type, .offset = offset};
        if (node != nullptr) {
            check(*node, value);
            if (node->put != nullptr) node->put(filler_, value);
        }
        levels_.push_back({node, node != nullptr ? node->every : nullptr, 0, 0, value});
    }

    void on_end(std::size_t) override {
        const Level top = levels_.back();
        levels_.pop_back();
        if (top.node == nullptr) return;
        if (const std::uint32_t missing = top.node->required_mask & ~top.seen; missing != 0 && top.value.type == JsonType::object) {
            const auto which = static_cast<std::size_t>(std::countr_zero(missing));
            fault(top.value.offset, fmt::format("expected the key \"{}\", which is not there", top.node->members[which].first));
        }
        if (top.node->length > 0 && top.count != top.node->length)
            fault(top.value.offset, fmt::format("expected {} numbers, found {}", top.node->length, top.count));
        if (top.node->end != nullptr) top.node->end(filler_, top.value);
    }

    void on_value(const JsonValue& value, std::size_t) override {
        const SchemaNode* node = enter();
        if (node == nullptr) return;
        check(*node, value);
        if (node->put != nullptr) node->put(filler_, value);
    }

    /// Called after the scan, when the lengths of all arrays are known.
    void check_indices() const {
        for (const Index& index : indices_) {
            const std::size_t count = count_of(index.target, file_);
            if (index.value >= count)
                fault(index.offset, fmt::format("index {}, but the file has {} {}", index.value, count, name_of(index.target)));
        }
    }

private:
    struct Level {
        const SchemaNode* node;
        const SchemaNode* next;  // schema of the next value
        std::uint32_t seen;
        std::size_t count;
        JsonValue value;  // its type and offset
    };
    struct Index {
        Target target;
        std::uint32_t value;
        std::size_t offset;
    };

    const SchemaNode* enter() {
        if (levels_.empty()) return &gltf_schema();
        ++levels_.back().count;
        return levels_.back().next;
    }

    [[noreturn]] static void refuse_key(const SchemaNode& node, const JsonValue& key) {
        std::string known;
        for (const auto& [name, member] : node.members) known += fmt::format("{}{}", known.empty() ? "" : ", ", name);
        fault(key.offset, fmt::format("unknown key; known here: {}", known));
    }

    void check(const SchemaNode& node, const JsonValue& value) {
        const bool numeric = value.type == JsonType::integer || value.type == JsonType::number;
        double limit = 9007199254740992.0;  // 2^53
        switch (node.rule) {
            case Rule::any:
            case Rule::open:
                return;
            case Rule::object:
                if (value.type == JsonType::object) return;
                break;
            case Rule::array:
                if (value.type == JsonType::array) return;
                break;
            case Rule::string:
                if (value.type == JsonType::string) return;
                break;
            case Rule::boolean:
                if (value.type == JsonType::boolean) return;
                break;
            case Rule::number:
                if (numeric) return;
                break;
            case Rule::code:
            case Rule::index:
                limit = 2147483647.0;
                [[fallthrough]];
            case Rule::size:
                if (!numeric || value.number != std::trunc(value.number)) break;  // 10.0 is an integer in JSON Schema
                if (!value.exact) fault(value.offset, "expected an integer of at most 2^53 in size");
                if (!(value.number >= 0 && value.number <= limit))
                    fault(value.offset, fmt::format("expected an integer from 0 to {:.0f}, found {:.0f}", limit, value.number));
                if (node.rule == Rule::index) indices_.push_back({node.target, static_cast<std::uint32_t>(value.number), value.offset});
                return;
        }
        fault(value.offset, fmt::format("expected {}, found {}", expected_by(node.rule), name_of(value.type)));
    }

    file::File& file_;
    GltfFiller filler_;
    std::vector<Level> levels_;
    std::vector<Index> indices_;
};

}  // namespace

file::File read_gltf_json(std::string_view text, const JsonScanLimits& limits, Budget memory, std::vector<std::string>& warnings) {
    if (text.substr(0, 3) == "\xEF\xBB\xBF") {
        text.remove_prefix(3);
        warnings.push_back("the JSON text begins with a byte order mark, which glTF forbids");
    }
    while (!text.empty() && text.back() == '\0') text.remove_suffix(1);  // chunk padding of old exporters
    file::File file;
    try {
        GltfVisitor visitor(file, memory);
        scan_json(text, limits, visitor);
        check_versions(file);
        visitor.check_indices();
    } catch (const JsonFault& found) {
        const TextPlace place = place_of(text, found.offset);
        refuse(printable(json_path_at(text, found.offset, limits), 120),
               fmt::format("line {}, column {}: {}", place.line, place.column, found.what), found.code);
    }
    return file;
}

}  // namespace halflit::io::detail
