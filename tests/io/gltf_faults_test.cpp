// Faulty files: each fault is refused with the right code, one line, and a place; some files are drawn as far as possible.
#include "tests/io/gltf_builder.hpp"

#include "tests/support/catch.hpp"

#include <chrono>
#include <string>
#include <tuple>

using namespace halflit;
using namespace halflit::test;

namespace {

Error refusal(const Bytes& file, const LoadOptions& options = strictly()) {
    const auto loaded = load(file, options);
    if (loaded) return {ErrorCode::negative_result, "loaded"};
    CHECK(loaded.error().message.find('\n') == std::string::npos);
    CHECK(loaded.error().message.rfind("test.glb: ", 0) == 0);
    return loaded.error();
}

/// The triangle's JSON with one place changed.
Bytes changed(const TriangleFile& file, const std::string& from, const std::string& to) {
    return glb(replaced(file.json(), from, to), file.bin);
}

Bytes text_file(const std::string& json) { return to_bytes(json); }

}  // namespace

TEST_CASE("gltf: files of the first version are refused with the way to convert them", "[io]") {
    const std::string lists =
        R"("buffers":{},"meshes":{"m":{"primitives":[]}},"nodes":{"n":{"meshes":["m"]}},"scenes":{"s":{"nodes":["n"]}})";
    const auto refused = [](const Bytes& file, const LoadOptions& options) {
        const auto loaded = load(file, options);
        REQUIRE(!loaded);
        CHECK(loaded.error().code == ErrorCode::bad_input);
        INFO(loaded.error().message);
        CHECK(loaded.error().message.find("is glTF 1.0, expected 2.0; convert it with gltf-pipeline") != std::string::npos);
    };
    for (const char* version : {"\"1.0\"", "\"1.1\"", "1.0", "1"})
        for (const LoadOptions& options : {LoadOptions{}, strictly()})
            refused(to_bytes(std::string("{\"asset\":{\"version\":") + version + "}}"), options);
    for (const char* asset : {"\"asset\":{},", "\"asset\":{\"version\":1.0},", ""}) refused(to_bytes("{" + (asset + lists) + "}"), {});
    Bytes container = glb("{}");
    put<std::uint32_t>(container, 4, 1);
    refused(container, {});
}

TEST_CASE("faults: broken JSON is refused with line and column", "[io]") {
    CHECK(refusal(text_file("{\n\"asset\":{\"version\":NaN}}")).message ==
          "test.glb: asset.version: line 2, column 20: expected a JSON value, found \"NaN\"");
    for (const char* bad :
         {"", "   ", "{", "[]", "3", "null", "\"x\"", "{\"asset\":{\"version\":\"2.0\"},\"asset\":{}}",
          "{\"asset\":{\"version\":\"2.0\\uD800\"}}", "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"translation\":[1e999,0,0]}]}",
          "{\"asset\":{\"version\":\"2.0\"}} trailing"})
        CHECK(refusal(text_file(bad)).code == ErrorCode::bad_input);
    const std::string good = std::string("{") + kAsset + "}";
    const LoadedScene bom = load_ok(text_file("\xEF\xBB\xBF" + good));
    CHECK(bom.warnings.at(0).find("byte order mark") != std::string::npos);
    const std::string deep = std::string("{") + kAsset + ",\"extras\":" + std::string(100000, '[') + std::string(100000, ']') + "}";
    CHECK(refusal(text_file(deep)).code == ErrorCode::limit);
    LoadOptions small;
    small.limits.max_json_tokens = 2;
    CHECK(refusal(text_file(good), small).code == ErrorCode::limit);
    small = {};
    small.limits.max_file_bytes = 10;
    CHECK(refusal(text_file(good), small).code == ErrorCode::limit);
}

TEST_CASE("faults: numbers of any length are read, and refused only where double or the field cannot hold them", "[io]") {
    const auto with = [](const std::string& members) { return text_file(std::string("{") + kAsset + "," + members + "}"); };
    const std::string zeros(400, '0');
    const auto camera = [&](const std::string& zfar) {
        return with("\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1,\"zfar\":" + zfar + "}}]");
    };
    for (const std::string& good : {std::string("100000000000000000000"), "1" + zeros + "e-399", std::string("2.5e1")}) {
        INFO(good);
        CHECK(load(camera(good)));
    }
    CHECK(load(with("\"extensions\":{\"ZZ_y\":{\"id\":18446744073709551615}}")));
    CHECK(load(with("\"extras\":[0." + zeros + "e1,0." + zeros + "1e1,1e-999,-0]")));
    for (const std::string& bad : {"1" + zeros, "1" + zeros + "e-1", "0.001" + zeros + "e999", std::string("1e999")}) {
        INFO(bad);
        CHECK(refusal(camera(bad)).message.find("range of double") != std::string::npos);
    }
    CHECK(refusal(with("\"nodes\":[{\"translation\":[]}]")).message.find("expected 3 numbers, found 0") != std::string::npos);
    CHECK(refusal(changed(TriangleFile(), "\"byteLength\":36}]", "\"byteLength\":9007199254740993}]")).message.find("2^53") !=
          std::string::npos);
    CHECK(refusal(changed(TriangleFile(), "\"byteLength\":36}]", "\"byteLength\":36.0}]")).code == ErrorCode::negative_result);
}

TEST_CASE("faults: values of a wrong type or size are refused at their path", "[io]") {
    const TriangleFile t;
    const auto check = [&](const std::string& from, const std::string& to, const std::string& path) {
        const Error error = refusal(changed(t, from, to));
        INFO(to << " gave " << error.message);
        CHECK(error.code == ErrorCode::bad_input);
        CHECK(error.message.find(path) != std::string::npos);
    };
    check("\"mesh\":0", "\"mesh\":-1", "nodes[0].mesh");
    check("\"mesh\":0", "\"mesh\":1", "nodes[0].mesh");
    check("\"mesh\":0", "\"mesh\":4294967296", "nodes[0].mesh");
    check("\"mesh\":0", "\"mesh\":0.5", "nodes[0].mesh");
    check("\"mesh\":0", "\"mesh\":\"0\"", "nodes[0].mesh");
    check("\"mesh\":0", "\"mesh\":null", "nodes[0].mesh");
    check("\"count\":3", "\"count\":9007199254740993", "accessors[0].count");
    check("\"count\":3", "\"count\":-3", "accessors[0].count");
    check("\"count\":3", "\"count\":4611686018427387904", "accessors[0].count");
    check("\"componentType\":5126", "\"componentType\":5124", "accessors[0]");
    check("\"componentType\":5126", "\"componentType\":5130", "accessors[0]");
    check(",\"type\":\"VEC3\"", "", "accessors[0]");
    check("\"POSITION\":0", "\"POSITION\":1", "attributes.POSITION");
    check("\"POSITION\":0", "\"POSITION\":[0]", "attributes.POSITION");
    check("\"nodes\":[0]", "\"nodes\":{\"0\":0}", "scenes[0].nodes");
    check("\"nodes\":[0]", "\"nodes\":[1]", "scenes[0].nodes[0]");
    check("\"scene\":0", "\"scene\":1", "scene");
    check("\"buffer\":0", "\"buffer\":3", "bufferViews[0].buffer");
    check("\"buffers\":[", "\"buffers\":[7,", "buffers[0]");
    check("\"attributes\":{\"POSITION\":0}", "\"attributes\":[]", "attributes");
    check("\"attributes\":{\"POSITION\":0}", "\"mode\":4", "primitives[0]");
}

namespace {

/// The triangle with further members of the root. Its node uses element 0 of each array that these have, if `used`.
Bytes with_members(const std::string& rest, bool used) {
    TriangleFile t;
    t.rest = "," + rest;
    std::string node = "\"mesh\":0";
    const auto has = [&](const char* key) { return used && rest.find(key) != std::string::npos; };
    if (has("\"materials\"")) t.primitive = ",\"material\":0";
    if (has("\"cameras\"")) node += ",\"camera\":0";
    if (has("\"skins\"")) node += ",\"skin\":0";
    if (has("\"lights\"")) node += ",\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}";
    return glb(replaced(t.json(), "\"mesh\":0", node), t.bin);
}

}  // namespace

TEST_CASE("faults: lists of a wrong length, and objects without the members of their type, are refused where they are drawn", "[io]") {
    const auto refused = [&](const std::string& rest, const std::string& path, const std::string& what) {
        const Error error = refusal(with_members(rest, true));
        INFO(rest << " gave " << error.message);
        CHECK(error.code == ErrorCode::bad_input);
        CHECK(error.message.find("test.glb: " + path + ": line 1, column ") == 0);
        CHECK(error.message.find(what) != std::string::npos);
        const LoadedScene loaded = load_ok(with_members(rest, false));
        const auto said = [&](const std::string& warning) {
            return warning.find(path + ": ") == 0 && warning.find(what) != std::string::npos &&
                   warning.ends_with("nothing that is drawn uses it");
        };
        CHECK(std::count_if(loaded.warnings.begin(), loaded.warnings.end(), said) == 1);
    };
    refused(R"("materials":[{"emissiveFactor":[1,1]}])", "materials[0].emissiveFactor", "expected 3 numbers, found 2");
    refused(R"("materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,1,1]}}])", "materials[0].pbrMetallicRoughness.baseColorFactor",
            "expected 4 numbers, found 3");
    refused(R"("cameras":[{"type":"perspective"}])", "cameras[0]", "\"perspective\"");
    refused(R"("cameras":[{"type":"orthographic","perspective":{"yfov":1,"znear":1}}])", "cameras[0]", "\"orthographic\"");
    refused(R"("cameras":[{"type":"fisheye"}])", "cameras[0].type", "\"fisheye\"");
    refused(R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot"}]}})", "extensions.KHR_lights_punctual.lights[0]", "\"spot\"");
    refused(R"("skins":[{}])", "skins[0]", "\"joints\"");
    refused(R"("materials":[{"normalTexture":{"index":0}}],"textures":[{"source":0}])", "textures[0].source", "the file has 0 images");
    for (const char* sound :
         {R"("extras":[1e300,12345678901234567890])", R"("materials":[{"extras":7},{"extras":["halflit"]}])",
          R"("extensions":{"VENDOR_x":{"lights":5}})", R"("cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}])"})
        CHECK(refusal(with_members(sound, false)).code == ErrorCode::negative_result);
    CHECK(refusal(changed(TriangleFile(), "\"count\":3", "\"count\":3.0")).code == ErrorCode::negative_result);  // JSON Schema: an integer
    CHECK(refusal(changed(TriangleFile(), "\"count\":3", "\"count\":0.3e1")).code == ErrorCode::negative_result);
}

TEST_CASE("faults: an element that is no object keeps the numbers of those after it", "[io]") {
    TriangleFile t;
    t.rest = R"(,"materials":[7,{"pbrMetallicRoughness":{"metallicFactor":0.25}}])";
    t.primitive = ",\"material\":1";
    const LoadedScene loaded = load_ok(t.file());
    REQUIRE(loaded.scene.materials.size() == 2);
    CHECK(loaded.scene.materials[1].metallic == 0.25f);
    CHECK(loaded.warnings == std::vector<std::string>{"materials[0]: expected an object, found an integer, nothing that is drawn uses it"});
}

TEST_CASE("faults: a factor out of range is warned of at its path, and drawn as the nearest one in range", "[io]") {
    const LoadedScene loaded =
        load_ok(with_members(R"("materials":[{"emissiveFactor":[0,-1,0],"pbrMetallicRoughness":{"roughnessFactor":3}}])", true));
    CHECK(loaded.warnings == std::vector<std::string>{"materials[0].emissiveFactor[1]: -1 is not in [0, 1], drawn as 0",
                                                      "materials[0].pbrMetallicRoughness.roughnessFactor: 3 is not in [0, 1], drawn as 1"});
    CHECK(loaded.scene.materials[0].roughness == 1.0f);
    CHECK(loaded.scene.materials[0].emissive.y == 0.0f);
}

TEST_CASE("faults: of many warnings the first hundred are kept, and the rest are counted", "[io]") {
    std::string materials = R"({"alphaCutoff":-1})";
    for (int i = 1; i < 150'000; ++i) materials += R"(,{"alphaCutoff":-1})";
    const LoadedScene loaded = load_ok(with_members("\"materials\":[" + materials + "]", false));
    REQUIRE(loaded.warnings.size() == 101);
    CHECK(loaded.warnings[99].find("materials[99].alphaCutoff: ") == 0);
    CHECK(loaded.warnings[100] == "and 149900 further warnings");
}

TEST_CASE("faults: a buffer that nothing drawn uses is not read", "[io]") {
    for (const char* unused :
         {R"({"byteLength":4})", R"({"byteLength":4,"uri":"absent.bin"})", R"({"byteLength":4,"uri":"http://a/b"})", "{}", "7"}) {
        INFO(unused);
        CHECK(load(changed(TriangleFile(), "\"buffers\":[{\"byteLength\":36}", std::string("\"buffers\":[{\"byteLength\":36},") + unused)));
    }
}

TEST_CASE("faults: accessors and views that leave their buffer are refused, for numbers of any size", "[io]") {
    const TriangleFile t;
    const auto code = [&](const std::string& from, const std::string& to) { return refusal(changed(t, from, to)).code; };
    for (const char* count : {"4", "2147483648", "4294967295", "715827883", "4294967299", "9007199254740992"})
        CHECK(code("\"count\":3", std::string("\"count\":") + count) == ErrorCode::bad_input);
    for (const char* offset : {"1", "36", "4294967296", "9007199254740992"}) {
        CHECK(code("\"bufferView\":0", std::string("\"bufferView\":0,\"byteOffset\":") + offset) == ErrorCode::bad_input);
        CHECK(code("\"buffer\":0", std::string("\"buffer\":0,\"byteOffset\":") + offset) == ErrorCode::bad_input);
    }
    for (const char* stride : {"4", "8", "13", "16", "256", "2147483647"})
        CHECK(code("\"buffer\":0", std::string("\"buffer\":0,\"byteStride\":") + stride) == ErrorCode::bad_input);
    CHECK(code("\"buffer\":0", "\"buffer\":0,\"byteStride\":12") == ErrorCode::negative_result);
    CHECK(code("\"byteLength\":36}]", "\"byteLength\":37}]") == ErrorCode::bad_input);
    // Without a view there is no buffer to leave; the limit is memory.
    CHECK(code("\"bufferView\":0,", "") == ErrorCode::negative_result);
    CHECK(refusal(changed(t, "\"bufferView\":0,\"componentType\":5126,\"count\":3", "\"componentType\":5126,\"count\":2147483646")).code ==
          ErrorCode::limit);
    CHECK(refusal(changed(t, "\"bufferView\":0,\"componentType\":5126,\"count\":3", "\"componentType\":5126,\"count\":9007199254740990"))
              .code == ErrorCode::limit);
}

TEST_CASE("faults: sparse accessors with wrong counts, orders and places are refused", "[io]") {
    const auto with = [](std::initializer_list<std::uint16_t> indices, const std::string& count, const std::string& offset = "0",
                         int type = 5123) {
        TriangleFile file;
        file.bin.resize(36);
        append<std::uint16_t>(file.bin, indices);
        const std::size_t values = file.bin.size();
        append<float>(file.bin, {7, 8, 9, 7, 8, 9});
        file.views += R"(,{"buffer":0,"byteOffset":36,"byteLength":)" + std::to_string(values - 36) + R"(},{"buffer":0,"byteOffset":)" +
                      std::to_string(values) + R"(,"byteLength":24})";
        file.accessors = R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":)" + count +
                         R"(,"indices":{"bufferView":1,"componentType":)" + std::to_string(type) +
                         R"(},"values":{"bufferView":2,"byteOffset":)" + offset + "}}}";
        return refusal(file.file()).code;
    };
    CHECK(with({0, 2}, "2") == ErrorCode::negative_result);
    CHECK(with({0, 2}, "0") == ErrorCode::negative_result);
    CHECK(with({0, 3}, "2") == ErrorCode::bad_input);
    CHECK(with({2, 0}, "2") == ErrorCode::bad_input);
    CHECK(with({1, 1}, "2") == ErrorCode::bad_input);
    CHECK(with({0, 2}, "3") == ErrorCode::bad_input);
    CHECK(with({0, 2}, "2147483647") == ErrorCode::bad_input);
    CHECK(with({0, 2}, "2", "4") == ErrorCode::bad_input);
    CHECK(with({0, 2}, "2", "2147483647") == ErrorCode::bad_input);
    CHECK(with({0, 2}, "2", "0", 5126) == ErrorCode::bad_input);
    CHECK(with({0, 2}, "2", "0", 5125) == ErrorCode::bad_input);
}

TEST_CASE("faults: indices out of range are refused by the strict rules, or their triangles left out", "[io]") {
    const auto with = [](const Bytes& indices, int type, int count) {
        TriangleFile file;
        const int accessor =
            file.add(indices, "\"componentType\":" + std::to_string(type) + ",\"count\":" + std::to_string(count) + ",\"type\":\"SCALAR\"");
        file.primitive = ",\"indices\":" + std::to_string(accessor);
        return file.file();
    };
    Bytes bytes, shorts, words;
    append<std::uint8_t>(bytes, {0, 1, 2, 0, 1, 3, 255, 1, 2, 0});
    append<std::uint16_t>(shorts, {0, 1, 2, 0, 1, 65535});
    append<std::uint32_t>(words, {0, 1, 2, 0, 0x80000000u, 2, 0, 1, 0xFFFFFFFFu});
    const LoadOptions tolerant;
    const std::tuple<const Bytes*, int, int> cases[] = {{&bytes, 5121, 9}, {&shorts, 5123, 6}, {&words, 5125, 9}, {&bytes, 5121, 4}};
    for (const auto& [data, type, count] : cases) {
        const Bytes file = with(*data, type, count);
        const Error error = refusal(file);
        CHECK(error.code == ErrorCode::bad_input);
        CHECK(error.message.find("meshes[0].primitives[0]") != std::string::npos);
        const LoadedScene loaded = load_ok(file, tolerant);
        CHECK(loaded.scene.meshes.at(0).indices.size() == 3);
        CHECK(loaded.warnings.size() == 1);
    }
    CHECK(refusal(with(bytes, 5126, 1)).code == ErrorCode::bad_input);  // float indices
}

TEST_CASE("faults: attributes of other lengths or types are refused", "[io]") {
    for (const char* attribute : {"NORMAL", "TEXCOORD_0", "COLOR_0"}) {
        TriangleFile file;
        const bool pair = std::string(attribute) == "TEXCOORD_0";
        Bytes two;
        append<float>(two, {0, 0, 1, 0, 0, 1});
        file.attributes +=
            std::string(",\"") + attribute + "\":" +
            std::to_string(file.add(two, std::string(R"("componentType":5126,"count":2,"type":)") + (pair ? "\"VEC2\"" : "\"VEC3\"")));
        const Error error = refusal(file.file());
        CHECK(error.code == ErrorCode::bad_input);
        CHECK(error.message.find(attribute) != std::string::npos);
    }
    CHECK(refusal(changed(TriangleFile(), "VEC3", "VEC2")).code == ErrorCode::bad_input);
    CHECK(refusal(changed(TriangleFile(), "VEC3", "VEC4")).code == ErrorCode::bad_input);
    CHECK(refusal(changed(TriangleFile(), "VEC3", "VEC9")).code == ErrorCode::bad_input);
}

TEST_CASE("faults: versions and required extensions that are not supported are refused by name", "[io]") {
    const auto with = [](const std::string& asset, const std::string& rest = "") {
        return text_file("{\"asset\":{" + asset + "}" + rest + "}");
    };
    CHECK(refusal(with(R"("version":"2.0")")).code == ErrorCode::negative_result);
    CHECK(refusal(with(R"("version":"2.1")")).code == ErrorCode::negative_result);
    CHECK(refusal(with(R"("version":"2.1","minVersion":"2.0")")).code == ErrorCode::negative_result);
    for (const char* asset : {R"("version":"2.1","minVersion":"2.1")", R"("version":"3.0")", R"("version":"1.0")", R"("version":"two")",
                              R"("version":2.0)", R"("generator":"x")", R"("version":"2.")"})
        CHECK(refusal(with(asset)).code == ErrorCode::bad_input);
    CHECK(refusal(text_file("{}")).code == ErrorCode::bad_input);
    const Error error = refusal(with(R"("version":"2.0")", R"(,"extensionsRequired":["EXT_texture_avif"])"));
    CHECK(error.code == ErrorCode::bad_input);
    CHECK(error.message.find("EXT_texture_avif") != std::string::npos);
    CHECK(refusal(with(R"("version":"2.0")", R"(,"extensionsUsed":["VENDOR_anything"])")).code == ErrorCode::negative_result);
}

TEST_CASE("faults: control characters in names cannot reach the terminal", "[io]") {
    const Error error = refusal(text_file(R"({"asset":{"version":"2.0"},"extensionsRequired":["a\u001b[31m\n\u009bx\u007f"]})"));
    CHECK(error.message.find('\x1b') == std::string::npos);
    CHECK(error.message.find("a\\x1b[31m\\x0a\\xc2\\x9bx\\x7f") != std::string::npos);
    const auto loaded = load_gltf_bytes({}, "evil\x1b[2J\n.glb", "");
    CHECK(loaded.error().message.rfind("evil\\x1b[2J\\x0a.glb: ", 0) == 0);
}

TEST_CASE("faults: other files are not read from memory, nor from outside the folder", "[io]") {
    for (const char* uri : {"a.bin", "../a.bin", "..%2fa.bin", "/etc/passwd", "file:///etc/passwd", "http://example.org/x", "%00", ""}) {
        std::string json = TriangleFile().json();
        json = replaced(json, "\"byteLength\":36}],", std::string("\"byteLength\":36,\"uri\":\"") + uri + "\"}],");
        CHECK(refusal(text_file(json)).code == ErrorCode::bad_input);
        const auto in_folder = load(text_file(json), {}, "/tmp");
        REQUIRE(!in_folder);
        CHECK(in_folder.error().code == ErrorCode::bad_input);
        CHECK(in_folder.error().message.find("buffers[0].uri") != std::string::npos);
    }
}

TEST_CASE("faults: a small file cannot ask for much memory or time", "[io]") {
    const auto start = std::chrono::steady_clock::now();
    const auto many = [](const std::string& one, std::size_t bytes) {
        std::string out = one;
        while (out.size() < bytes) out += "," + one;
        return out;
    };
    const std::string head = std::string("{") + kAsset + ",";
    CHECK(refusal(text_file(head + "\"materials\":[" + many("{}", 1'000'000) + "]}")).code == ErrorCode::limit);
    CHECK(refusal(text_file(head + "\"nodes\":[" + many("{}", 1'000'000) + "]}")).code != ErrorCode::internal);
    CHECK(refusal(text_file(head + "\"extras\":[" + many("[]", 1'000'000) + "]}")).code != ErrorCode::internal);
    // A thousand primitives, each with the same hundred thousand vertices; then a mesh of ten thousand primitives, placed 27,000 times.
    TriangleFile file;
    file.bin.resize(12 * 99999);
    file.views = R"({"buffer":0,"byteLength":1199988})";
    file.accessors = R"({"bufferView":0,"componentType":5126,"count":99999,"type":"VEC3"})";
    file.primitive = "}," + many(R"({"attributes":{"POSITION":0}})", 30'000) + R"(,{"attributes":{"POSITION":0})";
    CHECK(refusal(file.file()).code == ErrorCode::limit);
    TriangleFile placed;
    placed.primitive = "}," + many(R"({"attributes":{"POSITION":0}})", 300'000) + R"(,{"attributes":{"POSITION":0})";
    std::string json = placed.json();
    json = replaced(json, "\"nodes\":[{\"mesh\":0}]", "\"nodes\":[" + many("{\"mesh\":0}", 300'000) + "]");
    json = replaced(json, "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],", "");
    CHECK(refusal(glb(json, placed.bin)).code == ErrorCode::limit);
    CHECK(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < 60.0);  // 2 s each; slack for sanitizers
}
