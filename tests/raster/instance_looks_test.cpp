// Instances with a material, a colour and a visibility of their own draw what scenes draw that have these by materials and without the
// hidden ones, and a scene that is told of changes draws what one that is prepared anew draws.
#include "halflit/renderer.hpp"
#include "tests/raster/random_trial.hpp"
#include "tests/raster/test_scenes.hpp"

#include "tests/support/catch.hpp"

#include <limits>
#include <vector>

using namespace halflit;
using namespace halflit::raster::test;

namespace {

constexpr int kWidth = 96, kHeight = 64;

std::vector<float> draw(Renderer& renderer, const PreparedScene& prepared, const NamedScene& named, const Settings& settings) {
    std::vector<float> linear(std::size_t{4} * kWidth * kHeight);
    const auto report = renderer.render(prepared, prepared.scene(), named.camera, settings, {kWidth, kHeight, nullptr, linear.data()}, {});
    REQUIRE(report);
    return linear;
}

std::vector<float> draw(const NamedScene& named, const Settings& settings) {
    Renderer renderer;
    const auto prepared = PreparedScene::make(named.scene);
    REQUIRE(prepared);
    return draw(renderer, *prepared, named, settings);
}

Settings usual() {
    Settings settings;
    settings.samples = 4, settings.shadow_size = 128;
    return settings;
}

/// A random colour, material and visibility for some instances.
void change_some(Scene& scene, Numbers& make, std::vector<std::size_t>& changed) {
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        if (make.below(2) == 0) continue;
        Instance& instance = scene.instances[i];
        changed.push_back(i);
        instance.visible = make.below(4) != 0;
        if (make.below(2) == 0) instance.color = {make.in(0, 1), make.in(0, 1), make.in(0, 1), 1};
        if (make.below(3) == 0) instance.material = static_cast<int>(make.below(static_cast<std::uint32_t>(scene.materials.size())));
        if (make.below(4) == 0) instance.color = {1, 1, 1, 1}, instance.material = -1;
    }
}

/// The same by materials, and without what is hidden: each instance gets a mesh and a material of its own.
Scene without_looks(const Scene& scene) {
    Scene plain = scene;
    plain.instances.clear();
    for (const Instance& instance : scene.instances) {
        if (!instance.visible) continue;
        Mesh mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const int index = instance.material >= 0 ? instance.material : mesh.material;
        Material material = index >= 0 ? scene.materials[static_cast<std::size_t>(index)] : Material{};
        const Vec4f c = instance.color;
        material.base_color = {material.base_color.x * c.x, material.base_color.y * c.y, material.base_color.z * c.z,
                               material.base_color.w * c.w};
        mesh.material = static_cast<int>(plain.materials.size());
        plain.materials.push_back(material);
        plain.instances.push_back({static_cast<int>(plain.meshes.size()), instance.world_from_object});
        plain.meshes.push_back(std::move(mesh));
    }
    return plain;
}

}  // namespace

TEST_CASE("instances: colours, materials and visibility draw what materials and fewer instances draw", "[raster][instances]") {
    NamedScene named = GENERATE(materials_scene(), layers_scene(), many_lights_scene(), coats_scene());
    Numbers make(7);
    std::vector<std::size_t> changed;
    change_some(named.scene, make, changed);
    NamedScene plain = named;
    plain.scene = without_looks(named.scene);
    Settings settings = usual();
    settings.shadow_fade = 1;  // else from the size of the largest object that shares the material
    CHECK(draw(named, settings) == draw(plain, settings));
    settings.shading.accuracy = Accuracy::reference;
    CHECK(draw(named, settings) == draw(plain, settings));
}

TEST_CASE("instances: a scene that is told of changes draws what one that is prepared anew draws", "[raster][instances]") {
    NamedScene named = layers_scene();
    auto prepared = PreparedScene::make(named.scene);
    REQUIRE(prepared);
    Renderer renderer;
    Numbers make(11);
    (void)draw(renderer, *prepared, named, usual());
    for (int step = 0; step < 12; ++step) {
        SceneChanges changes;
        change_some(named.scene, make, changes.changed_instances);
        if (step % 4 == 3) named.scene.materials[0].base_color.x = make.in(0, 1), changes.materials = true;
        REQUIRE(prepared->update(changes));
        INFO("step " << step);
        CHECK(draw(renderer, *prepared, named, usual()) == draw(named, usual()));
    }
}

TEST_CASE("instances: what is hidden does not count for views, bounds and shadows", "[raster][instances]") {
    NamedScene named = materials_scene();
    const Bounds all = scene_bounds(named.scene);
    named.scene.instances.push_back({0, {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {1000, 0, 0, 1}}}});
    CHECK(scene_bounds(named.scene).max.x > 900);
    named.scene.instances.back().visible = false;
    CHECK(scene_bounds(named.scene).max == all.max);
    CHECK(PreparedScene::make(named.scene)->bounds().max == all.max);
    for (Instance& instance : named.scene.instances) instance.visible = false;
    CHECK(scene_bounds(named.scene).empty);
    CHECK(PreparedScene::make(named.scene)->triangle_count() == 0);
}

TEST_CASE("instances: a material that the scene lacks is refused", "[raster][instances]") {
    NamedScene named = materials_scene();
    named.scene.instances[0].material = static_cast<int>(named.scene.materials.size());
    const auto prepared = PreparedScene::make(named.scene);
    REQUIRE(!prepared);
    CHECK(prepared.error().message.find("instance 0 names material") != std::string::npos);
    named.scene.instances[0].material = -1;
    named.scene.instances[0].color.y = std::numeric_limits<float>::infinity();
    const auto colored = PreparedScene::make(named.scene);
    REQUIRE(!colored);
    CHECK(colored.error().message == "instance 0: its colour is not finite");
}
