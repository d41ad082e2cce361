#include "apps/io/gltf/text/json_scan.hpp"

#include "apps/io/gltf/text/json_place.hpp"

#include "tests/support/catch.hpp"

#include <string>
#include <vector>

using namespace halflit;
using namespace halflit::io::detail;

namespace {

struct Nothing final : JsonVisitor {
    void on_key(const JsonValue&) override {}
    void on_begin(JsonType, std::size_t) override {}
    void on_end(std::size_t) override {}
    void on_value(const JsonValue&, std::size_t) override {}
};

struct Collect final : JsonVisitor {
    std::vector<std::string> keys, strings;
    std::vector<double> numbers;
    void on_key(const JsonValue& key) override { keys.emplace_back(key.text); }
    void on_begin(JsonType, std::size_t) override {}
    void on_end(std::size_t) override {}
    void on_value(const JsonValue& v, std::size_t) override {
        if (v.type == JsonType::string) strings.emplace_back(v.text);
        if (v.type == JsonType::integer || v.type == JsonType::number) numbers.push_back(v.number);
    }
};

/// The fault, or code negative_result if the text is sound.
JsonFault fault_of(const std::string& text, JsonScanLimits limits = {}) {
    Nothing visitor;
    try {
        scan_json(text, limits, visitor);
    } catch (const JsonFault& fault) {
        return fault;
    }
    return {ErrorCode::negative_result, 0, ""};
}

}  // namespace

TEST_CASE("json scan: sound texts pass and values arrive decoded", "[io]") {
    Collect seen;
    scan_json(R"( {"a": [1, -2.5e2, 0, 1e-400], "\u00e9\n": "x\ud83d\ude00\"", "b": {"a": null, "c": true}} )", {}, seen);
    CHECK(seen.keys == std::vector<std::string>{"a", "\xC3\xA9\n", "b", "a", "c"});
    CHECK(seen.strings == std::vector<std::string>{"x\xF0\x9F\x98\x80\""});
    CHECK(seen.numbers == std::vector<double>{1, -250, 0, 0});
}

TEST_CASE("json scan: what RFC 8259 forbids is a fault at its place", "[io]") {
    struct Case {
        const char* text;
        std::size_t offset;
    };
    for (const Case& c : {Case{"", 0},
                          {"{", 1},
                          {"[1,]", 3},
                          {"[1 2]", 3},
                          {"{\"a\" 1}", 5},
                          {"{\"a\":1,}", 7},
                          {"{a:1}", 1},
                          {"[01]", 2},
                          {"[1.]", 3},
                          {"[.5]", 1},
                          {"[+1]", 1},
                          {"[NaN]", 1},
                          {"[Infinity]", 1},
                          {"[-Infinity]", 2},
                          {"[1e999]", 1},
                          {"[-1e999]", 1},
                          {"[nul]", 1},
                          {"[\"a]", 1},
                          {"[\"\\x\"]", 3},
                          {"[\"\\ud800\"]", 2},
                          {"[\"\\u12g4\"]", 4},
                          {"[\"a\nb\"]", 3},
                          {"[] []", 3},
                          {"[1]]", 3},
                          {"{\"a\":1,\"b\":2,\"a\":3}", 13},
                          {"{\"a\":1,\"\\u0061\":3}", 7},
                          {"[\"\xC0\xAF\"]", 2},
                          {"[\"\xED\xA0\x80\"]", 2},
                          {"[\"\xF5\x80\x80\x80\"]", 2},
                          {"[\"\xE2\x82\"]", 2}}) {
        INFO(c.text);
        const JsonFault fault = fault_of(c.text);
        CHECK(fault.code == ErrorCode::bad_input);
        CHECK(fault.offset == c.offset);
        CHECK(!fault.what.empty());
    }
    CHECK(fault_of(R"([{"a":1},{"a":2}])").code == ErrorCode::negative_result);  // the same key in two objects
}

TEST_CASE("json scan: nesting and tokens have limits, and deep text needs no deep stack", "[io]") {
    const std::string deep64 = std::string(64, '[') + std::string(64, ']');
    CHECK(fault_of(deep64).code == ErrorCode::negative_result);
    CHECK(fault_of("[" + deep64 + "]").code == ErrorCode::limit);
    CHECK(fault_of(std::string(3'000'000, '[')).code == ErrorCode::limit);
    CHECK(fault_of(std::string(1'000'000, '[') + std::string(1'000'000, ']'), {2'000'000, 5'000'000}).code == ErrorCode::negative_result);
    CHECK(fault_of("[1,2,3]", {64, 4}).code == ErrorCode::negative_result);
    CHECK(fault_of("[1,2,3]", {64, 3}).code == ErrorCode::limit);
}

TEST_CASE("json scan: an offset has a line, a column and a path", "[io]") {
    const std::string text = "{\n  \"nodes\": [{\"mesh\": 0},\n    {\"mesh\": 7, \"x\": [1, [2, 3]]}]\n}";
    const auto at = [&](const char* what) { return text.find(what); };
    CHECK(place_of(text, at("7")).line == 3);
    CHECK(place_of(text, at("7")).column == 14);
    CHECK(json_path_at(text, at("7"), {}) == "nodes[1].mesh");
    CHECK(json_path_at(text, at("3]"), {}) == "nodes[1].x[1][1]");
    CHECK(json_path_at(text, at("\"x\""), {}) == "nodes[1].x");
    CHECK(json_path_at(text, 0, {}).empty());
}
