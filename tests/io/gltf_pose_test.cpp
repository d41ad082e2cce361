// The loaded tree of nodes, and posing a scene by it: against products of matrices, and against a file written in the new pose.
#include "halflit/renderer.hpp"
#include "tests/io/gltf_builder.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <cstring>
#include <limits>
#include <string>

using namespace halflit;
using namespace halflit::test;

namespace {

const char* const kRest =
    R"(,"cameras":[{"type":"perspective","perspective":{"yfov":0.5,"znear":0.25}}],"extensionsUsed":["KHR_lights_punctual"],)"
    R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"point","range":7,"intensity":2},{"type":"directional"}]}})";

/// A file with a mesh of two primitives and the given nodes and scenes.
Bytes with_nodes(const std::string& nodes, const std::string& scenes) {
    const TriangleFile triangle;
    return glb(std::string("{") + kAsset + ",\"buffers\":[{\"byteLength\":36}],\"bufferViews\":[" + triangle.views + "],\"accessors\":[" +
                   triangle.accessors +
                   R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0}},{"attributes":{"POSITION":0}}]}],"nodes":[)" + nodes +
                   "],\"scenes\":[" + scenes + "]" + kRest + "}",
               triangle.bin);
}

/// An arm: 2 -> 1 -> 0, in this order, so that children come before their parents. The upper arm and the hand have the mesh. A camera and
/// lights hang on the hand; node 6 is not in the scene.
std::string arm(const std::string& elbow) {
    return R"({"name":"hand","mesh":0,"translation":[0,2.1,0.3],"scale":[0.7,-1.3,2],"children":[3,4,5]},{"name":"elbow",)" + elbow +
           R"(,"children":[0]},{"name":"shoulder","mesh":0,"translation":[0.1,0.2,0.3],"rotation":[0.3,0.1,-0.5,0.6],)"
           R"("children":[1]},{"name":"eye","camera":0,"rotation":[0.1,0.9,0.2,0.3]},)"
           R"({"extensions":{"KHR_lights_punctual":{"light":0}},"translation":[0.3,0.3,0.3]},)"
           R"({"extensions":{"KHR_lights_punctual":{"light":1}},"rotation":[0.7,0.1,0.2,0.3]},{"name":"elsewhere","mesh":0})";
}

const std::string kBent = R"("translation":[0.7,1.1,-0.1],"rotation":[0.2,0.3,0.1,0.9])";

LoadedScene load_arm(const std::string& elbow = kBent) { return load_ok(with_nodes(arm(elbow), R"({"nodes":[2]})")); }

bool same_bits(const Mat4& a, const Mat4& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

bool same_places(const Scene& a, const Scene& b) {
    bool same = a.instances.size() == b.instances.size() && a.cameras.size() == b.cameras.size() && a.lights.size() == b.lights.size();
    for (std::size_t i = 0; same && i < a.instances.size(); ++i)
        same = same_bits(a.instances[i].world_from_object, b.instances[i].world_from_object);
    for (std::size_t i = 0; same && i < a.cameras.size(); ++i)
        same = same_bits(a.cameras[i].world_from_camera, b.cameras[i].world_from_camera);
    for (std::size_t i = 0; same && i < a.lights.size(); ++i)
        same = std::memcmp(&a.lights[i].position_ws, &b.lights[i].position_ws, sizeof(Vec3f)) == 0 &&
               std::memcmp(&a.lights[i].direction_ws, &b.lights[i].direction_ws, sizeof(Vec3f)) == 0;
    return same;
}

/// The code and message of a pose that must be refused, and that must leave the scene as it was.
std::string refused(const std::vector<Node>& nodes, const LoadedScene& loaded) {
    Scene scene = loaded.scene;
    const auto posed = pose(nodes, scene, {});
    REQUIRE(!posed);
    CHECK(posed.error().code == ErrorCode::usage);
    CHECK(same_places(scene, loaded.scene));
    CHECK(posed.error().message.find('\n') == std::string::npos);
    return posed.error().message;
}

}  // namespace

TEST_CASE("pose: the loaded nodes are the file's, with what they place", "[io]") {
    const LoadedScene loaded = load_arm();
    const std::vector<Node>& n = loaded.nodes;
    REQUIRE(n.size() == 7);
    CHECK(n[0].name == "hand");
    CHECK(n[3].name == "eye");
    CHECK(n[4].name.empty());
    CHECK(std::vector<int>{n[0].parent, n[1].parent, n[2].parent, n[3].parent, n[4].parent, n[5].parent, n[6].parent} ==
          std::vector<int>{1, 2, -1, 0, 0, 0, -1});
    CHECK(n[1].parent_from_node.origin == Vec3d{0.7, 1.1, -0.1});  // in double, as the file has it
    CHECK(n[0].parent_from_node.y == Vec3d{0, -1.3, 0});
    CHECK(n[2].instances == std::vector<int>{0, 1});  // one for each primitive
    CHECK(n[0].instances == std::vector<int>{2, 3});
    CHECK(n[1].instances.empty());
    CHECK(n[6].instances.empty());  // not in the scene
    CHECK(n[3].camera == 0);
    CHECK(n[4].light == 0);
    CHECK(n[5].light == 1);
    CHECK(n[0].camera == -1);
    CHECK(n[0].light == -1);
}

TEST_CASE("pose: the tree as loaded gives the same bits, and nothing has moved", "[io]") {
    LoadedScene loaded = load_arm();
    const Scene before = loaded.scene;
    for (int i = 0; i < 2; ++i) {
        const auto posed = pose(loaded.nodes, loaded.scene, loaded.placement);
        REQUIRE(posed);
        CHECK(posed->changed_instances.empty());
        CHECK(posed->deformed_meshes.empty());
        CHECK(!posed->lights);
        CHECK(!posed->materials);
        CHECK(same_places(loaded.scene, before));
    }
    // Chains of numbers that float cannot hold: rounded once, at the end, by the loader and here.
    Random random(5);
    std::string nodes;
    for (int i = 0; i < 60; ++i) {
        const auto number = [&] { return std::to_string(random.real(-1, 1)); };
        nodes += std::string(i > 0 ? "," : "") + R"({"mesh":0,"translation":[)" + (i % 2 == 0 ? "-" : "") + "6378137.123456," + number() +
                 "," + number() + R"(],"rotation":[)" + number() + "," + number() + "," + number() + "," + number() + R"(],"scale":[)" +
                 number() + "," + number() + "," + number() + "]" + (i < 59 ? ",\"children\":[" + std::to_string(i + 1) + "]" : "") + "}";
    }
    LoadedScene chain = load_ok(with_nodes(nodes, R"({"nodes":[0]})"));
    REQUIRE(chain.scene.instances.size() == 120);
    const Scene chain_before = chain.scene;
    const auto posed = pose(chain.nodes, chain.scene, chain.placement);
    REQUIRE(posed);
    CHECK(posed->changed_instances.empty());
    CHECK(same_places(chain.scene, chain_before));
}

TEST_CASE("pose: a moved node moves all that hangs on it, and is reported", "[io]") {
    LoadedScene loaded = load_arm();
    const Mat4 shoulder = loaded.scene.instances[0].world_from_object;
    loaded.nodes[1].parent_from_node = translation({1, 2, 3}) * rotation({0, 1, 1}, 0.3f);
    const auto posed = pose(loaded.nodes, loaded.scene, loaded.placement);
    REQUIRE(posed);
    CHECK(posed->changed_instances == std::vector<std::size_t>{2, 3});
    CHECK(posed->lights);
    CHECK(same_bits(loaded.scene.instances[0].world_from_object, shoulder));
    const Mat4 hand =
        shoulder * translation({1, 2, 3}) * rotation({0, 1, 1}, 0.3f) * translation({0, 2.1f, 0.3f}) * scaling({0.7f, -1.3f, 2});
    for (const std::size_t i : {2, 3})
        for (int j = 0; j < 4; ++j) {
            const Vec4f found = loaded.scene.instances[i].world_from_object.c[j], wanted = hand.c[j];
            CHECK(found.x == Approx(wanted.x).margin(2e-6));
            CHECK(found.y == Approx(wanted.y).margin(2e-6));
            CHECK(found.z == Approx(wanted.z).margin(2e-6));
            CHECK(found.w == wanted.w);
        }
    const Vec4f lamp = hand * Vec4f{0.3f, 0.3f, 0.3f, 1};
    CHECK(length(loaded.scene.lights[0].position_ws - Vec3f{lamp.x, lamp.y, lamp.z}) < 3e-6f);
    const auto again = pose(loaded.nodes, loaded.scene, loaded.placement);
    REQUIRE(again);
    CHECK(again->changed_instances.empty());
    CHECK(!again->lights);
}

TEST_CASE("pose: it is what a file in that pose loads", "[io]") {
    LoadedScene loaded = load_arm();
    const LoadedScene straight = load_arm(R"("translation":[0,1.7,0],"scale":[1,2,-1])");
    REQUIRE(!same_places(loaded.scene, straight.scene));
    NodeTransform elbow;
    elbow.y = {0, 2, 0};
    elbow.z = {0, 0, -1};
    elbow.origin = {0, 1.7, 0};
    loaded.nodes[1].parent_from_node = elbow;
    REQUIRE(pose(loaded.nodes, loaded.scene, loaded.placement));
    CHECK(same_places(loaded.scene, straight.scene));
    loaded.nodes[1].parent_from_node = load_arm().nodes[1].parent_from_node;
    REQUIRE(pose(loaded.nodes, loaded.scene, loaded.placement));
    CHECK(same_places(loaded.scene, load_arm().scene));
}

TEST_CASE("pose: a prepared scene that is told the changes draws as a new one", "[io]") {
    LoadedScene loaded = load_arm();
    auto prepared = PreparedScene::make(loaded.scene);
    REQUIRE(prepared);
    Renderer renderer;
    Camera camera;
    camera.world_from_camera = look_at({3, 4, 9}, {0, 2, 0});
    Settings settings;
    settings.background_linear = {0.1f, 0.1f, 0.1f, 1};
    std::vector<std::vector<std::uint8_t>> pictures;
    for (const float angle : {0.0f, 0.5f, 1.1f}) {
        loaded.nodes[1].parent_from_node = translation({0.5f, 1, 0}) * rotation({1, 0, 1}, angle);
        const auto changes = pose(loaded.nodes, loaded.scene, loaded.placement);
        REQUIRE(changes);
        REQUIRE(prepared->update(*changes));
        std::vector<std::uint8_t> kept(4 * 80 * 60), fresh(kept.size());
        REQUIRE(renderer.render(*prepared, camera, settings, {.width = 80, .height = 60, .pixels = kept.data()}));
        REQUIRE(render(loaded.scene, camera, settings, {.width = 80, .height = 60, .pixels = fresh.data()}));
        CHECK(kept == fresh);
        pictures.push_back(kept);
    }
    CHECK(pictures[0] != pictures[1]);
    CHECK(pictures[1] != pictures[2]);
}

TEST_CASE("pose: cameras stay rigid under any scale", "[io]") {
    LoadedScene loaded = load_arm();
    loaded.nodes[0].parent_from_node = scaling({3, 0.1f, -7});
    REQUIRE(pose(loaded.nodes, loaded.scene, loaded.placement));
    const Mat4 m = loaded.scene.cameras[0].world_from_camera;
    const auto column = [&](int j) { return Vec3d{m.c[j].x, m.c[j].y, m.c[j].z}; };
    for (int j = 0; j < 3; ++j) {
        CHECK(length(column(j)) == Approx(1.0).epsilon(1e-6));
        CHECK(dot(column(j), column((j + 1) % 3)) == Approx(0.0).margin(1e-6));
    }
    CHECK(dot(cross(column(0), column(1)), column(2)) == Approx(1.0).epsilon(1e-6));
}

TEST_CASE("pose: skinned meshes stay as loaded", "[io]") {
    TriangleFile file;
    Bytes joints, weights;
    append<std::uint8_t>(joints, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    append<float>(weights, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    const int j = file.add(joints, R"("componentType":5121,"count":3,"type":"VEC4")"),
              w = file.add(weights, R"("componentType":5126,"count":3,"type":"VEC4")");
    file.attributes += ",\"JOINTS_0\":" + std::to_string(j) + ",\"WEIGHTS_0\":" + std::to_string(w);
    file.rest = R"(,"skins":[{"joints":[1]}])";
    const std::string json = replaced(file.json(), "\"nodes\":[{\"mesh\":0}]",
                                      R"("nodes":[{"mesh":0,"skin":0,"translation":[9,9,9],"children":[1]},{"translation":[0,10,0]}])");
    LoadedScene loaded = load_ok(glb(json, file.bin));
    REQUIRE(loaded.scene.instances.size() == 1);
    CHECK(loaded.nodes[0].instances.empty());
    const std::vector<Vec3f> positions = loaded.scene.meshes[0].positions;
    loaded.nodes[0].parent_from_node = loaded.nodes[1].parent_from_node = translation({5, 5, 5});
    const auto posed = pose(loaded.nodes, loaded.scene, loaded.placement);
    REQUIRE(posed);
    CHECK(posed->changed_instances.empty());
    CHECK(loaded.scene.instances[0].world_from_object == Mat4{});
    CHECK(loaded.scene.meshes[0].positions == positions);
}

TEST_CASE("pose: wrong trees are refused, and leave the scene as it was", "[io]") {
    const LoadedScene loaded = load_arm();
    const auto changed = [&](auto change) {
        std::vector<Node> nodes = loaded.nodes;
        nodes[2].parent_from_node = translation({1, 1, 1});  // which must not happen
        change(nodes);
        return refused(nodes, loaded);
    };
    constexpr int kMost = std::numeric_limits<int>::max();
    for (const int bad : {7, -2, kMost, -kMost}) {
        CHECK(changed([&](auto& n) { n[3].parent = bad; }).find("node 3") != std::string::npos);
        CHECK(changed([&](auto& n) { n[0].instances.push_back(bad); }).find("node 0") != std::string::npos);
        CHECK(changed([&](auto& n) { n[4].light = bad; }).find("node 4") != std::string::npos);
        CHECK(changed([&](auto& n) { n[5].camera = bad; }).find("node 5") != std::string::npos);
    }
    changed([](auto& n) { n[0].instances = {-1}; });
    changed([](auto& n) { n[6].parent = 6; });
    changed([](auto& n) { n[2].parent = 0; });
    changed([](auto& n) { n[2].parent = 3; });
    // A scene that has lost what the nodes place.
    Scene scene = loaded.scene;
    scene.lights.clear();
    CHECK(!pose(loaded.nodes, scene, loaded.placement));
    scene = loaded.scene;
    scene.instances.pop_back();
    CHECK(!pose(loaded.nodes, scene, loaded.placement));
    // Lights that a host adds lie behind those of the file.
    scene = loaded.scene;
    scene.lights.emplace_back();
    CHECK(pose(loaded.nodes, scene, loaded.placement));
    CHECK(pose({}, scene, {}));
}

TEST_CASE("pose: numbers beyond float are the renderer's to drop", "[io]") {
    LoadedScene loaded = load_arm();
    loaded.nodes[2].parent_from_node.x = {1e300, 0, 0};
    loaded.nodes[2].parent_from_node.origin.y = std::numeric_limits<double>::quiet_NaN();
    const auto posed = pose(loaded.nodes, loaded.scene, loaded.placement);
    REQUIRE(posed);
    CHECK(posed->changed_instances.size() == 4);
    const auto report = render(loaded.scene, Camera{}, {}, {.width = 8, .height = 8});
    REQUIRE(report);
    CHECK(report->triangles_not_finite == 4);
}

TEST_CASE("pose: a chain of a million nodes is posed without recursion", "[io]") {
    Scene scene;
    scene.instances.resize(1);
    std::vector<Node> nodes(1'000'000);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        nodes[i].parent = static_cast<int>(i) + 1 < static_cast<int>(nodes.size()) ? static_cast<int>(i) + 1 : -1;
        nodes[i].parent_from_node = translation({1, 0, 0});
    }
    nodes[0].instances = {0};
    REQUIRE(pose(nodes, scene, {}));
    CHECK(scene.instances[0].world_from_object.c[3].x == 1e6f);
    nodes.back().parent = 500'000;
    CHECK(!pose(nodes, scene, {}));
}
