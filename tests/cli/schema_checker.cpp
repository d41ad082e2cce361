#include "tests/cli/schema_checker.hpp"

#include "apps/engine/answers/answer_schema.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <regex>

namespace halflit::test {
namespace {

using Json = nlohmann::json;

Json load_schema(const std::string& file) {
    const auto text = engine::answer_schema(file.substr(0, file.find("-1.schema.json")));
    INFO(file);
    REQUIRE(text);
    return Json::parse(*text);
}

bool is_type(const Json& value, const std::string& type) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "integer") return value.is_number_integer();
    if (type == "number") return value.is_number();
    return type == "null" && value.is_null();
}

}  // namespace

Schema::Schema(const std::string& file) : file_(file), root_(load_schema(file)) {}

Schema::Place Schema::resolved(const std::string& ref, const std::string& file) const {
    const std::size_t hash = ref.find('#');
    const std::string other = hash == 0 ? file : ref.substr(0, hash);
    const Json schema = other.empty() ? root_ : load_schema(other);
    return {schema.at(Json::json_pointer(ref.substr(hash + 1))), other};
}

/// Keys that the schema describes, those of allOf and $ref too.
void Schema::collect_keys(const Json& schema, const std::string& file, std::set<std::string>& keys) const {
    if (schema.contains("properties"))
        for (const auto& [key, value] : schema["properties"].items()) keys.insert(key);
    if (schema.contains("allOf"))
        for (const Json& part : schema["allOf"]) collect_keys(part, file, keys);
    if (schema.contains("$ref")) {
        const Place place = resolved(schema["$ref"], file);
        collect_keys(place.schema, place.file, keys);
    }
}

std::string Schema::check(const Json& value, const Json& schema, const std::string& file, const std::string& path, bool whole) const {
    static const std::set<std::string> known = {"$schema",     "$id",
                                                "$defs",       "title",
                                                "description", "type",
                                                "properties",  "required",
                                                "items",       "minItems",
                                                "maxItems",    "minLength",
                                                "maxLength",   "minimum",
                                                "maximum",     "enum",
                                                "const",       "pattern",
                                                "anyOf",       "allOf",
                                                "$ref",        "additionalProperties"};
    for (const auto& [key, rule] : schema.items())
        if (known.count(key) == 0) unknown_.insert(key);
    const auto bad = [&](const std::string& why) { return (path.empty() ? "/" : path) + ": " + why; };
    if (schema.contains("$ref")) {
        const Place place = resolved(schema["$ref"], file);
        if (std::string fault = check(value, place.schema, place.file, path, whole); !fault.empty()) return fault;
    }
    if (schema.contains("allOf")) {
        for (const Json& part : schema["allOf"])
            if (std::string fault = check(value, part, file, path, false); !fault.empty()) return fault;
    }
    if (schema.contains("anyOf")) {
        std::string faults;
        bool good = false;
        for (const Json& part : schema["anyOf"]) {
            const std::string fault = check(value, part, file, path, whole);
            good = good || fault.empty();
            faults += " [" + fault + "]";
        }
        if (!good) return bad("fits none of" + faults);
    }
    if (schema.contains("const") && value != schema["const"]) return bad("is not " + schema["const"].dump());
    if (schema.contains("enum") && std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
        return bad(value.dump() + " is not in " + schema["enum"].dump());
    if (schema.contains("type") && !is_type(value, schema["type"]))
        return bad(value.dump().substr(0, 80) + " is no " + schema["type"].dump());
    if (schema.contains("minimum") && value < schema["minimum"]) return bad(value.dump() + " is too small");
    if (schema.contains("maximum") && value > schema["maximum"]) return bad(value.dump() + " is too large");
    if (schema.contains("pattern") && !std::regex_search(value.get<std::string>(), std::regex(schema["pattern"].get<std::string>())))
        return bad(value.dump() + " does not match");
    if (value.is_array()) {
        if (schema.contains("minItems") && value.size() < schema["minItems"]) return bad("has too few items");
        if (schema.contains("maxItems") && value.size() > schema["maxItems"]) return bad("has too many items");
        if (schema.contains("items"))
            for (std::size_t i = 0; i < value.size(); ++i)
                if (std::string fault = check(value[i], schema["items"], file, path + "/" + std::to_string(i), true); !fault.empty())
                    return fault;
    }
    if (!value.is_object()) return "";
    if (schema.contains("required"))
        for (const Json& key : schema["required"])
            if (!value.contains(key.get<std::string>())) return bad("lacks " + key.dump());
    std::set<std::string> keys;
    collect_keys(schema, file, keys);
    const bool open = schema.contains("additionalProperties") && schema["additionalProperties"].is_object();
    const bool described = !keys.empty() && !schema.contains("anyOf");
    for (const auto& [key, item] : value.items()) {
        const std::string below = path + "/" + key;
        if (schema.contains("properties") && schema["properties"].contains(key)) {
            if (std::string fault = check(item, schema["properties"][key], file, below, true); !fault.empty()) return fault;
        } else if (open) {
            if (std::string fault = check(item, schema["additionalProperties"], file, below, true); !fault.empty()) return fault;
        } else if (whole && described && keys.count(key) == 0) {
            return below + ": is not in the schema";
        }
    }
    return "";
}

}  // namespace halflit::test
