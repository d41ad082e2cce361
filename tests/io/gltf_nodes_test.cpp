#include "sh/mat4.hpp"
#include "sh/trig.hpp"
#include "tests/io/gltf_builder.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

using namespace halflit;
using namespace halflit::test;

namespace {

/// A file with a one-triangle mesh 0 and the given nodes and scenes.
Bytes with_nodes(const std::string& nodes, const std::string& scenes, const std::string& rest = "") {
    const TriangleFile triangle;
    return glb(std::string("{") + kAsset + ",\"buffers\":[{\"byteLength\":36}],\"bufferViews\":[" + triangle.views + "],\"accessors\":[" +
                   triangle.accessors + R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[)" + nodes + "]" +
                   (scenes.empty() ? "" : ",\"scenes\":[" + scenes + "]") + rest + "}",
               triangle.bin);
}

void check_close(const Mat4& found, const Mat4& wanted) {
    for (int j = 0; j < 4; ++j) {
        INFO("column " << j);
        CHECK(found.c[j].x == Approx(wanted.c[j].x).margin(1e-6));
        CHECK(found.c[j].y == Approx(wanted.c[j].y).margin(1e-6));
        CHECK(found.c[j].z == Approx(wanted.c[j].z).margin(1e-6));
        CHECK(found.c[j].w == wanted.c[j].w);
    }
}

std::string refusal(const Bytes& file, ErrorCode code = ErrorCode::bad_input) {
    const auto loaded = load(file);
    REQUIRE(!loaded);
    CHECK(loaded.error().code == code);
    return loaded.error().message;
}

}  // namespace

TEST_CASE("nodes: translation, rotation and scale are T R S, down the tree", "[io]") {
    const std::string nodes =
        R"({"translation":[1,2,3],"children":[1]},{"rotation":[0,0,0.70710678118654757,0.70710678118654757],"scale":[2,3,-4],"mesh":0})";
    const LoadedScene loaded = load_ok(with_nodes(nodes, R"({"nodes":[0]})"));
    REQUIRE(loaded.scene.instances.size() == 1);
    // A quarter turn about z: x -> y, y -> -x, after the scale.
    check_close(loaded.scene.instances[0].world_from_object, {{{0, 2, 0, 0}, {-3, 0, 0, 0}, {0, 0, -4, 0}, {1, 2, 3, 1}}});
}

TEST_CASE("nodes: a matrix is taken column by column", "[io]") {
    const LoadedScene loaded = load_ok(with_nodes(R"({"matrix":[1,2,3,0,4,5,6,0,7,8,9,0,10,11,12,1],"mesh":0})", ""));
    CHECK(loaded.scene.instances.at(0).world_from_object == Mat4{{{1, 2, 3, 0}, {4, 5, 6, 0}, {7, 8, 9, 0}, {10, 11, 12, 1}}});
    CHECK(refusal(with_nodes(R"({"matrix":[1,2,3],"mesh":0})", "")).find("nodes[0].matrix") != std::string::npos);
}

TEST_CASE("nodes: the default scene is drawn, else the first, else all roots", "[io]") {
    const std::string nodes =
        R"({"mesh":0,"translation":[1,0,0]},{"mesh":0,"translation":[2,0,0]},{"children":[3]},{"mesh":0,"translation":[3,0,0]})";
    const auto drawn = [&](const std::string& scenes, const std::string& rest) {
        std::vector<float> x;
        const LoadedScene loaded = load_ok(with_nodes(nodes, scenes, rest));
        for (const Instance& i : loaded.scene.instances) x.push_back(i.world_from_object.c[3].x);
        return x;
    };
    const std::string scenes = R"({"nodes":[2,0]},{"nodes":[1]})";
    CHECK(drawn(scenes, ",\"scene\":1") == std::vector<float>{2});
    CHECK(drawn(scenes, "") == std::vector<float>{3, 1});
    CHECK(drawn("", "") == std::vector<float>{1, 2, 3});
    CHECK(refusal(with_nodes(nodes, scenes, ",\"scene\":2")).find("scene") != std::string::npos);
}

TEST_CASE("nodes: cycles, own children and second parents are refused", "[io]") {
    CHECK(refusal(with_nodes(R"({"children":[0]})", R"({"nodes":[0]})")).find("own child") != std::string::npos);
    CHECK(refusal(with_nodes(R"({"children":[1]},{"children":[2]},{"children":[0]})", R"({"nodes":[0]})")).find("ancestor") !=
          std::string::npos);
    CHECK(refusal(with_nodes(R"({},{"children":[2]},{"children":[1]})", R"({"nodes":[0]})")).find("ancestor") != std::string::npos);
    CHECK(refusal(with_nodes(R"({"children":[2]},{"children":[2]},{"mesh":0})", R"({"nodes":[0]})")).find("child of node 0") !=
          std::string::npos);
    CHECK(refusal(with_nodes(R"({"children":[1,1]},{"mesh":0})", R"({"nodes":[0]})")).find("already") != std::string::npos);
    CHECK(refusal(with_nodes(R"({"children":[7]})", "")).find("nodes[0].children[0]") != std::string::npos);
}

TEST_CASE("nodes: a chain of a million nodes is walked", "[io]") {
    std::string nodes;
    const int count = 1'000'000;
    for (int i = 0; i + 1 < count; ++i) nodes += "{\"children\":[" + std::to_string(i + 1) + "],\"translation\":[1,0,0]},";
    nodes += R"({"mesh":0,"translation":[1,0,0]})";
    LoadOptions as_stored;
    as_stored.recentre = false;
    const LoadedScene loaded = load_ok(with_nodes(nodes, R"({"nodes":[0]})"), as_stored);
    REQUIRE(loaded.scene.instances.size() == 1);
    CHECK(loaded.scene.instances[0].world_from_object.c[3].x == 1e6f);
}

TEST_CASE("nodes: a mesh whose transform leaves the range of float is not drawn, with a warning", "[io]") {
    const LoadedScene loaded =
        load_ok(with_nodes(R"({"scale":[1e300,1,1],"children":[1]},{"scale":[1e300,1,1],"mesh":0},{"mesh":0})", R"({"nodes":[0,2]})"));
    CHECK(loaded.scene.instances.size() == 1);
    CHECK(loaded.warnings.size() == 1);
}

TEST_CASE("nodes: a file without anything to draw loads with a warning", "[io]") {
    CHECK(load_ok(with_nodes("{}", R"({"nodes":[0]})"), strictly()).warnings == std::vector<std::string>{"the model has nothing to draw"});
}

TEST_CASE("nodes: where the scene has no mesh, what has one is drawn, unless a scene was asked for", "[io]") {
    const auto drawn = [](const std::string& nodes, const std::string& scenes, const LoadOptions& options = {}) {
        std::vector<float> out;  // x of the instances
        for (const Instance& instance : load_ok(with_nodes(nodes, scenes), options).scene.instances)
            out.push_back(instance.world_from_object.c[3].x);
        return out;
    };
    LoadOptions first;
    first.scene = "0";
    const std::string two = R"({},{"mesh":0,"translation":[1,0,0]},{"mesh":0,"translation":[2,0,0]},{"children":[1]})";
    CHECK(drawn(two, R"({"nodes":[0]},{},{"nodes":[0,3]},{"nodes":[2]})") == std::vector<float>{1});
    CHECK(drawn(two, R"({"nodes":[0]},{"nodes":[3]})", first).empty());
    CHECK(drawn(two, R"({"nodes":[0]},{"nodes":[3]})", strictly()).empty());
    CHECK(drawn(two, R"({"nodes":[0]})") == std::vector<float>{2, 1});  // in the order of the roots
    CHECK(drawn(R"({"translation":[5,0,0]})", R"({"nodes":[0]})") == std::vector<float>{0});
    CHECK(drawn(R"({"translation":[5,0,0]})", "{}") == std::vector<float>{0});
    CHECK(load_ok(with_nodes("{}", "{}")).nodes.size() == 2);  // that of the mesh is behind the file's
}

TEST_CASE("nodes: cameras are placed without their nodes' scale", "[io]") {
    const std::string cameras =
        R"(,"cameras":[{"type":"perspective","name":"front","perspective":{"yfov":0.5,"znear":0.25,"aspectRatio":1.5}},)"
        R"({"type":"orthographic","orthographic":{"xmag":2,"ymag":-3,"znear":0,"zfar":10}},)"
        R"({"type":"perspective","perspective":{"yfov":0.5,"znear":-1}}])";
    // A quarter turn about y carries -z to -x.
    const std::string nodes =
        R"({"camera":0,"translation":[1,2,3],"rotation":[0,0.70710678118654757,0,0.70710678118654757],"scale":[5,-7,2]},)"
        R"({"camera":1,"name":"top"},{"camera":2})";
    const LoadedScene loaded = load_ok(with_nodes(nodes, "", cameras));
    REQUIRE(loaded.scene.cameras.size() == 2);
    const Camera& c = loaded.scene.cameras[0];
    CHECK(c.name == "front");
    CHECK(!c.orthographic);
    CHECK(c.fov_y_rad == 0.5f);
    CHECK(c.aspect == 1.5f);
    CHECK(c.near_z == 0.25f);
    CHECK(c.far_z == 0.0f);
    check_close(c.world_from_camera, {{{0, 0, 1, 0}, {0, -1, 0, 0}, {1, 0, 0, 0}, {1, 2, 3, 1}}});
    CHECK(determinant3(c.world_from_camera) == Approx(1.0));
    CHECK(loaded.scene.cameras[1].name == "top");
    CHECK(loaded.scene.cameras[1].orthographic);
    CHECK(loaded.scene.cameras[1].half_width == 2.0f);
    CHECK(loaded.scene.cameras[1].half_height == 3.0f);
    CHECK(loaded.info.cameras == 3);
}

TEST_CASE("nodes: lights shine along -z, with colour times intensity over pi", "[io]") {
    const std::string lights = R"(,"extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[)"
                               R"({"type":"directional","color":[1,0.5,0],"intensity":3},{"type":"point","range":7,"intensity":2},)"
                               R"({"type":"spot","spot":{"innerConeAngle":0.25,"outerConeAngle":0.5}},{"type":"area"}]}})";
    const std::string nodes =
        R"({"extensions":{"KHR_lights_punctual":{"light":0}},"rotation":[0,0.70710678118654757,0,0.70710678118654757],"scale":[3,3,3]},)"
        R"({"extensions":{"KHR_lights_punctual":{"light":1}},"translation":[4,5,6]},{"extensions":{"KHR_lights_punctual":{"light":2}}},)"
        R"({"extensions":{"KHR_lights_punctual":{"light":3}}})";
    const LoadedScene loaded = load_ok(with_nodes(nodes, "", lights));
    REQUIRE(loaded.scene.lights.size() == 3);
    const Light &sun = loaded.scene.lights[0], &point = loaded.scene.lights[1], &spot = loaded.scene.lights[2];
    CHECK(sun.type == LightType::directional);
    CHECK(sun.color_linear.x == Approx(3 / kPi));
    CHECK(sun.color_linear.y == Approx(1.5 / kPi));
    CHECK(sun.color_linear.z == 0.0f);
    CHECK(sun.direction_ws.x == Approx(-1.0));
    CHECK(sun.direction_ws.z == Approx(0.0).margin(1e-7));
    CHECK(point.type == LightType::point);
    CHECK(point.position_ws == Vec3f{4, 5, 6});
    CHECK(point.range == 7.0f);
    CHECK(point.color_linear.x == Approx(2 / kPi));
    CHECK(spot.type == LightType::spot);
    CHECK(spot.direction_ws == Vec3f{0, 0, -1});
    CHECK(spot.inner_cone_rad == 0.25f);
    CHECK(spot.outer_cone_rad == 0.5f);
    CHECK(refusal(with_nodes(R"({"extensions":{"KHR_lights_punctual":{"light":9}}})", "", lights)).find("9") != std::string::npos);

    std::string many;
    for (int i = 0; i < 1025; ++i) many += std::string(i > 0 ? "," : "") + R"({"extensions":{"KHR_lights_punctual":{"light":0}}})";
    refusal(with_nodes(many, "", lights), ErrorCode::limit);
}

TEST_CASE("skins: vertices follow their joints, and the transform of the mesh's own node is ignored", "[io]") {
    TriangleFile file;
    Bytes joints, weights, bind;
    append<std::uint8_t>(joints, {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0});
    append<float>(weights, {1, 0, 0, 0, 1, 0, 0, 0, 0.25f, 0.75f, 0, 0});
    append<float>(bind, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1});
    const int j = file.add(joints, R"("componentType":5121,"count":3,"type":"VEC4")"),
              w = file.add(weights, R"("componentType":5126,"count":3,"type":"VEC4")"),
              b = file.add(bind, R"("componentType":5126,"count":2,"type":"MAT4")");
    file.attributes += ",\"JOINTS_0\":" + std::to_string(j) + ",\"WEIGHTS_0\":" + std::to_string(w);
    file.rest = ",\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":" + std::to_string(b) + "}]";
    std::string json = file.json();
    const std::string nodes =
        R"("nodes":[{"mesh":0,"skin":0,"translation":[100,100,100]},{"translation":[0,10,0],"children":[2]},{"translation":[1,0,5]}])";
    json = replaced(json, "\"nodes\":[{\"mesh\":0}]", nodes);
    const LoadedScene loaded = load_ok(glb(json, file.bin));
    // Joint 0 adds (0, 10, 0); joint 1 takes 1 off x, then adds (1, 10, 5).
    CHECK(loaded.scene.meshes.at(0).positions == std::vector<Vec3f>{{0, 10, 0}, {1, 10, 5}, {0, 11, 3.75f}});
    CHECK(loaded.scene.instances.at(0).world_from_object == Mat4{});
    // Far from the origin, the instance holds the place, and the mesh keeps its shape.
    LoadOptions recentred;
    recentred.recentre = true;
    const LoadedScene far = load_ok(glb(replaced(json, "\"translation\":[0,10,0]", "\"translation\":[1e9,10,3e8]"), file.bin), recentred);
    const std::vector<Vec3f>& moved = far.scene.meshes.at(0).positions;
    CHECK(moved[1] - moved[0] == Vec3f{1, 0, 5});
    CHECK(moved[2] - moved[0] == Vec3f{0, 1, 3.75f});
    std::string bad = json;
    bad = replaced(bad, "\"joints\":[1,2]", "\"joints\":[1]");
    CHECK(refusal(glb(bad, file.bin)).find("joint 1") != std::string::npos);
}
