#include "tests/cli/program.hpp"
#include "tests/io/animated_file.hpp"

#include <nlohmann/json.hpp>
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>

using namespace halflit::test;

namespace {

using Json = nlohmann::json;

/// A checker of the part of JSON Schema that docs/schema uses. It is stricter than the standard: an object may have no key that the schema
/// does not describe.
class Schema {
public:
    explicit Schema(const std::string& file) : file_(file), root_(load(file)) {}

    /// The first fault, as a path and a reason; empty: none.
    [[nodiscard]] std::string fault(const Json& value) const { return check(value, root_, file_, "", true); }

    /// Keys of the schema language that the checker met and does not know.
    [[nodiscard]] const std::set<std::string>& unknown() const { return unknown_; }

private:
    static Json load(const std::string& file) {
        Json schema = Json::parse(contents(HALFLIT_SOURCE_DIR "/docs/schema/" + file), nullptr, false);
        INFO(file);
        REQUIRE(!schema.is_discarded());
        return schema;
    }

    struct Place {
        Json schema;
        std::string file;
    };
    static Place resolved(const std::string& ref, const std::string& file) {
        const std::size_t hash = ref.find('#');
        const std::string other = hash == 0 ? file : ref.substr(0, hash);
        return {load(other).at(Json::json_pointer(ref.substr(hash + 1))), other};
    }

    /// Keys that the schema describes, those of allOf and $ref too.
    static void collect_keys(const Json& schema, const std::string& file, std::set<std::string>& keys) {
        if (schema.contains("properties"))
            for (const auto& [key, value] : schema["properties"].items()) keys.insert(key);
        if (schema.contains("allOf"))
            for (const Json& part : schema["allOf"]) collect_keys(part, file, keys);
        if (schema.contains("$ref")) {
            const Place place = resolved(schema["$ref"], file);
            collect_keys(place.schema, place.file, keys);
        }
    }

    static bool is_type(const Json& value, const std::string& type) {
        if (type == "object") return value.is_object();
        if (type == "array") return value.is_array();
        if (type == "string") return value.is_string();
        if (type == "boolean") return value.is_boolean();
        if (type == "integer") return value.is_number_integer();
        if (type == "number") return value.is_number();
        return type == "null" && value.is_null();
    }

    /// `whole`: no other schema describes this value too, so that unknown keys are faults.
    std::string check(const Json& value, const Json& schema, const std::string& file, const std::string& path, bool whole) const {
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

    std::string file_;
    Json root_;
    mutable std::set<std::string> unknown_;
};

void check_report(const std::string& kind, const std::string& text) {
    const Json json = Json::parse(text, nullptr, false);
    REQUIRE(!json.is_discarded());
    INFO(kind << ": " << text.substr(0, 4000));
    CHECK(json["schema"] == "halflit." + kind + "/1");
    const Schema schema(kind + "-1.schema.json");
    CHECK(schema.fault(json) == "");
    CHECK(schema.unknown().empty());
}

std::string output_of(const std::vector<std::string>& arguments, int code = 0) {
    const Outcome outcome = run(arguments);
    INFO(outcome.err);
    CHECK(outcome.code == code);
    return outcome.out;
}

}  // namespace

TEST_CASE("schema: the checker finds missing, unknown and wrong keys", "[cli][schema]") {
    const Schema schema("diff-1.schema.json");
    const TemporaryFolder folder;
    write_contents(folder.file("a.png"), png_of(1, 1, {1, 2, 3, 255}));
    const Json good = Json::parse(output_of({"diff", folder.file("a.png"), folder.file("a.png"), "--json"}));
    REQUIRE(schema.fault(good) == "");
    for (const auto& [key, value] : good.items()) {
        Json lacking = good;
        lacking.erase(key);
        INFO(key);
        CHECK(schema.fault(lacking) != "");
        Json wrong = good;
        wrong[key] = Json::object({{"x", 1}});
        CHECK(schema.fault(wrong) != "");
    }
    Json more = good;
    more["more"] = 1;
    CHECK(schema.fault(more).find("/more: is not in the schema") != std::string::npos);
    Json deep = good;
    deep["tolerance"]["more"] = 1;
    CHECK(schema.fault(deep).find("/tolerance/more: is not in the schema") != std::string::npos);
}

TEST_CASE("schema: reports of render have the keys that their schema describes", "[cli][schema]") {
    const TemporaryFolder folder;
    const std::vector<std::string> head{"render", "demo", "--size", "16x9", "-o", folder.file("a.png"), "--report", "-"};
    const auto report = [&](const std::vector<std::string>& flags, int code = 0) {
        std::vector<std::string> arguments = head;
        arguments.insert(arguments.end(), flags.begin(), flags.end());
        check_report("report", output_of(arguments, code));
    };
    report({});
    report({"--env", "sky", "--max-error", "1"});
    report({"--shading", "gouraud", "--accuracy", "reference", "--region", "1,1,4,4", "--power", "0.5"});
    report({"--camera", "none"}, 2);
}

TEST_CASE("schema: bench, info, diff, golden and trade have the keys that their schemas describe", "[cli][schema]") {
    const TemporaryFolder folder;
    check_report("bench", output_of({"bench", "sphere:500", "--size", "16x9", "--frames", "2", "--json", "--encode", "--env", "sky"}));
    check_report("info", output_of({"info", "demo", "--json"}));
    check_report("info", output_of({"info", "demo", "--json", "--env", "sky", "--max-error", "1", "--light", "spot:range=3", "--lobe",
                                    "mcauley", "--wrap", "0.3", "--power", "2.5"}));
    check_report("info", output_of({"info", "sphere:100", "--json", "--specular", "none", "--light", "point"}));
    write_contents(folder.file("empty.gltf"), R"({"asset":{"version":"2.0"},"scenes":[{}],"scene":0})");
    check_report("info", output_of({"info", folder.file("empty.gltf"), "--json"}));
    const Bytes arm = Arm(1, Keys::linear).file;  // animated
    write_contents(folder.file("arm.glb"), std::string(reinterpret_cast<const char*>(arm.data()), arm.size()));
    check_report("info", output_of({"info", folder.file("arm.glb"), "--json", "--parts", "--hide", "1"}));
    check_report("report", output_of({"render", folder.file("arm.glb"), "--size", "16x9", "-o", folder.file("arm.png"), "--report", "-"}));
    check_report("report", output_of({"render", "demo", "--size", "16x9", "--turntable", "9", "--frames", "4", "-o",
                                      folder.file("t_{}.png"), "--report", "-"}));

    for (const char* sub : {"a", "b"}) std::filesystem::create_directory(folder.file(sub));
    const auto picture = [&](const std::string& path, unsigned char red) {
        write_contents(folder.file(path), png_of(1, 1, {red, 2, 3, 255}));
    };
    for (const char* path : {"a/same.png", "b/same.png", "a/other.png", "a/missing.png", "b/extra.png"}) picture(path, 1);
    picture("b/other.png", 9);
    write_contents(folder.file("a/wide.png"), png_of(2, 1, {1, 2, 3, 255, 1, 2, 3, 255}));
    picture("b/wide.png", 1);
    check_report("diff", output_of({"diff", folder.file("a/same.png"), folder.file("b/other.png"), "--json"}, 1));
    check_report("diff", output_of({"diff", folder.file("a"), folder.file("b"), "--json"}, 1));

    const std::string list = R"({"schema": "halflit.golden-list/1", "scenes": [
        {"name": "a", "scene": "demo", "flags": ["--size", "16x9"], "max": 2, "max_share": 0.5},
        {"name": "b", "scene": "sphere:500", "flags": ["--size", "8x8", "--exposure", "0"]}, {"name": "c", "scene": "lost.glb"}]})";
    write_contents(folder.file("golden.json"), list);
    const Schema list_schema("golden-list-1.schema.json");
    CHECK(list_schema.fault(Json::parse(list)) == "");
    CHECK(list_schema.unknown().empty());
    check_report("golden", output_of({"golden", "update", folder.path(), "--json"}, 4));
    const std::string before = contents(folder.file("golden.json"));
    write_contents(folder.file("golden.json"), std::regex_replace(before, std::regex("\"--exposure\", \"0\""), "\"--exposure\", \"1\""));
    check_report("golden", output_of({"golden", "check", folder.path(), "--json"}, 4));
    check_report("golden", output_of({"golden", "check", folder.path(), "b", "--json"}, 1));

    output_of({"trade", "sphere:100", "--quick", "--size", "16x9", "--frames", "1", "-o", folder.file("trade")});
    check_report("trade", contents(folder.file("trade/trade.json")));
}

TEST_CASE("schema: compare has the keys that its schema describes", "[cli][schema]") {
    const TemporaryFolder folder;
    const auto compare = [&](const std::string& a, const std::string& b, int code) {
        check_report("compare", output_of({"compare", a, b, "--size", "32x24", "--json", "-"}, code));
    };
    compare("sphere:100", "sphere:100", 0);
    compare("sphere:100", "demo", 1);
    write_contents(folder.file("empty.gltf"), R"({"asset":{"version":"2.0"},"scenes":[{}],"scene":0})");
    compare(folder.file("empty.gltf"), "sphere:100", 1);
    compare(folder.file("empty.gltf"), folder.file("empty.gltf"), 0);
}

TEST_CASE("schema: explain has the keys that its schema describes", "[cli][schema]") {
    check_report("explain", output_of({"explain", "demo", "--size", "64x36", "--json", "--pixel", "32,20", "--pixel", "0,0", "--pixel",
                                       "40,30", "--max-error", "1"}));
    check_report("explain", output_of({"explain", "sphere:100", "--size", "16", "--json", "--pixel", "8,8", "--background", "#ff0000"}));
}

TEST_CASE("schema: look has the keys that its schema describes", "[cli][schema]") {
    check_report("look", output_of({"look", "demo", "--size", "120x90", "--json", "-"}, 1));  // a long row: tiny from the right
    check_report("look", output_of({"look", "sphere:100", "--size", "64", "--json", "-", "--camera-position", "0,0,0.2"}, 1));
    check_report("look", output_of({"look", "sphere:100", "--size", "64", "--json", "-", "--perspective", "--view", "front"}));
    check_report("look", output_of({"look", "sphere:2000", "--size", "64", "--json", "-", "--certify", "8", "--certify-views", "5"}, 1));
    const TemporaryFolder folder;
    write_contents(folder.file("empty.gltf"), R"({"asset":{"version":"2.0"},"scenes":[{}],"scene":0})");
    check_report("look", output_of({"look", folder.file("empty.gltf"), "--size", "64", "--json", "-"}, 1));
}

TEST_CASE("schema: the report of view has the keys that its schema describes", "[cli][schema]") {
    RunSettings settings;
    settings.environment = {{"SDL_VIDEODRIVER", "dummy"}};
    for (const std::vector<std::string>& how : {std::vector<std::string>{"--orbit", "3", "--click", "32,24"}, {"--click", "0,0"}}) {
        std::vector<std::string> arguments{"view", "sphere:500", "--size", "64x48", "--report", "-"};
        arguments.insert(arguments.end(), how.begin(), how.end());
        const Outcome outcome = run(arguments, settings);
        if (outcome.code == 2 && outcome.err.find("needs the librar") != std::string::npos) HALFLIT_SKIP(outcome.err);
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
        check_report("view", outcome.out);
    }
}
