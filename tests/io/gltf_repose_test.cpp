// Posing a loaded scene again: the same bits and pixels as loading it anew, and what is reported as changed.
#include "halflit/auto_setup.hpp"
#include "halflit/renderer.hpp"
#include "sh/trig.hpp"
#include "shading/material_properties.hpp"
#include "tests/io/animated_file.hpp"
#include "tests/io/png_maker.hpp"
#include "tests/support/assets.hpp"
#include "tests/support/skip.hpp"

#include "tests/support/catch.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

using namespace halflit;
using namespace halflit::test;
namespace fs = std::filesystem;

namespace {

template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

template <class T>
bool same_bits(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

bool same(const Mesh& a, const Mesh& b) {
    return same(a.positions, b.positions) && same(a.normals, b.normals) && same(a.tangents, b.tangents) && same(a.uv0, b.uv0) &&
           same(a.uv1, b.uv1) && same(a.colors, b.colors) && same(a.indices, b.indices) && a.material == b.material;
}

/// All that an animation may move.
void check_same(const Scene& a, const Scene& b) {
    REQUIRE(a.instances.size() == b.instances.size());
    for (std::size_t i = 0; i < a.instances.size(); ++i) {
        INFO("instance " << i);
        for (int c = 0; c < 4; ++c) {
            const Vec4f &x = a.instances[i].world_from_object.c[c], &y = b.instances[i].world_from_object.c[c];
            INFO("column " << c << ": " << x.x << " " << x.y << " " << x.z << " " << x.w << ", " << y.x << " " << y.y << " " << y.z << " "
                           << y.w);
            CHECK(same_bits(x, y));
        }
        CHECK(same(a.meshes.at(static_cast<std::size_t>(a.instances[i].mesh)), b.meshes.at(static_cast<std::size_t>(b.instances[i].mesh))));
    }
    REQUIRE(a.materials.size() == b.materials.size());
    for (std::size_t i = 0; i < a.materials.size(); ++i) {
        const Material &x = a.materials[i], &y = b.materials[i];
        for (const shading::MaterialNumber& number : shading::kMaterialNumbers) {
            INFO(number.name);
            float of_x[4], of_y[4];
            number.get(x, of_x);
            number.get(y, of_y);
            CHECK(std::equal(of_x, of_x + number.count, of_y));
        }
        for (const TextureSlot slot : shading::kAllTextureSlots) {
            INFO(shading::info_of(slot).name);
            CHECK(x.textures[slot].texture == y.textures[slot].texture);
            CHECK(x.textures[slot].row_u == y.textures[slot].row_u);
            CHECK(x.textures[slot].row_v == y.textures[slot].row_v);
        }
    }
    REQUIRE(a.lights.size() == b.lights.size());
    for (std::size_t i = 0; i < a.lights.size(); ++i) CHECK(a.lights[i] == b.lights[i]);  // bytes between its members mean nothing
    REQUIRE(a.cameras.size() == b.cameras.size());
    for (std::size_t i = 0; i < a.cameras.size(); ++i) {
        CHECK(same_bits(a.cameras[i].world_from_camera, b.cameras[i].world_from_camera));
        CHECK(a.cameras[i].fov_y_rad == b.cameras[i].fov_y_rad);
        CHECK(a.cameras[i].near_z == b.cameras[i].near_z);
    }
}

std::vector<std::uint8_t> picture_of(const PreparedScene& prepared, const Camera& camera) {
    std::vector<std::uint8_t> pixels(4 * 64 * 48);
    Settings settings;
    settings.background_linear = {0.1f, 0.1f, 0.1f, 1};
    REQUIRE(Renderer().render(prepared, camera, settings, {.width = 64, .height = 48, .pixels = pixels.data()}));
    return pixels;
}

std::vector<std::uint8_t> picture_of(const Scene& scene, const Camera& camera) {
    const auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    return picture_of(*prepared, camera);
}

/// Two quads with materials, one of them hidden for a while; a spot light, a point light and a camera. Everything is animated by pointers.
Bytes pointed() {
    FilePieces pieces;
    AnimationText a, b;
    const int quad = pieces.floats({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3", 3);
    const int uv = pieces.floats({0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1}, "VEC2", 2);
    const Bytes png = plain_png(3, 2, 200, 100, 50);
    const int picture = pieces.accessor(png, R"("componentType":5121,"type":"SCALAR","count":1)");
    const auto moves = [&](AnimationText& to, const std::string& pointer, const char* type, std::size_t n, std::vector<float> values,
                           Keys keys = Keys::linear) {
        to.add_pointer(sampler_of(pieces, {keys, n, {0, 2}, std::move(values)}, type, n), pointer);
    };
    const std::string m = "/materials/0/", lights = "/extensions/KHR_lights_punctual/lights/";
    moves(a, m + "pbrMetallicRoughness/baseColorFactor", "VEC4", 4, {0, 0.5f, 1, 1, 1, 0.5f, 0, 0.5f});
    moves(a, m + "pbrMetallicRoughness/metallicFactor", "SCALAR", 1, {1, 0});
    moves(a, m + "pbrMetallicRoughness/roughnessFactor", "SCALAR", 1, {0.5f, 2.5f});  // 1.5 at the middle: drawn as 1
    moves(a, m + "emissiveFactor", "VEC3", 3, {0, 0, 0, 1, 0.5f, 0});
    moves(a, m + "extensions/KHR_materials_emissive_strength/emissiveStrength", "SCALAR", 1, {2, 6});
    moves(a, m + "alphaCutoff", "SCALAR", 1, {0.25f, 0.75f});
    moves(a, m + "pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/offset", "VEC2", 2, {0, 0, 0.5f, 1});
    moves(a, m + "pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/scale", "VEC2", 2, {1, 1, 3, 5});
    moves(a, m + "pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/rotation", "SCALAR", 1, {0, 1});
    moves(a, lights + "0/color", "VEC3", 3, {1, 1, 1, 0, 0.5f, 1});
    moves(a, lights + "0/intensity", "SCALAR", 1, {2, 4});
    moves(a, lights + "0/range", "SCALAR", 1, {10, 20});
    moves(a, lights + "0/spot/innerConeAngle", "SCALAR", 1, {0.1f, 0.3f});
    moves(a, lights + "0/spot/outerConeAngle", "SCALAR", 1, {0.5f, 0.7f});
    moves(a, "/cameras/0/perspective/yfov", "SCALAR", 1, {0.5f, 1.5f});
    moves(a, "/cameras/0/perspective/znear", "SCALAR", 1, {0.5f, -0.7f});  // -0.1 at the middle of 0 to 2: the file's is drawn
    moves(a, "/nodes/0/translation", "VEC3", 3, {0, 0, 0, 1, 0, 0});
    moves(b, "/materials/1/pbrMetallicRoughness/baseColorFactor", "VEC4", 4, {1, 0, 0, 1, 0, 1, 0, 1});
    moves(b, "/materials/0/occlusionTexture/index", "SCALAR", 1, {0, 1});
    Bytes shown;
    append<std::uint8_t>(shown, {1, 0, 1, 0});
    const int times = pieces.times({0, 1, 1.5f});
    const int visible = pieces.accessor(shown, R"("componentType":5121,"type":"SCALAR","count":3)");
    const std::string step =
        "{\"input\":" + std::to_string(times) + ",\"output\":" + std::to_string(visible) + R"(,"interpolation":"STEP"})";
    a.add_pointer(step, "/nodes/1/extensions/KHR_node_visibility/visible");
    return pieces.file(R"("extensionsUsed":["KHR_animation_pointer","KHR_node_visibility","KHR_lights_punctual","KHR_texture_transform",)"
                       R"("KHR_materials_emissive_strength"],"nodes":[{"mesh":0},{"mesh":1,"translation":[2,0,0],"children":[2]},)"
                       R"({"translation":[0,0,3],"extensions":{"KHR_lights_punctual":{"light":0}}},{"camera":0,"translation":[1,0,6]}],)"
                       R"("cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.125}}],)"
                       R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":1,"spot":{}}]}},)"
                       R"("images":[{"bufferView":)" +
                       std::to_string(picture) +
                       R"(,"mimeType":"image/png"}],"textures":[{"source":0}],)"
                       R"("materials":[{"alphaMode":"MASK","doubleSided":true,"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}},)"
                       R"({"doubleSided":true}],)"
                       R"("meshes":[{"primitives":[{"material":0,"attributes":{"POSITION":)" +
                       std::to_string(quad) + ",\"TEXCOORD_0\":" + std::to_string(uv) +
                       R"(}}]},{"primitives":[{"material":1,"attributes":{"POSITION":)" + std::to_string(quad) + "}}]}],\"animations\":[" +
                       a.json("all") + "," + b.json("red") + "]");
}

/// Sixteen vertices that a morph target lifts, and one that lies 1e13 times farther away at the time 0, or is taken there by the target at
/// once.
Bytes with_stray(bool at_first) {
    FilePieces pieces;
    AnimationText animation;
    std::vector<float> positions, deltas;
    for (int i = 0; i < 51; ++i) {
        positions.push_back(static_cast<float>(i % 3 == 0 ? i % 12 : i % 3 == 1 ? i / 12 : 0));
        deltas.push_back(i % 3 == 2 ? 0.25f : 0.0f);
    }
    (at_first ? positions : deltas)[48] = 1e13f;
    const int position = pieces.floats(positions, "VEC3", 3), delta = pieces.floats(deltas, "VEC3", 3);
    Bytes corners;
    append<std::uint16_t>(corners, {0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 4, 5, 9, 4, 9, 8, 5, 6, 16});
    const int index = pieces.accessor(corners, R"("componentType":5123,"type":"SCALAR","count":21)");
    const Keys keys = at_first ? Keys::linear : Keys::step;
    animation.add_node(sampler_of(pieces, {keys, 1, {0, 2}, {0, 1}}, "SCALAR", 1), 0, "weights");
    return pieces.file(R"("nodes":[{"mesh":0}],"materials":[{"doubleSided":true}],"meshes":[{"primitives":[{"material":0,"indices":)" +
                       std::to_string(index) + ",\"attributes\":{\"POSITION\":" + std::to_string(position) +
                       "},\"targets\":[{\"POSITION\":" + std::to_string(delta) + "}]}]}],\"animations\":[" + animation.json("up") + "]");
}

}  // namespace

TEST_CASE("pose_at: each pose has the bits and the pixels of the file loaded at that time", "[io]") {
    Random random(21);
    std::vector<Bytes> files{pointed(), with_stray(true), with_stray(false)};
    for (const Keys keys : {Keys::linear, Keys::step, Keys::cubic}) files.push_back(Arm(5, keys).file);
    for (const Bytes& file : files) {
        LoadedScene loaded = load_ok(file, at(0, "", true));
        REQUIRE(loaded.motion);
        auto prepared = PreparedScene::make(loaded.scene);
        REQUIRE(prepared);
        const Camera camera = frame_scene(loaded.scene, 64.0f / 48.0f);
        for (int trial = 0; trial < 12; ++trial) {
            const double time = random.real(-0.2, 3.0);
            const std::string animation = trial % 5 == 4 ? "none" : loaded.animations.size() > 1 && trial % 5 == 3 ? "1" : "";
            INFO("time " << time << ", animation " << animation);
            const auto changes = pose_at(*loaded.motion, animation, time, loaded.scene, loaded.nodes);
            REQUIRE(changes);
            REQUIRE(prepared->update(*changes));
            const LoadedScene anew = load_ok(file, at(time, animation, true));
            check_same(loaded.scene, anew.scene);
            for (std::size_t n = 0; n < loaded.nodes.size(); ++n) CHECK(loaded.nodes[n].parent_from_node == anew.nodes[n].parent_from_node);
            CHECK(picture_of(*prepared, camera) == picture_of(anew.scene, camera));
            // Without what is kept, hidden meshes and shared ones may be other meshes, and the picture is the same.
            CHECK(picture_of(*prepared, camera) == picture_of(load_ok(file, at(time, animation)).scene, camera));
            // The nodes have the pose too.
            const auto posed = pose(loaded.nodes, loaded.scene, loaded.placement);
            REQUIRE(posed);
            CHECK(posed->changed_instances.empty());
            CHECK(!posed->lights);
        }
    }
}

TEST_CASE("pose_at: pointers move materials, texture transforms, lights, cameras and visibility", "[io]") {
    LoadedScene loaded = load_ok(pointed(), at(1, "", true));
    REQUIRE(loaded.warnings.size() == 1);
    CHECK(loaded.warnings[0].find("occlusionTexture/index") != std::string::npos);
    const Material& m = loaded.scene.materials.at(0);
    CHECK(m.base_color == Vec4f{0.5f, 0.5f, 0.5f, 0.75f});
    CHECK(m.metallic == 0.5f);
    CHECK(m.roughness == 1.0f);
    CHECK(m.emissive == Vec3f{2, 1, 0});
    CHECK(m.alpha_cutoff == 0.5f);
    const double c = std::cos(0.5), s = std::sin(0.5);
    CHECK(m.textures[TextureSlot::base_color].row_u.x == Approx(2 * c));
    CHECK(m.textures[TextureSlot::base_color].row_u.y == Approx(3 * s));
    CHECK(m.textures[TextureSlot::base_color].row_u.z == 0.25f);
    CHECK(m.textures[TextureSlot::base_color].row_v.x == Approx(-2 * s));
    CHECK(m.textures[TextureSlot::base_color].row_v.z == 0.5f);
    const Light& hidden = loaded.scene.lights.at(0);  // below the node that is hidden from 1 s to 1.5 s
    CHECK(hidden.color_linear == Vec3f{0, 0, 0});
    CHECK(loaded.scene.meshes.at(1).indices.empty());
    CHECK(loaded.scene.cameras.at(0).fov_y_rad == 1.0f);
    CHECK(loaded.scene.cameras[0].near_z == 0.125f);  // an invalid camera is the file's
    CHECK(loaded.scene.instances[0].world_from_object.c[3].x == 0.5f);

    const auto changes = pose_at(*loaded.motion, "all", 0.5, loaded.scene);
    REQUIRE(changes);
    CHECK(changes->materials);
    CHECK(changes->lights);
    CHECK(changes->changed_instances == std::vector<std::size_t>{0});
    CHECK(changes->deformed_meshes == std::vector<std::size_t>{1});
    const Light& light = loaded.scene.lights[0];
    CHECK(light.color_linear.x == Approx(0.75 * 2.5 / kPi));
    CHECK(light.color_linear.y == Approx(0.875 * 2.5 / kPi));
    CHECK(light.range == 12.5f);
    CHECK(light.inner_cone_rad == Approx(0.15));
    CHECK(light.outer_cone_rad == Approx(0.55));
    CHECK(loaded.scene.meshes[1].indices.size() == 6);
    CHECK(loaded.scene.cameras[0].fov_y_rad == 0.75f);
    CHECK(loaded.scene.cameras[0].near_z == Approx(0.2));
    const auto again = pose_at(*loaded.motion, "0", 0.5, loaded.scene);
    REQUIRE(again);
    CHECK(!again->materials);
    CHECK(!again->lights);
    CHECK(again->changed_instances.empty());
    CHECK(again->deformed_meshes.empty());
    // Another animation begins at the file's values.
    REQUIRE(pose_at(*loaded.motion, "red", 1, loaded.scene));
    CHECK(loaded.scene.materials[1].base_color == Vec4f{0.5f, 0.5f, 0, 1});
    CHECK(loaded.scene.materials[0].metallic == 1.0f);
    CHECK(loaded.scene.lights[0].range == 0.0f);
}

TEST_CASE("pose_at: pointers move every number and texture transform of the table of materials", "[io]") {
    FilePieces pieces;
    AnimationText all;
    const int quad = pieces.floats({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3", 3);
    const int uv = pieces.floats({0, 0, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1}, "VEC2", 2);
    const int picture = pieces.accessor(plain_png(3, 2, 200, 100, 50), R"("componentType":5121,"type":"SCALAR","count":1)");
    nlohmann::json material;
    const auto place = [&](std::string_view path) -> nlohmann::json& {
        return material[nlohmann::json::json_pointer("/" + std::string(path))];
    };
    const auto moves = [&](const std::string& path, std::size_t count, std::vector<float> values) {
        constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
        all.add_pointer(sampler_of(pieces, {Keys::linear, count, {0, 2}, std::move(values)}, kTypes[count], count), "/materials/0/" + path);
    };
    for (const TextureSlot slot : shading::kAllTextureSlots) {
        const std::string path(shading::info_of(slot).gltf);
        place(path)["index"] = 0;
        moves(path + "/extensions/KHR_texture_transform/offset", 2, {0, 0, 0.5f, 1});
    }
    constexpr float kMoved[] = {0.25f, 0.5f, 0.75f, 0.125f};
    for (const shading::MaterialNumber& number : shading::kMaterialNumbers) {
        if (number.gltf.empty()) continue;
        const auto count = static_cast<std::size_t>(number.count);
        std::vector<float> values;
        for (std::size_t i = 0; i < 2 * count; ++i) values.push_back(std::clamp(kMoved[i % count], number.low, number.high));
        moves(std::string(number.gltf), count, values);
    }
    const Bytes file =
        pieces.file(R"("extensionsUsed":["KHR_animation_pointer","KHR_texture_transform"],"nodes":[{"mesh":0}],"images":[{"bufferView":)" +
                    std::to_string(picture) + R"(,"mimeType":"image/png"}],"textures":[{"source":0}],"materials":[)" + material.dump() +
                    R"(],"meshes":[{"primitives":[{"material":0,"attributes":{"POSITION":)" + std::to_string(quad) +
                    ",\"TEXCOORD_0\":" + std::to_string(uv) + R"(}}]}],"animations":[)" + all.json("all") + "]");
    const LoadedScene loaded = load_ok(file, at(1, "", true));
    INFO((loaded.warnings.empty() ? "" : loaded.warnings[0]));
    const Material& m = loaded.scene.materials.at(0);
    for (const shading::MaterialNumber& number : shading::kMaterialNumbers) {
        if (number.gltf.empty()) continue;
        INFO(number.name);
        float values[4];
        number.get(m, values);
        for (int c = 0; c < number.count; ++c) CHECK(values[c] == std::clamp(kMoved[c], number.low, number.high));
    }
    for (const TextureSlot slot : shading::kAllTextureSlots) {
        INFO(shading::info_of(slot).name);
        CHECK(m.textures[slot].used());
        CHECK(m.textures[slot].row_u.z == 0.25f);
        CHECK(m.textures[slot].row_v.z == 0.5f);
    }
}

TEST_CASE("pose_at: what a host has set stays where no animation moves it", "[io]") {
    LoadedScene loaded = load_ok(pointed(), at(0, "", true));
    loaded.scene.materials[0].lobe.wrap = 0.5f;
    loaded.scene.materials[0].double_sided = false;
    loaded.scene.lights.emplace_back().color_linear = {3, 2, 1};
    loaded.scene.instances.push_back({0, {}});
    REQUIRE(pose_at(*loaded.motion, "", 1.7, loaded.scene));
    CHECK(loaded.scene.materials[0].lobe.wrap == 0.5f);
    CHECK(!loaded.scene.materials[0].double_sided);
    CHECK(loaded.scene.lights.back().color_linear == Vec3f{3, 2, 1});
    CHECK(loaded.scene.instances.back().world_from_object == Mat4{});
}

TEST_CASE("pose_at: wrong calls are refused, and leave the scene as it was", "[io]") {
    const LoadedScene loaded = load_ok(pointed(), at(0, "", true));
    const auto refused = [&](const std::string& animation, double time, Scene scene, std::vector<Node> nodes = {}) {
        const Scene before = scene;
        const auto posed = pose_at(*loaded.motion, animation, time, scene, nodes);
        REQUIRE(!posed);
        CHECK(posed.error().code == ErrorCode::usage);
        if (scene.meshes.size() == loaded.scene.meshes.size()) check_same(scene, before);
    };
    refused("2", 1, loaded.scene);
    refused("All", 1, loaded.scene);
    refused("", std::numeric_limits<double>::quiet_NaN(), loaded.scene);
    refused("", -std::numeric_limits<double>::infinity(), loaded.scene);
    refused("", 1, loaded.scene, std::vector<Node>(3));
    Scene less = loaded.scene;
    less.lights.clear();
    refused("", 1, less);
    less = loaded.scene;
    less.cameras.clear();
    refused("", 1, less);
    less = loaded.scene;
    less.instances.pop_back();
    refused("", 1, less);
    less = loaded.scene;
    less.materials.pop_back();
    refused("", 1, less);
    refused("", 1, Scene{});
}

TEST_CASE("pose_at: a scene that was moved to the origin is posed where it is drawn", "[io]") {
    // A skinned mesh and a plain one, 1e8 away: the arm's root is moved there by a node above it.
    const Arm arm(9, Keys::linear);
    const std::string text(reinterpret_cast<const char*>(arm.file.data()), arm.file.size());
    const std::size_t begin = text.find("{\"asset"), end = text.find("BIN") - 4;
    std::string json = replaced(text.substr(begin, end - begin), R"("nodes":[0,3])", R"("nodes":[4,3])");
    json = replaced(json, R"("translation":[7,8,9]})", R"("translation":[7,8,9]},{"children":[0],"translation":[1e8,0,0]})");
    const Bytes file = glb(json, to_bytes(text.substr(end + 8)));
    LoadOptions far = at(0.4, "", true);
    far.recentre = true;
    LoadedScene loaded = load_ok(file, far);
    REQUIRE(loaded.placement.origin.x > 9e7);
    const Scene before = loaded.scene;
    REQUIRE(pose_at(*loaded.motion, "", 1.3, loaded.scene));
    const LoadedScene near_by = load_ok(arm.file, at(1.3));
    const Bounds bounds = scene_bounds(near_by.scene), found = scene_bounds(loaded.scene);
    const double tolerance = 1e-5 * static_cast<double>(bounds.radius());  // rounding at 1e8 in double, and of the shift in float
    CHECK(static_cast<double>(found.min.x) + loaded.placement.origin.x - 1e8 ==
          Approx(static_cast<double>(bounds.min.x)).margin(tolerance));
    CHECK(static_cast<double>(found.max.y) + loaded.placement.origin.y == Approx(static_cast<double>(bounds.max.y)).margin(tolerance));
    const auto back = pose_at(*loaded.motion, "", 0.4, loaded.scene);
    REQUIRE(back);
    check_same(loaded.scene, before);
}

TEST_CASE("models: animated samples keep their size at three times, and posing them is loading them", "[io][assets]") {
    const auto assets = asset_dir();
    if (!assets) HALFLIT_SKIP("no sample models (HALFLIT_ASSETS)");
    int animated = 0;
    for (const auto& entry : fs::recursive_directory_iterator(*assets / "models")) {
        if (entry.path().extension() != ".gltf" && entry.path().extension() != ".glb") continue;
        auto loaded = load_gltf(entry.path().string(), at(0, "none", true));
        if (!loaded || loaded->animations.empty()) continue;
        INFO(entry.path());
        ++animated;
        const Bounds rest = scene_bounds(loaded->scene);
        const double end = loaded->animations[0].end_s;
        const Camera camera = frame_scene(loaded->scene, 64.0f / 48.0f);
        CHECK(end > 0.0);
        for (const double time : {0.0, 0.37 * end, 0.81 * end}) {
            REQUIRE(pose_at(*loaded->motion, "0", time, loaded->scene));
            const auto anew = load_gltf(entry.path().string(), at(time));
            REQUIRE(anew);
            CHECK(picture_of(loaded->scene, camera) == picture_of(anew->scene, camera));
            const Bounds posed = scene_bounds(loaded->scene);
            CHECK(!posed.empty);
            CHECK(posed.radius() < 3 * rest.radius());
        }
    }
    CHECK(animated >= 11);
}
