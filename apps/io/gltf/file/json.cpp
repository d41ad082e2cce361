#include "apps/io/gltf/file/json.hpp"

#include "apps/io/files/text.hpp"
#include "apps/io/gltf/file/filler.hpp"
#include "apps/io/gltf/file/indices.hpp"
#include "apps/io/gltf/file/schema.hpp"
#include "apps/io/gltf/file/versions.hpp"
#include "apps/io/gltf/text/json_place.hpp"
#include "sh/time_limit.hpp"
#include "shading/model/numbers.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>
#include <utility>

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

class GltfVisitor final : public JsonVisitor {
public:
    GltfVisitor(file::File& file, Notes& notes, Budget& memory, bool strict)
        : file_(file), filler_(file, notes, memory), memory_(memory), strict_(strict) {}

    void on_key(const JsonValue& key) override {
        Level& top = levels_.back();
        top.next = top.node == nullptr ? nullptr : top.node->every;
        top.next_kind = top.kind == Kind::extras || key.text == "extras" ? Kind::extras
                        : key.text == "extensions"                       ? Kind::extensions
                                                                         : Kind::plain;
        if (top.kind == Kind::extensions) note_extension(key);
        if (top.next != nullptr) filler_.key = filler_.keep(key);
        if (top.node != nullptr && !top.node->members.empty()) {
            const int at = top.node->find(key.text);
            if (at < 0 && top.node->closed) filler_.fault(key.offset, unknown_key(*top.node));
            top.next = at < 0 ? nullptr : top.node->members[static_cast<std::size_t>(at)].second;
            if (at >= 0) top.seen |= 1u << at;
        }
    }

    void on_begin(JsonType type, std::size_t offset) override {
        const Kind kind = levels_.empty() ? Kind::plain : levels_.back().next_kind;
        const SchemaNode* node = take({.type = type, .offset = offset});
        const Kind inner = kind == Kind::extras ? Kind::extras : Kind::plain;
        levels_.push_back({node, node != nullptr ? node->every : nullptr, 0, kind, inner, 0, {.type = type, .offset = offset}});
    }

    void on_end(std::size_t) override {
        const Level top = levels_.back();
        levels_.pop_back();
        if (top.node != nullptr) end(*top.node, top);
        if (levels_.size() == owner_depth_) filler_.owner = {};
    }

    void on_value(const JsonValue& value, std::size_t) override {
        take(value);
        if (levels_.size() == owner_depth_) filler_.owner = {};
    }

    void on_twin(std::string_view key, std::size_t first, std::size_t next, std::size_t again) override {
        if (strict_) JsonVisitor::on_twin(key, first, next, again);
        memory_.take(2 * sizeof(Twin));
        filler_.notes.twins.push_back({first, next, again});
    }

    void on_loose(const JsonFault& fault) override {
        if (strict_) JsonVisitor::on_loose(fault);
        if (loose_++ == 0) first_loose_ = fault;
    }

    /// Called after the scan.
    void warn_of_loose() {
        if (loose_ == 0) return;
        filler_.owner = {};
        const std::string more = loose_ > 1 ? fmt::format(" (and {} more such places)", loose_ - 1) : "";
        filler_.warn(first_loose_.offset, first_loose_.what + more, "which is no JSON, read as it is meant");
    }

    /// Called after the scan, when the lengths of all arrays are known. Afterwards no member of the file has an index that is out of range,
    /// whether its fault was refused, noted or ignored.
    void check_indices() {
        for (const Index& index : indices_) {
            const std::size_t count = count_of(index.target, file_);
            if (index.value < count) continue;
            std::string what = fmt::format("index {}, but the file has {} {}", index.value, count, name_of(index.target));
            filler_.owner = index.owner;
            if (index.mild) {
                filler_.warn(index.offset, std::move(what), "ignored");
                continue;
            }
            if (!strict_ && index.owner.target == Target::none) {
                filler_.warn(index.offset, std::move(what), "ignored");
                continue;
            }
            if (strict_ && (index.owner.target == Target::none || (index.owner.target == Target::nodes && index.target == Target::nodes)))
                throw JsonFault{ErrorCode::bad_input, index.offset, std::move(what)};  // the graph of the nodes is walked as a whole
            filler_.fault(index.offset, std::move(what));
        }
        TimeCheck check;
        for_each_index(file_, [&](Target target, int& index) {
            check();
            if (index >= 0 && static_cast<std::size_t>(index) >= count_of(target, file_)) index = kBadIndex;
        });
    }

    /// Called after the scan: extensions that the file uses and does not list.
    void check_extensions() {
        filler_.owner = {};
        for (const auto& [name, offset] : extensions_)
            if (!file_.uses(name))
                filler_.warn(offset, "is not in extensionsUsed", is_supported(name) ? "read as if it were" : "and not supported: ignored");
    }

private:
    enum class Kind : std::uint8_t { plain, extensions, extras };
    struct Level {
        const SchemaNode* node;
        const SchemaNode* next;  // schema of the next value
        std::uint32_t seen;
        Kind kind, next_kind;
        std::size_t count;
        JsonValue value;  // its type and offset
    };
    struct Index {
        Target target;
        bool mild;
        std::uint32_t value;
        Owner owner;
        std::size_t offset;
    };

    /// Takes a value, or the start of an object or array: checks its type, and stores it. Null: no schema, or a value of another type.
    const SchemaNode* take(const JsonValue& value) {
        if (levels_.empty()) {
            if (value.type != JsonType::object)
                throw JsonFault{ErrorCode::bad_input, value.offset, fmt::format("expected an object, found {}", name_of(value.type))};
            return &gltf_schema();
        }
        Level& top = levels_.back();
        filler_.component = top.count++;
        const SchemaNode* node = top.next;
        if (node == nullptr) return nullptr;
        const bool element = node->rule == Rule::object && node->target != Target::none;
        if (element) {
            filler_.owner = {node->target, static_cast<std::uint32_t>(top.count - 1)};
            owner_depth_ = levels_.size();
        }
        if (node->rule == Rule::number && value.type == JsonType::number && !shading::finite(value.number)) {
            // It has been warned of, and has its default.
            const bool in_list = top.value.type == JsonType::array && top.node != nullptr && top.node->length == 0;
            JsonValue zero = value;
            zero.number = 0;
            if (in_list && node->put != nullptr) call(node->put, zero);
            return nullptr;
        }
        // Attributes have free names. Those that are not read may be anything.
        const bool good = check(*node, value, node->mild || (node->reads != nullptr && !node->reads(filler_.key)));
        // An element that is no object counts as one, so that those after it keep their numbers.
        if ((good || element) && node->put != nullptr) put(*node, value);
        if (!good && node->rule == Rule::index && node->put != nullptr && value.type != JsonType::null) {
            JsonValue bad = value;
            bad.number = kBadIndex;
            call(node->put, bad);
        }
        return good ? node : nullptr;
    }

    void put(const SchemaNode& node, const JsonValue& value) {
        if (!node.ranged || node.range.holds(value.number)) return call(node.put, value);
        const Range& range = node.range;
        if (range.instead != nullptr) return filler_.warn(value.offset, outside(range, value.number), range.instead);
        JsonValue nearest = value;
        nearest.number = value.number < range.low ? range.low : range.high;
        filler_.warn(value.offset, outside(range, value.number), fmt::format("drawn as {}", nearest.number));
        call(node.put, nearest);
    }

    static std::string outside(const Range& range, double value) {
        if (range.codes != nullptr) {
            std::string codes;
            for (const int* code = range.codes; *code >= 0; ++code) codes += fmt::format("{}{}", codes.empty() ? "" : ", ", *code);
            return fmt::format("expected one of {}, found {}", codes, value);
        }
        if (range.high == std::numeric_limits<double>::infinity())
            return fmt::format("expected {} {}, found {}", range.low_open ? "more than" : "at least", range.low, value);
        return fmt::format("{} is not in {}{:.6g}, {:.6g}{}", value, range.low_open ? '(' : '[', range.low, range.high,
                           range.high_open ? ')' : ']');
    }

    void call(Action action, const JsonValue& value) {
        try {
            action(filler_, value);
        } catch (const JsonFault& found) {
            if (found.code != ErrorCode::bad_input) throw;
            fault(false, found.offset, found.what);
        }
    }

    void end(const SchemaNode& node, const Level& level) {
        if (const std::uint32_t missing = node.required_mask & ~level.seen; missing != 0 && level.value.type == JsonType::object) {
            const auto which = static_cast<std::size_t>(std::countr_zero(missing));
            fault(node.mild, level.value.offset, fmt::format("expected the key \"{}\", which is not there", node.members[which].first));
        }
        if (node.length > 0 && level.count != node.length)
            fault(node.mild, level.value.offset, fmt::format("expected {} numbers, found {}", node.length, level.count));
        if (node.end != nullptr) call(node.end, level.value);
    }

    static std::string unknown_key(const SchemaNode& node) {
        std::string known;
        for (const auto& [name, member] : node.members) known += fmt::format("{}{}", known.empty() ? "" : ", ", name);
        return fmt::format("unknown key; known here: {}", known);
    }

    void note_extension(const JsonValue& key) {
        constexpr std::size_t kMost = 32;  // different names; a file has few
        for (const auto& [name, offset] : extensions_)
            if (name == key.text) return;
        if (extensions_.size() < kMost) extensions_.emplace_back(filler_.keep(key), key.offset);
    }

    /// Faults of the file itself end the reading by the strict rules; those of an element are noted.
    void fault(bool mild, std::size_t offset, std::string what) {
        if (mild || (!strict_ && filler_.owner.target == Target::none)) return filler_.warn(offset, std::move(what), "ignored");
        if (filler_.owner.target == Target::none) throw JsonFault{ErrorCode::bad_input, offset, std::move(what)};
        filler_.fault(offset, std::move(what));
    }

    /// Notes a fault and returns false if a value is not of the schema's type.
    bool check(const SchemaNode& node, const JsonValue& value, bool mild) {
        const bool numeric = value.type == JsonType::integer || value.type == JsonType::number;
        if (!strict_ && value.type == JsonType::null && node.rule != Rule::any && node.rule != Rule::open) {
            filler_.warn(value.offset, fmt::format("expected {}, found null", expected_by(node.rule)), "read as if it were not there");
            return false;
        }
        double limit = 9007199254740992.0;  // 2^53
        bool good = true;
        switch (node.rule) {
            case Rule::any:
            case Rule::open:
                return true;
            case Rule::object:
                good = value.type == JsonType::object;
                break;
            case Rule::array:
                good = value.type == JsonType::array;
                file_.has_dictionaries |= value.type == JsonType::object && levels_.size() == 1;
                break;
            case Rule::string:
                good = value.type == JsonType::string;
                break;
            case Rule::boolean:
                good = value.type == JsonType::boolean;
                break;
            case Rule::number:
                good = numeric;
                break;
            case Rule::code:
            case Rule::index:
                limit = 2147483647.0;
                [[fallthrough]];
            case Rule::size:
                good = numeric && value.number == std::trunc(value.number);  // 10.0 is an integer in JSON Schema
                if (!good) break;
                if (!value.exact || !(value.number >= 0 && value.number <= limit)) {
                    fault(mild, value.offset,
                          !value.exact ? "expected an integer of at most 2^53 in size"
                                       : fmt::format("expected an integer from 0 to {:.0f}, found {:.0f}", limit, value.number));
                    return false;
                }
                if (node.rule == Rule::index)
                    indices_.push_back({node.target, mild, static_cast<std::uint32_t>(value.number), filler_.owner, value.offset});
                return true;
        }
        if (!good) fault(mild, value.offset, fmt::format("expected {}, found {}", expected_by(node.rule), name_of(value.type)));
        return good;
    }

    file::File& file_;
    GltfFiller filler_;
    Budget& memory_;
    bool strict_;
    std::vector<Level> levels_;
    std::vector<Index> indices_;
    JsonFault first_loose_;
    std::size_t loose_ = 0;
    std::vector<std::pair<std::string_view, std::size_t>> extensions_;  // names that are used, with the offset of the first use
    std::size_t owner_depth_ = 0;                                       // levels around the element that is being read
};

}  // namespace

LoadFailure failure_at(std::string_view text, const JsonScanLimits& limits, std::size_t offset, std::string_view what, ErrorCode code) {
    const std::string path = printable(json_path_at(text, offset, limits), 120);
    return {{code, fmt::format("{}{}{}: {}", path, path.empty() ? "" : ": ", named_place(text, offset), what)}};
}

std::string_view trimmed(std::string_view text, std::vector<std::string>& warnings, bool strict) {
    if (text.substr(0, 3) == "\xEF\xBB\xBF") {
        constexpr const char* kMark = "the JSON text begins with a byte order mark, which glTF forbids";
        if (strict) refuse("", kMark);
        text.remove_prefix(3);
        warnings.push_back(kMark);
    }
    while (!text.empty() && text.back() == '\0') text.remove_suffix(1);  // chunk padding of old exporters
    return text;
}

file::File read_gltf_json(std::string_view text, const JsonScanLimits& limits, Budget memory, Notes& notes, bool strict) {
    file::File file;
    try {
        GltfVisitor visitor(file, notes, memory, strict);
        scan_json(text, limits, visitor);
        if (!notes.twins.empty()) return file;
        visitor.warn_of_loose();
        check_versions(file, strict);
        visitor.check_indices();
        visitor.check_extensions();
    } catch (const JsonFault& found) {
        throw failure_at(text, limits, found.offset, found.what, found.code);
    }
    return file;
}

}  // namespace halflit::io::detail
