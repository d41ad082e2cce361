// Sample models: those that must load do, with the number of triangles that an independent count gives; the others are refused.
#include "tests/io/gltf_builder.hpp"
#include "tests/support/assets.hpp"
#include "tests/support/skip.hpp"

#include "apps/io/files/optional_libraries.hpp"
#include "apps/io/gltf/codecs/meshopt.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <map>
#include <set>

using namespace halflit;
using namespace halflit::test;
namespace fs = std::filesystem;

namespace {

std::vector<fs::path> all_models(const fs::path& folder) {
    std::vector<fs::path> out;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") out.push_back(entry.path());
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace

TEST_CASE("models: textures do not depend on the number of threads that decode them", "[io][assets]") {
    const auto assets = asset_dir();
    if (!assets) HALFLIT_SKIP("no sample models (HALFLIT_ASSETS)");
    LoadOptions one, four;
    one.threads = 1;
    four.threads = 4;
    for (const fs::path& path : all_models(*assets / "models" / "FlightHelmet")) {
        const auto a = load_gltf(path.string(), one), b = load_gltf(path.string(), four);
        REQUIRE(a);
        REQUIRE(b);
        REQUIRE(a->scene.textures.size() == b->scene.textures.size());
        CHECK(a->scene.textures.size() > 8);
        for (std::size_t i = 0; i < a->scene.textures.size(); ++i)
            CHECK(std::ranges::equal(a->scene.textures[i].data(), b->scene.textures[i].data()));
    }
}

TEST_CASE("models: each sample loads, or is refused by the strict rules where it has to be", "[io][assets]") {
    const auto assets = asset_dir();
    if (!assets) HALFLIT_SKIP("no sample models (HALFLIT_ASSETS)");
    std::set<std::string> refused = {"Compatibility_04.gltf", "Compatibility_05.gltf"};
    if (!io::has_draco()) refused.insert("Box_Draco.glb");
    if (!io::has_meshopt()) refused.insert("BoxMeshopt.glb");
    // Triangles drawn, from counting accessors with a separate script.
    std::map<std::string, std::uint64_t> drawn = {{"Triangle.gltf", 1},
                                                  {"TriangleWithoutIndices.gltf", 1},
                                                  {"SimpleMeshes.gltf", 2},
                                                  {"SimpleSparseAccessor.gltf", 12},
                                                  {"BoxAnimated.glb", 254},
                                                  {"Box_Draco.glb", 12},
                                                  {"BoxMeshopt.glb", 12},
                                                  {"Suzanne.gltf", 3936},
                                                  {"Duck.glb", 4212},
                                                  {"FlightHelmet.gltf", 94722},
                                                  {"AlphaBlendModeTest.glb", 61},
                                                  {"NormalTangentTest.glb", 7774},
                                                  {"OrientationTest.glb", 524},
                                                  {"TextureTransformTest.gltf", 24},
                                                  {"CesiumMilkTruck.glb", 3624},
                                                  {"cornellBox.glb", 4006},
                                                  {"BabylonShaderBall_Simple.gltf", 7276},
                                                  {"shadows-directional.gltf", 1046},
                                                  {"low-poly.gltf", 5228},
                                                  {"camp.gltf", 6285},
                                                  {"garage.gltf", 11358},
                                                  {"space_exploration.glb", 50003},
                                                  {"many-cubes.gltf", 6012},
                                                  {"RiggedSimple.glb", 188},
                                                  {"Mesh_PrimitiveMode_04.gltf", 2},
                                                  {"Mesh_PrimitiveMode_12.gltf", 2},
                                                  {"Mesh_PrimitiveMode_03.gltf", 0},
                                                  {"Node_Attribute_08.gltf", 54}};
    for (const std::string& name : refused) drawn.erase(name);
    std::size_t seen = 0, counted = 0;
    for (const fs::path& path : all_models(*assets / "models")) {
        const auto loaded = load_gltf(path.string(), strictly());
        const std::string name = path.filename().string();
        INFO(path.string() << (loaded ? "" : ": " + loaded.error().message));
        ++seen;
        if (refused.count(name) != 0) {
            REQUIRE(!loaded);
            CHECK(loaded.error().code == ErrorCode::bad_input);
            continue;
        }
        REQUIRE(loaded);
        const auto wanted = drawn.find(name);
        if (wanted != drawn.end()) {
            ++counted;
            CHECK(loaded->info.triangles_drawn == wanted->second);
        }
    }
    CHECK(seen >= 120);
    CHECK(counted == drawn.size());
}

TEST_CASE("models: three containers of one model give one scene", "[io][assets]") {
    const auto assets = asset_dir();
    if (!assets) HALFLIT_SKIP("no sample models (HALFLIT_ASSETS)");
    const fs::path folder = *assets / "models" / "BoxTextured";
    const auto read = [&](const char* name) {
        auto loaded = load_gltf((folder / name).string());
        if (!loaded) FAIL(loaded.error().message);
        return *std::move(loaded);
    };
    const LoadedScene separate = read("separate/BoxTextured.gltf"), binary = read("binary/BoxTextured.glb"),
                      embedded = read("embedded/BoxTextured.gltf");
    for (const LoadedScene* other : {&binary, &embedded}) {
        const Scene &a = separate.scene, &b = other->scene;
        REQUIRE(a.meshes.size() == b.meshes.size());
        CHECK(a.meshes[0].positions == b.meshes[0].positions);
        CHECK(a.meshes[0].normals == b.meshes[0].normals);
        CHECK(a.meshes[0].uv0 == b.meshes[0].uv0);
        CHECK(a.meshes[0].indices == b.meshes[0].indices);
        REQUIRE(a.instances.size() == b.instances.size());
        CHECK(a.instances[0].world_from_object == b.instances[0].world_from_object);
        REQUIRE(a.textures.size() == 1);
        REQUIRE(b.textures.size() == 1);
        CHECK(
            std::equal(a.textures[0].data().begin(), a.textures[0].data().end(), b.textures[0].data().begin(), b.textures[0].data().end()));
    }
}
