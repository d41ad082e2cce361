// Views that would show nothing: another side, or the whole in place of a camera inside of a body; and clouds with noise.
#include "halflit/auto_setup.hpp"
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"

#include "tests/support/catch.hpp"

#include <vector>

using namespace halflit;

namespace {

constexpr int kSide = 48;

/// Pixels of the picture by default that show the scene.
int seen(const Scene& scene) {
    PictureRequest request;
    request.size = PictureSize{kSide, kSide};
    const auto choice = choose_picture(scene, request);
    REQUIRE(choice);
    std::vector<float> linear(std::size_t{4} * kSide * kSide);
    Settings settings = choice->settings;
    settings.background_linear = {0, 0, 0, 0};
    REQUIRE(render(scene, choice->light, choice->camera, settings, {kSide, kSide, nullptr, linear.data()}));
    int count = 0;
    for (std::size_t i = 3; i < linear.size(); i += 4) count += linear[i] > 0 ? 1 : 0;
    return count;
}

Scene with(Mesh mesh) {
    Scene scene;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({});
    return scene;
}

Mesh card(std::initializer_list<Vec3f> corners) {
    Mesh mesh;
    mesh.positions = corners;
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

}  // namespace

TEST_CASE("visible side: a card is seen from the side that is drawn, wherever that is", "[raster][view]") {
    const ViewSettings usual;
    for (const Mesh& mesh :
         {card({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}), card({{-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}, {1, -1, 0}}),
          card({{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}}), card({{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}})})
        CHECK(seen(with(mesh)) > 100);
    const Scene front = with(card({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}));
    const Scene back = with(card({{-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}, {1, -1, 0}}));
    const float near_front = choose_view(front, scene_bounds(front), 1.0f, usual).view.azimuth_deg;
    CHECK(near_front < usual.azimuth_deg);  // upright and thin
    CHECK(near_front > 0);
    CHECK(choose_view(back, scene_bounds(back), 1.0f, usual).view.azimuth_deg > 90);
    Scene both = back;
    Material material;
    material.double_sided = true;
    both.materials.push_back(material);
    both.meshes[0].material = 0;
    CHECK(choose_view(both, scene_bounds(both), 1.0f, usual).view.azimuth_deg == near_front);
    Scene mirrored = back;
    mirrored.instances[0].world_from_object.c[2].z = -1;
    CHECK(choose_view(mirrored, scene_bounds(mirrored), 1.0f, usual).view.azimuth_deg == near_front);
}

TEST_CASE("view: what is flat is seen from farther above, a cube and a tower as usual", "[raster][view]") {
    const ViewSettings usual;
    const auto chosen = [&](Vec3f half, const ViewSettings& view) {
        const Scene scene = with(make_box(half));
        return choose_view(scene, scene_bounds(scene), 1.0f, view).view;
    };
    CHECK(chosen({1, 1, 1}, usual) == usual);
    CHECK(chosen({1, 5, 1}, usual) == usual);
    for (const Vec3f flat : {Vec3f{1, 0.02f, 1}, Vec3f{3, 0.1f, 1}, Vec3f{1, 0.1f, 2}}) CHECK(chosen(flat, usual).elevation_deg > 35);
    CHECK(chosen({2, 1, 0.05f}, usual).azimuth_deg < 30);
    CHECK(chosen({0.05f, 1, 2}, usual).azimuth_deg > 60);
    ViewSettings asked;
    asked.elevation_deg = 5;
    CHECK(chosen({1, 0.02f, 1}, asked) == asked);
    // The scene's front counts, its size and place do not.
    Scene scene = with(make_box({200, 4, 200}));
    scene.faces_back = true;
    scene.instances[0].world_from_object = translation({1e5f, -3e4f, 7e5f});
    const ViewSettings behind = choose_view(scene, scene_bounds(scene), 1.0f, usual).view;
    CHECK(behind.azimuth_deg == usual.azimuth_deg + 180);
    CHECK(behind.elevation_deg > 35);
}

TEST_CASE("visible side: a camera inside of a body gives way to a view of the whole", "[raster][view]") {
    Scene scene = with(make_sphere(1.0f, 16, 16));
    Camera inside;
    inside.near_z = 0.01f;
    scene.cameras.push_back(inside);
    CHECK_FALSE(shows_surface(scene, inside, 1.0f));
    CHECK(choose_camera(scene, scene_bounds(scene)) == nullptr);
    CHECK(seen(scene) > 500);
    scene.cameras[0].world_from_camera.c[3].z = 3;
    CHECK(shows_surface(scene, scene.cameras[0], 1.0f));
    CHECK(choose_camera(scene, scene_bounds(scene)) == &scene.cameras[0]);
    scene.cameras[0].world_from_camera.c[3].z = -3;  // behind the camera
    CHECK_FALSE(shows_surface(scene, scene.cameras[0], 1.0f));
}

TEST_CASE("framing: a cloud with one percent of noise is framed without it", "[raster][view]") {
    Mesh cloud;
    cloud.topology = Topology::points;
    const auto add = [&](Vec3f p) {
        cloud.indices.push_back(static_cast<std::uint32_t>(cloud.positions.size()));
        cloud.positions.push_back(p);
    };
    for (int i = 0; i < 1000; ++i)
        add({static_cast<float>(i % 10) / 5 - 1, static_cast<float>(i / 10 % 10) / 5 - 1, static_cast<float>(i / 100) / 5 - 1});
    const Camera alone = frame_scene(with(cloud), 1.0f);
    for (int i = 0; i < 10; ++i) add({static_cast<float>(i % 3 - 1) * 9, 10 - static_cast<float>(i), static_cast<float>(i % 2) * 18 - 9});
    const Camera noisy = frame_scene(with(cloud), 1.0f);
    CHECK(noisy.world_from_camera.c[3] == alone.world_from_camera.c[3]);
}
