#include "apps/engine/answers/answer_schema.hpp"

#include "apps/engine/answers/run_report.hpp"
#include "apps/engine/basics/spelling.hpp"
#include "apps/engine/request/flags.hpp"
#include "sh/config.hpp"
#include "shading/material_properties.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <utility>

namespace halflit::engine {
namespace {

struct Table {
    std::string_view kind, text;
};
constexpr Table kTables[] = {
#include "answer_tables.inc"
};

constexpr std::string_view kFile = "-1.schema.json";

bool is_of_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-'; }

Json material_numbers() {
    Json out{{"type", "object"}};
    for (const shading::MaterialNumber& number : shading::kMaterialNumbers) {
        Json value{{"type", "number"}};
        if (number.count > 1) value = {{"type", "array"}, {"items", value}, {"minItems", number.count}, {"maxItems", number.count}};
        out["properties"][std::string(number.name)] = std::move(value);
        out["required"].push_back(number.name);
    }
    return out;
}

std::vector<std::string> texture_slots() {
    std::vector<std::string> slots;
    for (const shading::TextureSlotInfo& slot : shading::kTextureSlotInfos) slots.emplace_back(slot.name);
    return slots;
}

/// Reads a table. Its texts are a part of the program: a fault of one is a fault of the build, which tests find.
class Reader {
public:
    explicit Reader(std::string_view text) : text_(text) {}

    Json schema(const std::string& kind) {
        Json out{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"$id", kind + std::string(kFile)}};
        out["title"] = header_line();
        if (std::string more = header_line(); !more.empty()) out["description"] = std::move(more);
        while (next() == ':') {
            ++at_;
            const std::string name = word();
            out["$defs"][name] = described();
        }
        Json body = type();
        for (auto& [key, value] : body.items()) out[key] = std::move(value);
        HALFLIT_ASSERT(next() == 0);
        return out;
    }

private:
    std::string header_line() {
        if (!text_.substr(at_).starts_with("# ")) return "";
        const std::size_t end = text_.find('\n', at_);
        std::string line(text_.substr(at_ + 2, end - at_ - 2));
        at_ = end + 1;
        return line;
    }

    /// The next character that is neither white space nor of a comment; 0 at the end. Comments are kept.
    char next() {
        while (at_ < text_.size()) {
            if (text_[at_] == '#') {
                const std::size_t end = std::min(text_.find('\n', at_), text_.size());
                const std::string_view line = text_.substr(at_ + 1, end - at_ - 1);
                comment_.append(comment_.empty() ? line.substr(1) : line);
                at_ = end;
            } else if (text_[at_] != ' ' && text_[at_] != '\n') {
                return text_[at_];
            } else {
                ++at_;
            }
        }
        return 0;
    }

    bool take(std::string_view token) {
        next();
        if (!text_.substr(at_).starts_with(token)) return false;
        at_ += token.size();
        return true;
    }

    std::string word() {
        next();
        const std::size_t begin = at_;
        while (at_ < text_.size() && is_of_word(text_[at_])) ++at_;
        HALFLIT_ASSERT(at_ > begin);
        if (at_ == begin) at_ = text_.size();
        return std::string(text_.substr(begin, at_ - begin));
    }

    /// "0..", "0..1", "..5" or "4", if it follows.
    void range(Json& out, const char* least, const char* most) {
        const auto put = [&](const char* key) {
            std::int64_t value = 0;
            const char* const begin = text_.data() + at_;
            const auto end = std::from_chars(begin, text_.data() + text_.size(), value).ptr;
            at_ += static_cast<std::size_t>(end - begin);
            if (end != begin) out[key] = value;
            return end != begin;
        };
        next();
        const bool begins = put(least);
        if (take(".."))
            put(most);
        else if (begins)
            out[most] = out[least];
    }

    std::string quoted() {
        next();
        const std::size_t end = text_.find('"', ++at_);
        std::string out(text_.substr(at_, end - at_));
        at_ = end + 1;
        return out;
    }

    /// "#/$defs/NAME/properties/FIELD", behind the file of another table.
    Json reference() {
        std::string ref;
        if (is_of_word(text_[at_])) ref = word() + std::string(kFile);
        ref += "#";
        while (at_ < text_.size() && (text_[at_] == ':' || text_[at_] == '/')) {
            ref += text_[at_++] == ':' ? "/$defs/" : "/properties/";
            ref += word();
        }
        return {{"$ref", ref}};
    }

    Json object() {
        Json out{{"type", "object"}}, parts = Json::array(), required = Json::array();
        next();
        const std::string of_object = std::exchange(comment_, {});
        while (next() != 0 && !take("}")) {
            if (take("+ @")) {
                parts.push_back(reference());
            } else if (take("!")) {
                out["additionalProperties"] = false;
            } else if (take("*")) {
                out["additionalProperties"] = described();
            } else {
                const std::string name = word();
                if (!take("?")) required.push_back(name);
                out["properties"][name] = described();
            }
        }
        if (!required.empty()) out["required"] = std::move(required);
        if (!parts.empty()) {
            parts.insert(parts.begin(), std::move(out));
            out = Json{{"allOf", std::move(parts)}};
        }
        comment_ = of_object;
        return out;
    }

    Json single() {
        if (take("@")) return reference();
        if (take("{")) return object();
        if (next() == '"') {
            std::vector<std::string> words{quoted()};
            while (take("|")) words.push_back(quoted());
            return words.size() == 1 ? Json{{"const", words[0]}} : Json{{"type", "string"}, {"enum", words}};
        }
        if (take("[")) {
            Json out{{"type", "array"}};
            if (Json item = type(); !item.empty()) out["items"] = std::move(item);
            if (take(";")) range(out, "minItems", "maxItems");
            static_cast<void>(take("]"));
            return out;
        }
        const std::string name = word();
        if (name == "any") return Json::object();
        if (name == "bool") return {{"type", "boolean"}};
        if (name == "material_numbers") return material_numbers();
        if (name == "material_textures") return {{"type", "string"}, {"enum", texture_slots()}};
        if (name == "true") return {{"const", true}};
        if (name == "null") return {{"type", "null"}};
        const bool is_text = name == "text", is_int = name == "int";
        HALFLIT_ASSERT(is_text || is_int || name == "number");
        Json out{{"type", is_text ? "string" : is_int ? "integer" : "number"}};
        if (is_text && take("/")) {
            const std::size_t end = text_.find('/', at_);
            out["pattern"] = text_.substr(at_, end - at_);
            at_ = end + 1;
        }
        range(out, is_text ? "minLength" : "minimum", is_text ? "maxLength" : "maximum");
        return out;
    }

    Json type() {
        Json out = single();
        if (!take("or ")) return out;
        Json all = Json::array({std::move(out)});
        do all.push_back(single());
        while (take("or "));
        return {{"anyOf", std::move(all)}};
    }

    /// A type with the comment that follows it, or that stands where its object begins.
    Json described() {
        comment_.clear();
        Json out = type();
        next();
        if (!comment_.empty()) out["description"] = std::exchange(comment_, {});
        return out;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::string comment_;
};

}  // namespace

std::vector<std::string> answer_kinds() {
    std::vector<std::string> kinds;
    for (const Table& table : kTables) kinds.emplace_back(table.kind);
    return kinds;
}

Result<std::string> answer_schema(const std::string& kind) {
    for (const Table& table : kTables)
        if (table.kind == kind) return Reader(table.text).schema(kind).dump(1) + "\n";
    return fail(ErrorCode::usage,
                "expected one of " + joined(answer_kinds(), ", ") + ", found '" + kind + "'" + did_you_mean(kind, answer_kinds()));
}

}  // namespace halflit::engine
