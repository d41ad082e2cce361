#include "apps/io/detail/gltf_precheck.hpp"

#include "apps/io/detail/gltf_versions.hpp"
#include "apps/io/detail/json_place.hpp"
#include "apps/io/text.hpp"
#include "apps/io/detail/tinygltf.hpp"

#include <fmt/format.h>

#include <algorithm>

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
    GltfVisitor(Precheck& out, std::string_view text) : out_(out), text_(text) {}

    void on_key(std::string_view key, std::size_t) override {
        Level& top = levels_.back();
        top.next = top.node == nullptr ? nullptr : top.node->every;
        if (top.node != nullptr && !top.node->members.empty()) {
            const int at = top.node->find(key);
            top.next = at < 0 ? nullptr : top.node->members[static_cast<std::size_t>(at)].second;
            if (at >= 0) top.seen |= 1u << at;
        }
        top.in_extras = top.extras || key == "extras";
    }

    void on_begin(JsonType type, std::size_t offset) override {
        const SchemaNode* node = enter();
        const bool extras = !levels_.empty() && levels_.back().in_extras;
        if (node != nullptr) {
            require(*node, type == JsonType::object ? Rule::object : Rule::array, type, offset);
            capture_begin(*node);
            if (node->dropped) drop_from_ = drop_depth_ == 0 ? offset : drop_from_;
        }
        if (drop_depth_ > 0 || (node != nullptr && node->dropped)) ++drop_depth_;
        levels_.push_back({node, node != nullptr ? node->every : nullptr, 0, 0, extras, extras, offset});
    }

    void on_end(std::size_t end_offset) override {
        const Level top = levels_.back();
        levels_.pop_back();
        if (top.node != nullptr) {
            if (const std::uint32_t missing = top.node->required_mask & ~top.seen; missing != 0) {
                const auto which = static_cast<std::size_t>(__builtin_ctz(missing));
                throw JsonFault{ErrorCode::bad_input, top.offset,
                                fmt::format("expected the key \"{}\", which is not there", top.node->members[which].first)};
            }
            if (top.node->counted_as >= 0) out_.counts[static_cast<std::size_t>(top.node->counted_as)] = top.count;
        }
        if (drop_depth_ > 0 && --drop_depth_ == 0) drops_.push_back({drop_from_, end_offset});
    }

    void on_value(const JsonValue& value, std::size_t end_offset) override {
        const bool extras = !levels_.empty() && levels_.back().in_extras;
        const SchemaNode* node = enter();
        if (!extras && !value.exact) throw JsonFault{ErrorCode::bad_input, value.offset, "expected an integer of at most 2^53 in size"};
        if (node == nullptr) return;
        check(*node, value);
        capture(*node, value);
        if (node->dropped && drop_depth_ == 0) drops_.push_back({value.offset, end_offset});
    }

    /// After the scan, when all counts are known.
    void check_indices() const {
        for (const Index& index : indices_) {
            const std::size_t count = out_.count(index.target);
            if (index.value >= count)
                throw JsonFault{ErrorCode::bad_input, index.offset,
                                fmt::format("index {}, but the file has {} {}", index.value, count, name_of(index.target))};
        }
    }

    void write_model_text() {
        out_.for_tinygltf = text_;
        for (const auto& [begin, end] : drops_) {
            std::fill(out_.for_tinygltf.begin() + static_cast<std::ptrdiff_t>(begin),
                      out_.for_tinygltf.begin() + static_cast<std::ptrdiff_t>(end), ' ');
            out_.for_tinygltf[begin] = '0';
        }
    }

    std::string version, min_version;

private:
    struct Level {
        const SchemaNode* node;
        const SchemaNode* next;  // of the coming value
        std::uint32_t seen;
        std::size_t count;
        bool extras, in_extras;  // inside "extras": this value; the coming one
        std::size_t offset;
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

    static void require(const SchemaNode& node, Rule found, JsonType type, std::size_t offset) {
        if (node.rule != Rule::any && node.rule != found)
            throw JsonFault{ErrorCode::bad_input, offset, fmt::format("expected {}, found {}", expected_by(node.rule), name_of(type))};
    }

    void check(const SchemaNode& node, const JsonValue& value) {
        const bool numeric = value.type == JsonType::integer || value.type == JsonType::number;
        double limit = 9007199254740992.0;  // 2^53
        switch (node.rule) {
            case Rule::any:
                return;
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
                if (value.type != JsonType::integer) break;
                if (!(value.number >= 0 && value.number <= limit))
                    throw JsonFault{ErrorCode::bad_input, value.offset,
                                    fmt::format("expected an integer from 0 to {:.0f}, found {:.0f}", limit, value.number)};
                if (node.rule == Rule::index) indices_.push_back({node.target, static_cast<std::uint32_t>(value.number), value.offset});
                return;
            default:
                break;
        }
        throw JsonFault{ErrorCode::bad_input, value.offset,
                        fmt::format("expected {}, found {}", expected_by(node.rule), name_of(value.type))};
    }

    std::string_view keep(const JsonValue& value) {
        return value.in_place ? value.text : std::string_view(out_.texts.emplace_back(value.text));
    }

    void capture_begin(const SchemaNode& node) {
        switch (node.capture) {
            case Capture::buffer:
                out_.buffers.emplace_back();
                break;
            case Capture::image:
                out_.images.emplace_back();
                break;
            case Capture::animation:
                ++out_.animations;
                break;
            case Capture::primitive:
                ++out_.primitives;
                break;
            default:
                break;
        }
    }

    void capture(const SchemaNode& node, const JsonValue& value) {
        switch (node.capture) {
            case Capture::version:
                version = value.text;
                break;
            case Capture::min_version:
                min_version = value.text;
                break;
            case Capture::extension_used:
                out_.extensions_used.emplace_back(value.text);
                break;
            case Capture::extension_required:
                out_.extensions_required.emplace_back(value.text);
                break;
            case Capture::buffer_uri:
                out_.buffers.back().uri = keep(value);
                out_.buffers.back().has_uri = true;
                break;
            case Capture::buffer_length:
                out_.buffers.back().byte_length = static_cast<std::uint64_t>(value.number);
                break;
            case Capture::image_uri:
                out_.images.back().uri = keep(value);
                out_.images.back().has_uri = true;
                break;
            case Capture::image_view:
                out_.images.back().buffer_view = static_cast<int>(value.number);
                break;
            default:
                break;
        }
    }

    Precheck& out_;
    std::string_view text_;
    std::vector<Level> levels_;
    std::vector<Index> indices_;
    std::vector<std::pair<std::size_t, std::size_t>> drops_;
    std::size_t drop_from_ = 0;
    int drop_depth_ = 0;
};

std::uint64_t estimated_model_bytes(const Precheck& out) {
    const auto bytes = [&](Target target, std::size_t each) { return static_cast<std::uint64_t>(out.count(target)) * each; };
    const std::uint64_t once = bytes(Target::nodes, sizeof(tinygltf::Node)) + bytes(Target::materials, sizeof(tinygltf::Material)) +
                               bytes(Target::meshes, sizeof(tinygltf::Mesh)) + out.primitives * sizeof(tinygltf::Primitive) +
                               bytes(Target::accessors, sizeof(tinygltf::Accessor)) +
                               bytes(Target::buffer_views, sizeof(tinygltf::BufferView)) +
                               bytes(Target::textures, sizeof(tinygltf::Texture)) + bytes(Target::samplers, sizeof(tinygltf::Sampler)) +
                               bytes(Target::skins, sizeof(tinygltf::Skin)) + bytes(Target::scenes, sizeof(tinygltf::Scene)) +
                               bytes(Target::cameras, sizeof(tinygltf::Camera)) + bytes(Target::lights, sizeof(tinygltf::Light));
    return 2 * once;  // vectors grow by copying: for a moment, both copies are there
}

}  // namespace

bool Precheck::uses(std::string_view extension) const {
    return std::find(extensions_used.begin(), extensions_used.end(), extension) != extensions_used.end() ||
           std::find(extensions_required.begin(), extensions_required.end(), extension) != extensions_required.end();
}

Result<Precheck> precheck_gltf(std::string_view text, const JsonScanLimits& limits, std::uint64_t max_model_bytes) {
    Precheck out;
    if (text.substr(0, 3) == "\xEF\xBB\xBF") {
        text.remove_prefix(3);
        out.warnings.push_back("the JSON text begins with a byte order mark, which glTF forbids");
    }
    while (!text.empty() && text.back() == '\0') text.remove_suffix(1);  // chunk padding of old exporters
    out.json = text;
    try {
        GltfVisitor visitor(out, text);
        scan_json(text, limits, visitor);
        check_versions(visitor.version, visitor.min_version, out.extensions_required);
        visitor.check_indices();
        if (const std::uint64_t bytes = estimated_model_bytes(out); bytes > max_model_bytes)
            throw JsonFault{ErrorCode::limit, std::string_view::npos,
                            fmt::format("its objects would take {} MB, the limit for a file of this size is {} MB", bytes >> 20,
                                        max_model_bytes >> 20)};
        visitor.write_model_text();
    } catch (const JsonFault& fault) {
        if (fault.offset == std::string_view::npos) return fail(fault.code, fault.what);
        const TextPlace place = place_of(text, fault.offset);
        const std::string path = printable(json_path_at(text, fault.offset, limits), 120);
        return fail(fault.code,
                    fmt::format("{}{}line {}, column {}: {}", path, path.empty() ? "" : ": ", place.line, place.column, fault.what));
    }
    return out;
}

}  // namespace halflit::io::detail
