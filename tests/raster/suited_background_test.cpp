// The background that a scene's silhouette stands out from, by the luminance of its surfaces.
#include "raster/choice/suited_background.hpp"
#include "halflit/auto_setup.hpp"
#include "halflit/scene.hpp"
#include "halflit/shapes.hpp"

#include "tests/support/catch.hpp"

#include <limits>

using namespace halflit;
using raster::surface_luminance;

namespace {

Scene box_of(Vec4f base, float metallic = 0.0f) {
    Scene scene;
    Material material;
    material.base_color = base;
    material.metallic = metallic;
    scene.materials.push_back(material);
    scene.meshes.push_back(make_box({1, 1, 1}));
    scene.meshes[0].material = 0;
    scene.instances.push_back({});
    return scene;
}

bool is_dark_grey(const Scene& scene) { return raster::suited_background(scene) == usual_settings().background_linear; }

}  // namespace

TEST_CASE("background: the mean luminance of surfaces counts areas, colours, emission and alpha", "[raster][background]") {
    CHECK(surface_luminance(Scene{}) == 0.5);
    CHECK(surface_luminance(box_of({1, 1, 1, 1})) == Approx(1));
    CHECK(surface_luminance(box_of({0, 0, 0, 1})) == 0);
    CHECK(surface_luminance(box_of({1, 0, 0, 1})) == Approx(0.2126));
    CHECK(surface_luminance(box_of({1, 1, 1, 1}, 1)) < 0.7);
    Scene two = box_of({1, 1, 1, 1});
    two.materials.push_back(two.materials[0]);
    two.materials[1].base_color = {0, 0, 0, 1};
    two.instances.push_back({.mesh = 0, .world_from_object = translation({5, 0, 0}), .material = 1});
    CHECK(surface_luminance(two) == Approx(0.5));
    two.instances[1].world_from_object.c[0].x = two.instances[1].world_from_object.c[1].y = two.instances[1].world_from_object.c[2].z = 3;
    CHECK(surface_luminance(two) == Approx(0.1));  // nine times the area
    two.materials[1].alpha_mode = AlphaMode::blend;
    two.materials[1].base_color.w = 0;
    CHECK(surface_luminance(two) == Approx(1));
    Scene glass = box_of({1, 1, 1, 1});
    glass.materials[0].transmission = 0.75f;
    CHECK(surface_luminance(glass) == Approx(0.25));
    Scene glowing = box_of({0, 0, 0, 1});
    glowing.materials[0].emissive = {0.5f, 0.5f, 0.5f};
    CHECK(surface_luminance(glowing) == Approx(0.5));
    Scene colored = box_of({1, 1, 1, 1});
    colored.meshes[0].colors.assign(colored.meshes[0].positions.size(), {0.25f, 0.25f, 0.25f, 1});
    CHECK(surface_luminance(colored) == Approx(0.25));
    colored.instances[0].color = {0.5f, 0.5f, 0.5f, 1};
    CHECK(surface_luminance(colored) == Approx(0.125));
    Scene points = box_of({0.5f, 0.5f, 0.5f, 1});
    points.meshes[0].topology = Topology::points;
    CHECK(surface_luminance(points) == Approx(0.5));
}

TEST_CASE("background: light grey behind dark surfaces, dark grey behind all others", "[raster][background]") {
    CHECK(is_dark_grey(Scene{}));
    CHECK(is_dark_grey(box_of({0.5f, 0.5f, 0.5f, 1})));
    CHECK_FALSE(is_dark_grey(box_of({0.05f, 0.05f, 0.05f, 1})));
    CHECK(auto_setup(box_of({0, 0, 0, 1}), 64, 64).settings.background_linear == raster::suited_background(box_of({0, 0, 0, 1})));
}

TEST_CASE("background: a scene that is not sound is looked at without harm", "[raster][background]") {
    Scene scene = box_of({1, 1, 1, 1});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    scene.meshes[0].colors.assign(1, {nan, nan, nan, 1});  // too few
    scene.meshes[0].indices.push_back(1000000);
    scene.meshes[0].indices.push_back(1000001);
    scene.meshes[0].indices.push_back(1000002);
    scene.instances.push_back({.mesh = 7});
    scene.instances.push_back({.mesh = 0, .material = 9});
    const double luminance = surface_luminance(scene);
    CHECK(luminance >= 0);
    CHECK(luminance <= 1);
}
