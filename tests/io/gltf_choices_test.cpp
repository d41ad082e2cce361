// Scenes, variants of materials, instances of a node's mesh, and sizes of lights.
#include "tests/io/gltf_builder.hpp"

#include <fmt/core.h>

#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>
#include <random>

using namespace halflit;
using namespace halflit::test;

namespace {

Error error_of(const Bytes& file, const LoadOptions& options) {
    const auto loaded = load(file, options);
    REQUIRE(!loaded);
    return loaded.error();
}

/// Scenes "front" and "2" with one node each, at x = 1 and x = 2; the file names the second one.
Bytes two_scenes() {
    const TriangleFile file;
    return glb(replaced(file.json(), R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}])",
                        R"("scene":1,"scenes":[{"name":"front","nodes":[0]},{"name":"0","nodes":[1]},{"nodes":[0,1]}],)"
                        R"("nodes":[{"mesh":0,"translation":[1,0,0]},{"mesh":0,"translation":[2,0,0]}])"),
               file.bin);
}

Bytes with_variants() {
    TriangleFile file;
    file.primitive = R"(,"material":0,"extensions":{"KHR_materials_variants":{"mappings":[{"material":1,"variants":[0,2]},)"
                     R"({"material":2,"variants":[1]}]}})";
    file.rest = R"(,"extensionsUsed":["KHR_materials_variants"],"extensions":{"KHR_materials_variants":{"variants":[{"name":"beach"},)"
                R"({"name":"street"},{"name":"night"}]}},"materials":[{"name":"a"},{"name":"b"},{"name":"c"}])";
    return file.file();
}

/// Transform of a point in float64: R (S p) + T, R from a unit quaternion by its defining product.
Vec3d placed(const double (&t)[3], const double (&q)[4], const double (&s)[3], Vec3d p) {
    const Vec3d v{p.x * s[0], p.y * s[1], p.z * s[2]}, u{q[0], q[1], q[2]};
    const double w = q[3];
    // v + 2 u x (u x v + w v)
    const auto cross = [](Vec3d a, Vec3d b) { return Vec3d{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; };
    const Vec3d inner = cross(u, v), sum{inner.x + w * v.x, inner.y + w * v.y, inner.z + w * v.z}, outer = cross(u, sum);
    return {v.x + 2 * outer.x + t[0], v.y + 2 * outer.y + t[1], v.z + 2 * outer.z + t[2]};
}

Vec3d transformed(const Mat4& m, Vec3d p) {
    const auto row = [&](auto of) {
        return double{of(m.c[0])} * p.x + double{of(m.c[1])} * p.y + double{of(m.c[2])} * p.z + double{of(m.c[3])};
    };
    return {row([](Vec4f c) { return c.x; }), row([](Vec4f c) { return c.y; }), row([](Vec4f c) { return c.z; })};
}

std::string instanced(const std::string& json, const std::string& attributes) {
    return replaced(json, R"("nodes":[{"mesh":0}])",
                    R"("nodes":[{"mesh":0,"translation":[10,0,0],"scale":[2,2,2],"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{)" +
                        attributes + "}}}}]");
}

}  // namespace

TEST_CASE("scenes: one is chosen by its name, or else by its index, and one that is not there is an error that lists them", "[io]") {
    const Bytes file = two_scenes();
    const auto x_of = [&](const std::string& scene) {
        LoadOptions options;
        options.scene = scene;
        const LoadedScene loaded = load_ok(file, options);
        CHECK(loaded.info.scene_names == std::vector<std::string>{"front", "0", ""});
        return loaded.scene.instances.at(0).world_from_object.c[3].x + static_cast<float>(100 * loaded.info.scene);
    };
    CHECK(x_of("") == 102.0f);
    CHECK(x_of("front") == 1.0f);
    CHECK(x_of("0") == 102.0f);  // a name, though it looks like an index
    CHECK(x_of("1") == 102.0f);
    CHECK(x_of("2") == 201.0f);
    for (const char* wrong : {"3", "-1", "back", "1 "}) {
        LoadOptions options;
        options.scene = wrong;
        const Error error = error_of(file, options);
        CHECK(error.code == ErrorCode::usage);
        CHECK(error.message.find("'front', '0'") != std::string::npos);
    }
}

TEST_CASE("variants: a name chooses the materials of primitives that have it, and an unknown one is an error that lists them", "[io]") {
    const Bytes file = with_variants();
    const auto material_of = [&](const std::string& variant) {
        LoadOptions options;
        options.variant = variant;
        const LoadedScene loaded = load_ok(file, options);
        CHECK(loaded.warnings.empty());
        CHECK(loaded.info.variants == std::vector<std::string>{"beach", "street", "night"});
        return loaded.scene.meshes.at(0).material;
    };
    CHECK(material_of("") == 0);
    CHECK(material_of("beach") == 1);
    CHECK(material_of("street") == 2);
    CHECK(material_of("night") == 1);
    LoadOptions options;
    options.variant = "Beach";
    const Error error = error_of(file, options);
    CHECK(error.code == ErrorCode::usage);
    CHECK(error.message.find("expected one of 'beach', 'street', 'night', found 'Beach'") != std::string::npos);
    CHECK(error_of(TriangleFile().file(), options).message.find("the file has none") != std::string::npos);
}

TEST_CASE("instancing: each instance lies where float64 puts it", "[io]") {
    std::mt19937 random(5);
    const auto unit = [&] { return static_cast<float>(random() % 20001) / 10000.0f - 1.0f; };
    constexpr int kCount = 50;
    for (const int component : {5126, 5120, 5122}) {  // of rotations: float, normalised bytes and shorts
        Bytes translations, rotations, scales;
        double t[kCount][3], q[kCount][4], s[kCount][3];
        for (int i = 0; i < kCount; ++i) {
            for (int k = 0; k < 3; ++k) {
                const float at = 9 * unit(), by = 1.5f + unit();
                append<float>(translations, {at});
                append<float>(scales, {by});
                t[i][k] = double{at};
                s[i][k] = double{by};
            }
            double length = 0;
            for (double& c : q[i]) {
                const float value = unit();
                if (component == 5126) {
                    append<float>(rotations, {value});
                    c = double{value};
                } else if (component == 5120) {
                    append<std::int8_t>(rotations, {static_cast<std::int8_t>(127 * value)});
                    c = static_cast<std::int8_t>(127 * value) / 127.0;
                } else {
                    append<std::int16_t>(rotations, {static_cast<std::int16_t>(32767 * value)});
                    c = static_cast<std::int16_t>(32767 * value) / 32767.0;
                }
                length += c * c;
            }
            for (double& c : q[i]) c /= std::sqrt(length);
        }
        TriangleFile file;
        file.rest = R"(,"extensionsUsed":["EXT_mesh_gpu_instancing"],"extensionsRequired":["EXT_mesh_gpu_instancing"])";
        const std::string members = R"("componentType":5126,"count":50,"type":"VEC3")";
        const int of_t = file.add(translations, members), of_s = file.add(scales, members);
        const int of_q = file.add(rotations, fmt::format(R"("componentType":{},"count":50,"type":"VEC4"{})", component,
                                                         component == 5126 ? "" : R"(,"normalized":true)"));
        const LoadedScene loaded =
            load_ok(glb(instanced(file.json(), fmt::format(R"("TRANSLATION":{},"ROTATION":{},"SCALE":{})", of_t, of_q, of_s)), file.bin));
        CHECK(loaded.warnings.empty());
        REQUIRE(loaded.scene.instances.size() == kCount);
        CHECK(loaded.scene.meshes.size() == 1);
        CHECK(loaded.info.triangles_drawn == kCount);
        double worst = 0;
        for (int i = 0; i < kCount; ++i)
            for (const Vec3d p : {Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0.3, -2, 1}}) {
                const Vec3d in_node = placed(t[i], q[i], s[i], p);
                const Vec3d expected{2 * in_node.x + 10, 2 * in_node.y, 2 * in_node.z};
                const Vec3d found = transformed(loaded.scene.instances[static_cast<std::size_t>(i)].world_from_object, p);
                worst = std::max({worst, std::abs(found.x - expected.x), std::abs(found.y - expected.y), std::abs(found.z - expected.z)});
            }
        CHECK(worst < 1e-5);  // coordinates up to 40 in float32; measured 3e-6
        // Posed by the nodes as they are, nothing moves; moved, all instances follow.
        Scene scene = loaded.scene;
        std::vector<Node> nodes = loaded.nodes;
        const auto unmoved = pose(nodes, scene, loaded.placement);
        REQUIRE(unmoved);
        CHECK(unmoved->changed_instances.empty());
        nodes[0].parent_from_node.origin.x += 5;
        REQUIRE(pose(nodes, scene, loaded.placement));
        for (std::size_t i = 0; i < kCount; ++i)
            CHECK(double{scene.instances[i].world_from_object.c[3].x} ==
                  Approx(double{loaded.scene.instances[i].world_from_object.c[3].x} + 5).margin(1e-5));
    }
}

TEST_CASE("instancing: other attributes are named, counts must agree, and memory has its limit", "[io]") {
    TriangleFile file;
    file.rest = R"(,"extensionsUsed":["EXT_mesh_gpu_instancing"])";
    Bytes two;
    append<float>(two, {0, 0, 0, 1, 1, 1});
    const int a = file.add(two, R"("componentType":5126,"count":2,"type":"VEC3")");
    const LoadedScene loaded = load_ok(glb(instanced(file.json(), fmt::format(R"("TRANSLATION":{},"_COLOR_0":{})", a, a)), file.bin));
    CHECK(loaded.scene.instances.size() == 2);
    REQUIRE(loaded.warnings.size() == 1);
    CHECK(loaded.warnings[0].find("_COLOR_0") != std::string::npos);
    const auto other = load(glb(instanced(file.json(), fmt::format(R"("TRANSLATION":{},"SCALE":0)", a)), file.bin));
    REQUIRE(!other);
    CHECK(other.error().message.find("SCALE") != std::string::npos);
    file.accessors += R"(,{"componentType":5126,"count":100000000,"type":"VEC3"})";
    const auto many = load(glb(instanced(file.json(), fmt::format(R"("TRANSLATION":{})", a + 1)), file.bin));
    REQUIRE(!many);
    CHECK(many.error().code == ErrorCode::limit);
}

TEST_CASE("lights: extras.halflit.size is the size of the source", "[io]") {
    const std::string extras = R"("extras":{"by":"hand","halflit":{"size":0.25}})";
    TriangleFile file;
    file.rest = R"(,"extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point",)" + extras +
                R"(},{"type":"directional",)" + extras + R"(},{"type":"point","extras":{"halflit":{}}}]}})";
    const auto light = [](int i) { return fmt::format(R"({{"extensions":{{"KHR_lights_punctual":{{"light":{}}}}}}})", i); };
    const std::string json = replaced(replaced(file.json(), R"("nodes":[0])", R"("nodes":[0,1,2,3])"), R"("nodes":[{"mesh":0}])",
                                      R"("nodes":[{"mesh":0},)" + light(0) + "," + light(1) + "," + light(2) + "]");
    const LoadedScene loaded = load_ok(glb(json, file.bin));
    REQUIRE(loaded.scene.lights.size() == 3);
    CHECK(loaded.scene.lights[0].shadow_radius == 0.25f);
    CHECK(double{loaded.scene.lights[1].shadow_radius} == Approx(0.25 * 3.14159265358979 / 180));
    CHECK(loaded.scene.lights[2].shadow_radius == 0.0f);
}
