// Files that break a rule of glTF and leave no doubt of what they mean: viewers draw them, and so does the loader, with a warning that
// names the place. The strict rules refuse them.
#include "tests/io/gltf_builder.hpp"
#include "tests/io/png_maker.hpp"
#include "tests/support/system.hpp"

#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <tuple>

using namespace halflit;
using namespace halflit::test;

namespace {

struct Case {
    const char* name;
    Bytes file;
    const char* warning;  // a part of one
    std::function<void(const LoadedScene&)> check;
};

std::string triangle_with(std::string_view from, std::string_view to) { return replaced(TriangleFile().json(), from, to); }

Bytes triangle_file(std::string_view from, std::string_view to) { return glb(triangle_with(from, to), TriangleFile().bin); }

/// The file with the number at a byte changed.
Bytes with_number(Bytes file, std::size_t at, std::uint32_t add) {
    put<std::uint32_t>(file, at, u32_of(file, at) + add);
    return file;
}

Bytes unpadded() {
    std::string json = TriangleFile().json();
    while (json.size() % 4 != 2) json += ' ';
    Bytes file = glb(json, TriangleFile().bin);
    file.erase(file.begin() + static_cast<std::ptrdiff_t>(20 + json.size()), file.begin() + static_cast<std::ptrdiff_t>(22 + json.size()));
    put<std::uint32_t>(file, 8, static_cast<std::uint32_t>(file.size()));
    put<std::uint32_t>(file, 12, static_cast<std::uint32_t>(json.size()));
    return file;
}

Bytes with_attribute(const char* name, const Bytes& data, const std::string& accessor) {
    TriangleFile file;
    const int index = file.add(data, accessor);
    file.attributes += fmt::format(",\"{}\":{}", name, index);
    return file.file();
}

Bytes with_nodes(const std::string& nodes, const std::string& roots) {
    return glb(
        replaced(triangle_with("\"nodes\":[{\"mesh\":0}]", "\"nodes\":[" + nodes + "]"), "\"nodes\":[0]", "\"nodes\":[" + roots + "]"),
        TriangleFile().bin);
}

Bytes truncated(std::size_t bytes) {
    Bytes file = TriangleFile().file();
    file.resize(file.size() - bytes);
    return file;
}

}  // namespace

TEST_CASE("tolerance: what viewers draw is drawn with a warning, and refused by the strict rules", "[io]") {
    Bytes two_normals, colors;
    append<float>(two_normals, {0, 0, 1, 0, 0, 1});
    append<std::uint8_t>(colors, {255, 0, 0, 0, 0, 255, 0, 0, 51, 0, 255, 0});
    const auto none = [](const LoadedScene&) {};
    const auto at_x = [](float x) {
        return [x](const LoadedScene& loaded) { CHECK(loaded.scene.instances.at(0).world_from_object.c[3].x == x); };
    };
    const Case cases[] = {
        {"length of the header", with_number(TriangleFile().file(), 8, 40), "GLB: header: length is", none},
        {"chunks behind the length", with_number(TriangleFile().file(), 8, -8u), "8 bytes after the length that the header gives, read",
         none},
        {"length of a chunk", with_number(TriangleFile().file(), 20 + u32_of(TriangleFile().file(), 12), 12), "chunk 1: length is", none},
        {"chunk that is not padded", unpadded(), "chunk 0: length must be a multiple of 4", none},
        {"byte that is not UTF-8", triangle_file("{\"mesh\":0}", "{\"mesh\":0,\"name\":\"T\xfcr\"}"), "the byte \"\\xfc\" is not UTF-8",
         [](const LoadedScene& loaded) { CHECK(loaded.nodes.at(0).name == "T?r"); }},
        {"key twice", triangle_file("{\"mesh\":0}", R"({"translation":[1,0,0],"mesh":0,"translation":[2,0,0]})"),
         "the key \"translation\" is there twice, the last one is read", at_x(2)},
        {"list twice", triangle_file("\"meshes\":", R"("meshes":[{"primitives":[]},{"primitives":[]}],"meshes":)"),
         "the key \"meshes\" is there twice", [](const LoadedScene& loaded) { CHECK(loaded.info.meshes == 1); }},
        {"null", triangle_file("{\"mesh\":0}", R"({"mesh":0,"skin":null,"translation":null,"name":null})"),
         "expected an integer, found null, read as if it were not there", none},
        {"sampler that is null",
         triangle_file("\"nodes\":[{", R"("animations":[{"samplers":[{"input":0,"output":0}],"channels":[{"sampler":null,)"
                                       R"("target":{"node":0,"path":"translation"}}]}],"nodes":[{)"),
         "samplers[-1] is used, but there are 1; the animation is left out", none},
        {"comment in front", glb("// by hand\n" + TriangleFile().json(), TriangleFile().bin), "a comment", none},
        {"byte order mark", glb("\xEF\xBB\xBF" + TriangleFile().json(), TriangleFile().bin), "byte order mark", none},
        {"version", triangle_file("\"2.0\"", "\"2\""), nullptr, none},
        {"no asset", triangle_file("\"asset\":{\"version\":\"2.0\"},", ""), "expected the key \"asset\"", none},
        {"buffer longer than its data", triangle_file("\"byteLength\":36}],\"bufferViews\"", "\"byteLength\":39}],\"bufferViews\""),
         nullptr, none},
        {"fewer normals", with_attribute("NORMAL", two_normals, R"("componentType":5126,"count":2,"type":"VEC3")"), "NORMAL is left out",
         [](const LoadedScene& loaded) { CHECK(loaded.scene.meshes.at(0).positions.size() == 3); }},
        {"bytes of colours that are not normalized", with_attribute("COLOR_0", colors, R"("componentType":5121,"count":3,"type":"VEC4")"),
         "read as normalized", [](const LoadedScene& loaded) { CHECK(loaded.scene.meshes.at(0).colors.at(2).x == 51 / 255.0f); }},
        {"matrix beside a translation",
         triangle_file("{\"mesh\":0}", R"({"mesh":0,"translation":[3,0,0],"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,7,0,0,1]})"),
         "they exclude each other, ignored", at_x(3)},
        {"two parents", with_nodes(R"({"mesh":0},{"children":[0],"translation":[5,0,0]},{"children":[0],"translation":[9,0,0]})", "2,1"),
         "nodes[2].children: node 0 is a child of node 1 already; this link is left out", at_x(5)},
        {"its own ancestor", with_nodes(R"({"mesh":0,"children":[1]},{"children":[0]})", "0"), "the node is its own ancestor", none},
        {"child out of range", with_nodes(R"({"mesh":0,"children":[7]})", "0"), "index 7, but the file has 1 nodes, ignored", none},
        {"required extension",
         triangle_file("\"asset\"", R"("extensionsUsed":["KHR_xmp_json_ld"],"extensionsRequired":["KHR_xmp_json_ld"],"asset")"),
         "KHR_xmp_json_ld is not supported, drawn without it", none},
        {"skin that is not there", triangle_file("{\"mesh\":0}", R"({"mesh":0,"skin":3})"), "index 3, but the file has 0 skins, ignored",
         none},
        {"trailing commas", triangle_file("{\"mesh\":0}", "{\"mesh\":0,},"), "expected a key in double quotes, found \"}\" (and 1 more",
         none},
        {"commas alone", triangle_file("\"nodes\":[{", "\"extras\":[, , ],\"nodes\":[,,{"), "expected a JSON value, found \",\"", none},
        {"comments", triangle_file("{\"mesh\":0}", "/* a * / */ {\"mesh\":0 // it\n}"), "a comment", none},
        {"numbers of other languages", triangle_file("{\"mesh\":0}", "{\"mesh\":00,\"translation\":[+3.,.5,-01e0]}"),
         "(and 3 more such places)", at_x(3)},
        {"numbers that are not finite",
         triangle_file("{\"mesh\":0}", R"({"mesh":0,"translation":[5,-nan(ind),1.#INF],"extras":[NaN,-Infinity,inf,-1.#IND00,1.#QNAN]})"),
         "found \"nan\" (and 6 more such places), which is no JSON", at_x(0)},
        {"a number beyond double", triangle_file("{\"mesh\":0}", R"({"mesh":0,"translation":[5,1e999,1],"extras":[-1e999]})"),
         "the number 1e999 is outside the range of double (and 1 more such places), which is no JSON", at_x(0)},
        {"a number beyond double that is not used", triangle_file("{\"mesh\":0}", R"({"mesh":0,"extras":1e999})"), "the number 1e999",
         none},
        {"words of Python",
         triangle_file(R"("meshes":[{"primitives":[{)", R"("materials":[{"doubleSided":True,"extras":FALSE}],)"
                                                        R"("meshes":[{"extras":None,"primitives":[{"material":0,)"),
         "expected a JSON value, found \"True\" (and 2 more such places)",
         [](const LoadedScene& loaded) { CHECK(loaded.scene.materials.at(0).double_sided); }},
        {"a weight that is not finite", triangle_file("{\"primitives\"", R"({"weights":[NaN,1],"primitives")"), "found \"NaN\"", none},
        {"control character", triangle_file("{\"mesh\":0}", "{\"mesh\":0,\"name\":\"a\tb\"}"), "a control character in a string",
         [](const LoadedScene& loaded) { CHECK(loaded.nodes.at(0).name == "a\tb"); }},
        {"path of Windows", triangle_file("{\"mesh\":0}", R"({"mesh":0,"name":"C:\\parts\\united\\x.png"})"), nullptr, none},
        {"backslashes", triangle_file("{\"mesh\":0}", R"({"mesh":0,"name":"C:\Users\ud800\x"})"), "expected an escape sequence",
         [](const LoadedScene& loaded) { CHECK(loaded.nodes.at(0).name == "C:\\Users\xEF\xBF\xBD\\x"); }},
        {"material that is not there", triangle_file("}}]", R"(},"material":4}])"), "index 4, but the file has 0 materials, ignored", none},
    };
    for (const Case& c : cases) {
        INFO(c.name);
        const LoadedScene loaded = load_ok(c.file);
        CHECK(loaded.info.triangles_drawn == 1);
        if (c.warning != nullptr) {
            CHECK_FALSE(load(c.file));
            std::string all;
            for (const std::string& warning : loaded.warnings) all += warning + "\n";
            INFO(all);
            CHECK(all.find(c.warning) != std::string::npos);
        }
        c.check(loaded);
    }
}

TEST_CASE("tolerance: a primitive that cannot be read is left out, and a file of which nothing is left is refused", "[io]") {
    const std::string one = R"({"attributes":{"POSITION":0}})";
    const auto with_primitives = [&](const std::string& list) { return triangle_file(one, list); };
    for (const char* bad : {R"({"attributes":{"POSITION":9}})", R"({"attributes":{"POSITION":0},"indices":9})",
                            R"({"attributes":{"POSITION":0},"indices":"a"})", R"({"attributes":{"POSITION":0},"indices":0})"}) {
        INFO(bad);
        const LoadedScene loaded = load_ok(with_primitives(one + "," + bad));
        CHECK(loaded.info.triangles_drawn == 1);
        CHECK_FALSE(loaded.warnings.empty());
        CHECK_FALSE(load(with_primitives(one + "," + bad)));
        const auto alone = load(with_primitives(bad), {});
        REQUIRE_FALSE(alone);
        CHECK(alone.error().code == ErrorCode::bad_input);
        CHECK(alone.error().message.find("meshes[0].primitives[0]") != std::string::npos);
    }
    // A file that was cut off is drawn as far as it goes.
    CHECK_FALSE(load(truncated(12), {}));  // one triangle alone, of which a vertex is gone
    TriangleFile file;
    file.accessors = R"({"bufferView":0,"componentType":5126,"count":6,"type":"VEC3"})";
    file.views = R"({"buffer":0,"byteLength":72})";
    append<float>(file.bin, {0, 0, 1, 1, 0, 1, 0, 1, 1});
    Bytes cut = file.file();
    cut.resize(cut.size() - 20);
    CHECK(load_ok(cut).info.triangles_drawn == 1);
    CHECK_FALSE(load(cut));
}

TEST_CASE(
    "tolerance: directions of length 0 are made anew, those among others become their triangles', and very long ones keep their direction",
    "[io]") {
    Bytes zeros, one_zero, tangents;
    append<float>(zeros, {0, 0, 0, 0, 0, 0, 0, 0, 0});
    append<float>(one_zero, {1, 0, 0, 0, 0, 0, 1, 0, 0});
    append<float>(tangents, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
    const std::string vec3 = R"("componentType":5126,"count":3,"type":"VEC3")";
    const Mesh flat = load_ok(with_attribute("NORMAL", zeros, vec3)).scene.meshes.at(0);
    CHECK(flat.normals.at(0) == Vec3f{0, 0, 1});
    const Mesh mended = load_ok(with_attribute("NORMAL", one_zero, vec3)).scene.meshes.at(0);
    CHECK(mended.normals == std::vector<Vec3f>{{1, 0, 0}, {0, 0, 1}, {1, 0, 0}});
    // A square beyond float is no lack of a direction.
    Bytes very_long;
    append<float>(very_long, {3e38f, 0, 0, 0, -2e38f, 0, 0, 0, 1e16f});
    CHECK(load_ok(with_attribute("NORMAL", very_long, vec3)).scene.meshes.at(0).normals ==
          std::vector<Vec3f>{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}});
    TriangleFile file;
    const int normal = file.add(one_zero, vec3), tangent = file.add(tangents, R"("componentType":5126,"count":3,"type":"VEC4")");
    file.attributes += fmt::format(",\"NORMAL\":{},\"TANGENT\":{}", normal, tangent);
    CHECK(load_ok(file.file()).scene.meshes.at(0).tangents.empty());
}

TEST_CASE("tolerance: a value that is not finite is that vertex' alone, and refused by the strict rules", "[io]") {
    const std::string vec2 = R"("componentType":5126,"count":3,"type":"VEC2")", vec3 = R"("componentType":5126,"count":3,"type":"VEC3")",
                      vec4 = R"("componentType":5126,"count":3,"type":"VEC4")";
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
        Bytes normals, tangents, uv, colors, deltas;
        append<float>(normals, {0, bad, 1, 0, 1, 0, 0, 1, 0});
        append<float>(tangents, {bad, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, -1});
        append<float>(uv, {0, 0, 2, 0, bad, 3});
        append<float>(colors, {.5f, 0, 0, .5f, 1, bad, 0, 1, 0, 0, 1, 1});
        append<float>(deltas, {0, 0, bad, 0, 0, 1, 0, 0, 2});
        TriangleFile file;
        file.attributes += fmt::format(",\"NORMAL\":{},\"TANGENT\":{},\"TEXCOORD_0\":{},\"COLOR_0\":{}", file.add(normals, vec3),
                                       file.add(tangents, vec4), file.add(uv, vec2), file.add(colors, vec4));
        const std::string target = fmt::format("}},\"targets\":[{{\"POSITION\":{}}}]}}],\"weights\":[1]", file.add(deltas, vec3));
        const LoadedScene loaded = load_ok(glb(replaced(file.json(), "}}]", target), file.bin));
        const Mesh& mesh = loaded.scene.meshes.at(0);
        CHECK(mesh.normals == std::vector<Vec3f>{{0, 0, 1}, {0, 1, 0}, {0, 1, 0}});
        CHECK(mesh.tangents == std::vector<Vec4f>{{1, 0, 0, 1}, {0, 0, 1, 1}, {0, 0, 1, -1}});
        CHECK(mesh.uv0 == std::vector<Vec2f>{{0, 0}, {2, 0}, {0, 0}});
        CHECK(mesh.colors == std::vector<Vec4f>{{.5f, 0, 0, .5f}, {1, 1, 1, 1}, {0, 0, 1, 1}});
        CHECK(mesh.positions == std::vector<Vec3f>{{0, 0, 0}, {1, 0, 1}, {0, 1, 2}});
        CHECK(loaded.warnings.size() == 5);
        for (const auto& [name, data, type] :
             {std::tuple{"NORMAL", &normals, &vec3}, {"TEXCOORD_0", &uv, &vec2}, {"COLOR_0", &colors, &vec4}}) {
            const auto refused = load(with_attribute(name, *data, *type));
            REQUIRE_FALSE(refused);
            CHECK(refused.error().message.find(name) != std::string::npos);
        }
    }
}

TEST_CASE("tolerance: files named by paths of another computer are found beside the model, and nothing else is", "[io]") {
    const TemporaryFolder root;
    const auto write = [&](const char* name, const Bytes& bytes) {
        root.write(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    };
    write("model/textures/plain.png", plain_png(2, 2, 255, 0, 0));
    write("model/Points.bin", TriangleFile().bin);
    write("secret.png", plain_png(2, 2, 0, 255, 0));
    const std::string folder = (root / "model").string();
    const auto loaded = [&](const std::string& picture, const std::string& buffer) {
        const std::string text =
            replaced(triangle_with("\"byteLength\":36}],\"bufferViews\"", "\"byteLength\":36,\"uri\":\"" + buffer + "\"}],\"bufferViews\""),
                     "}}]", "},\"material\":0}]");
        return load_ok(to_bytes(text.substr(0, text.size() - 1) +
                                R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[{"source":0}],)"
                                R"("images":[{"uri":")" +
                                picture + "\"}]}"),
                       {}, folder);
    };
    for (const char* path : {"C:/Users/me/", "c:\\\\Users\\\\", "C:\\Users\\", "file:///home/me/", "file://host/a/", "FILE:", "/home/me/",
                             "\\\\\\\\server\\\\"}) {
        INFO(path);
        const LoadedScene found = loaded(std::string(path) + "PLAIN.png", std::string(path) + "points.bin");
        CHECK(found.scene.textures.size() == 1);
        CHECK(found.scene.materials.at(0).textures[TextureSlot::base_color].used());
        CHECK(found.info.triangles_drawn == 1);
        CHECK_FALSE(found.warnings.empty());
        CHECK_FALSE(loaded(std::string(path) + "secret.png", "Points.bin").scene.materials.at(0).textures[TextureSlot::base_color].used());
        CHECK_FALSE(
            loaded(std::string(path) + "../secret.png", "Points.bin").scene.materials.at(0).textures[TextureSlot::base_color].used());
    }
    for (const char* other : {"http://host/plain.png", "file:///../../secret.png", "file:..", "C:..", "file:", "C:", "file:///"})
        CHECK_FALSE(loaded(other, "Points.bin").scene.materials.at(0).textures[TextureSlot::base_color].used());
}

TEST_CASE("tolerance: the sides of a skinned mesh are by the sign of its node's transform", "[io]") {
    Bytes joints, weights;
    append<std::uint8_t>(joints, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    append<float>(weights, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    for (const float sign : {1.0f, -1.0f}) {
        TriangleFile file;
        const int joint = file.add(joints, R"("componentType":5121,"count":3,"type":"VEC4")");
        const int weight = file.add(weights, R"("componentType":5126,"count":3,"type":"VEC4")");
        file.attributes += fmt::format(",\"JOINTS_0\":{},\"WEIGHTS_0\":{}", joint, weight);
        file.rest = R"(,"skins":[{"joints":[1]}])";
        const std::string nodes = fmt::format("{{\"mesh\":0,\"skin\":0,\"scale\":[{},1,1]}},{{\"scale\":[{},1,1]}}", sign, sign);
        const Mesh mesh = load_ok(glb(replaced(replaced(file.json(), "{\"mesh\":0}", nodes), "\"nodes\":[0]", "\"nodes\":[0,1]"), file.bin))
                              .scene.meshes.at(0);
        // Seen from +z in both, as the mirrored triangle turns.
        const auto at = [&](std::size_t i) { return mesh.positions.at(mesh.indices.at(i)); };
        CHECK(cross(at(1) - at(0), at(2) - at(0)).z > 0);
    }
}

TEST_CASE("tolerance: vertices with weights that are not finite or negative are counted, not their weights", "[io]") {
    Bytes joints, weights;
    append<std::uint8_t>(joints, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    append<float>(weights, {1, nan, nan, nan, 1, -1, -1, 0, 1, 0, 0, 0});
    TriangleFile file;
    const int joint = file.add(joints, R"("componentType":5121,"count":3,"type":"VEC4")");
    const int weight = file.add(weights, R"("componentType":5126,"count":3,"type":"VEC4")");
    file.attributes += fmt::format(",\"JOINTS_0\":{},\"WEIGHTS_0\":{}", joint, weight);
    file.rest = R"(,"skins":[{"joints":[0]}])";
    const LoadedScene loaded = load_ok(glb(replaced(file.json(), "{\"mesh\":0}", "{\"mesh\":0,\"skin\":0}"), file.bin));
    for (const char* part : {"1 of 3 vertices have weights that are not finite", "1 of 3 vertices have negative weights"})
        CHECK(std::any_of(loaded.warnings.begin(), loaded.warnings.end(),
                          [&](const std::string& warning) { return warning.find(part) != std::string::npos; }));
}

TEST_CASE("tolerance: an avatar of VRM 0.x faces back, one of VRM 1.0 does not", "[io]") {
    CHECK(load_ok(triangle_file("\"asset\"", R"("extensionsUsed":["VRM"],"asset")")).scene.faces_back);
    CHECK_FALSE(load_ok(triangle_file("\"asset\"", R"("extensionsUsed":["VRMC_vrm"],"asset")")).scene.faces_back);
}

TEST_CASE("tolerance: an animation that begins without size is drawn at another time", "[io]") {
    TriangleFile file;
    Bytes times, scales;
    append<float>(times, {0, 2});
    append<float>(scales, {0, 0, 0, 4, 4, 4});
    const int input = file.add(times, R"("componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[2])");
    const int output = file.add(scales, R"("componentType":5126,"count":2,"type":"VEC3")");
    file.rest = fmt::format(
        R"(,"animations":[{{"channels":[{{"sampler":0,"target":{{"node":0,"path":"scale"}}}}],"samplers":[{{"input":{},"output":{}}}]}}])",
        input, output);
    CHECK(load_ok(file.file()).scene.instances.at(0).world_from_object.c[0].x == 2.0f);
    CHECK(load_ok(file.file(), strictly()).scene.instances.at(0).world_from_object.c[0].x == 0.0f);
}

TEST_CASE("tolerance: an animation that hides all is left out, unless it was asked for", "[io]") {
    Bytes times, scales, hidden;
    append<float>(times, {0, 2});
    append<float>(scales, {0, 0, 0, 0, 0, 0});
    append<std::uint8_t>(hidden, {0, 0, 0, 0});
    TriangleFile file;
    const int input = file.add(times, R"("componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[2])");
    const int scale = file.add(scales, R"("componentType":5126,"count":2,"type":"VEC3")");
    const int visible = file.add(hidden, R"("componentType":5121,"count":2,"type":"SCALAR")");
    constexpr const char* kVisible =
        R"("path":"pointer","extensions":{"KHR_animation_pointer":{"pointer":"/nodes/0/extensions/KHR_node_visibility/visible"}})";
    for (const auto& [target, output] : {std::pair{R"("node":0,"path":"scale")", scale}, {kVisible, visible}}) {
        file.rest = fmt::format(R"(,"animations":[{{"channels":[{{"sampler":0,"target":{{{}}}}}],"samplers":[{{"input":{},"output":{},)"
                                R"("interpolation":"STEP"}}]}}])",
                                target, input, output);
        const LoadedScene loaded = load_ok(file.file());
        CHECK(loaded.scene.instances.at(0).world_from_object == Mat4{});
        CHECK(loaded.scene.meshes.at(0).indices.size() == 3);
        CHECK(loaded.animation == -1);
        CHECK(loaded.warnings.back() == "animations[0]: hides all; drawn without it");
        LoadOptions asked;
        asked.animation = "0";
        CHECK(load_ok(file.file(), asked).animation == 0);
    }
}
