// Errors of preparing a scene and of updating it.
#include "halflit/prepared_scene.hpp"
#include "halflit/scene.hpp"
#include "halflit/shapes.hpp"
#include "raster/scene/prepared_data.hpp"

#include "tests/support/catch.hpp"

#include <limits>

using namespace halflit;
using namespace halflit::raster;

namespace {

Scene good_scene() {
    Scene scene;
    scene.materials.resize(2);
    const std::vector<std::uint8_t> gray(4 * 4, 128);
    scene.textures.push_back(*Texture::from_rgba8(gray, 2, 2, ColorSpace::srgb));
    scene.materials[0].textures[TextureSlot::base_color].texture = 0;
    scene.meshes = {make_box({1, 1, 1}), make_sphere(1, 8, 5)};
    scene.meshes[0].material = 0;
    scene.meshes[1].material = 1;
    scene.instances = {{0, {}}, {1, {}}, {0, translation({3, 0, 0})}};
    return scene;
}

bool tells(const Error& error) { return !error.message.empty() && error.message.find('\n') == std::string::npos; }

struct Fault {
    const char* what;
    void (*spoil)(Scene&);
    SceneChanges told;  ///< the changes that update() is told of
};

/// Faults that break mesh 1 or material 1.
const std::vector<Fault>& faults() {
    static const SceneChanges kMesh{{}, {1}}, kMaterials{{}, {}, true};
    static const std::vector<Fault> made{
        {"index", [](Scene& s) { s.meshes[1].indices.back() = static_cast<std::uint32_t>(s.meshes[1].positions.size()); }, kMesh},
        {"largest index", [](Scene& s) { s.meshes[1].indices[4] = std::numeric_limits<std::uint32_t>::max(); }, kMesh},
        {"two indices too many", [](Scene& s) { s.meshes[1].indices.resize(s.meshes[1].indices.size() + 2, 0); }, kMesh},
        {"no positions", [](Scene& s) { s.meshes[1].positions.clear(); }, kMesh},
        {"a position less", [](Scene& s) { s.meshes[1].positions.pop_back(); }, kMesh},
        {"a normal more",
         [](Scene& s) {
             s.meshes[1].normals.push_back({0, 1, 0});
         },
         kMesh},
        {"one tangent", [](Scene& s) { s.meshes[1].tangents.resize(1); }, kMesh},
        {"a uv less", [](Scene& s) { s.meshes[1].uv0.pop_back(); }, kMesh},
        {"one uv of set 1", [](Scene& s) { s.meshes[1].uv1.resize(1); }, kMesh},
        {"one colour", [](Scene& s) { s.meshes[1].colors.resize(1); }, kMesh},
        {"material of the mesh", [](Scene& s) { s.meshes[1].material = 2; }, kMesh},
        {"largest material of the mesh", [](Scene& s) { s.meshes[1].material = std::numeric_limits<int>::max(); }, kMesh},
        {"texture", [](Scene& s) { s.materials[1].textures[TextureSlot::emissive].texture = 1; }, kMaterials},
        {"textures gone", [](Scene& s) { s.textures.clear(); }, kMaterials},
        {"wrap", [](Scene& s) { s.materials[1].lobe.wrap = 1.5f; }, kMaterials},
        {"wrap that is none", [](Scene& s) { s.materials[1].lobe.wrap = std::numeric_limits<float>::quiet_NaN(); }, kMaterials},
        {"power", [](Scene& s) { s.materials[1].lobe.power = -1.0f; }, kMaterials},
    };
    return made;
}

}  // namespace

TEST_CASE("prepared scene: a broken scene is bad input, in one line", "[raster][prepared]") {
    const Scene good = good_scene();
    REQUIRE(PreparedScene::make(good));
    for (const Fault& fault : faults()) {
        Scene scene = good_scene();
        fault.spoil(scene);
        INFO(fault.what);
        const auto prepared = PreparedScene::make(scene);
        REQUIRE_FALSE(prepared);
        CHECK(prepared.error().code == ErrorCode::bad_input);
        CHECK(tells(prepared.error()));
    }
    for (const int mesh : {-1, 2, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()}) {
        Scene scene = good_scene();
        scene.instances[1].mesh = mesh;
        const auto prepared = PreparedScene::make(scene);
        REQUIRE_FALSE(prepared);
        CHECK(prepared.error().code == ErrorCode::bad_input);
    }
}

TEST_CASE("prepared scene: a change that breaks the scene is refused", "[raster][prepared]") {
    for (const Fault& fault : faults()) {
        Scene scene = good_scene();
        auto prepared = PreparedScene::make(scene);
        REQUIRE(prepared);
        fault.spoil(scene);
        INFO(fault.what);
        const auto updated = prepared->update(fault.told);
        REQUIRE_FALSE(updated);
        CHECK(updated.error().code == ErrorCode::bad_input);
        CHECK(tells(updated.error()));
    }
}

TEST_CASE("prepared scene: updates are held to the work that the scene may take", "[raster][prepared]") {
    Scene scene = good_scene();
    auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    scene.frame_work = 1;
    const auto updated = prepared->update({.changed_instances = {0}});
    REQUIRE_FALSE(updated);
    CHECK(updated.error().code == ErrorCode::limit);
    scene.frame_work = 0;
    CHECK(prepared->update({}));
}

TEST_CASE("prepared scene: other numbers of meshes, instances or materials are refused, whatever is told", "[raster][prepared]") {
    void (*const spoil[])(Scene&) = {[](Scene& s) {
                                         s.instances.push_back({1, {}});
                                     },
                                     [](Scene& s) { s.instances.pop_back(); },
                                     [](Scene& s) { s.meshes.emplace_back(); },
                                     [](Scene& s) { s.meshes.pop_back(); },
                                     [](Scene& s) { s.materials.emplace_back(); },
                                     [](Scene& s) { s.materials.pop_back(); },
                                     [](Scene& s) { s = {}; }};
    const SceneChanges told[] = {{}, {{0}}, {{}, {0}}, {{}, {}, true}, {{}, {}, false, true}};
    for (const auto& change : spoil)
        for (const SceneChanges& changes : told) {
            Scene scene = good_scene();
            auto prepared = PreparedScene::make(scene);
            REQUIRE(prepared);
            change(scene);
            const auto updated = prepared->update(changes);
            REQUIRE_FALSE(updated);
            CHECK(tells(updated.error()));
        }
}

TEST_CASE("prepared scene: a change of a mesh or an instance that does not exist is refused", "[raster][prepared]") {
    Scene scene = good_scene();
    for (const SceneChanges& changes :
         {SceneChanges{{3}}, SceneChanges{{0, 1, 99}}, SceneChanges{{std::numeric_limits<std::size_t>::max()}}, SceneChanges{{}, {2}},
          SceneChanges{{}, {0, std::numeric_limits<std::size_t>::max()}}}) {
        auto prepared = PreparedScene::make(scene);
        REQUIRE(prepared);
        const auto updated = prepared->update(changes);
        REQUIRE_FALSE(updated);
        CHECK(tells(updated.error()));
    }
}

TEST_CASE("prepared scene: a mesh may become empty and be filled again", "[raster][prepared]") {
    Scene scene = good_scene();
    auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    const std::uint64_t all = prepared->triangle_count();
    const Mesh sphere = std::exchange(scene.meshes[1], Mesh{});
    REQUIRE(prepared->update({{}, {1}}));
    CHECK(prepared->triangle_count() == 24);
    CHECK(prepared->data().instance_bounds()[1].empty);
    CHECK_FALSE(prepared->data().drawn_materials()[1]);
    scene.meshes[1] = sphere;
    REQUIRE(prepared->update({{}, {1}}));
    CHECK(prepared->triangle_count() == all);
}
