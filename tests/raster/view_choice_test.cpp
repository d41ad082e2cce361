// Views that would show nothing: another side, or the whole in place of a camera inside of a body; and clouds with noise.
#include "halflit/auto_setup.hpp"
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "raster/view/projection.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
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

TEST_CASE("view: a vertex far away, which is not framed, turns no view", "[raster][view]") {
    const auto chosen = [](const Mesh& mesh) {
        const Scene scene = with(mesh);
        return choose_view(scene, scene_bounds(scene), 1.0f, {});
    };
    Mesh strayed = make_sphere(1.0f, 32, 64);
    const FramedView alone = chosen(strayed);
    // Its slivers are a flat surface, larger than the ball's.
    for (const float far : {1e4f, 1e12f}) {
        Mesh mesh = strayed;
        const auto last = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back({far, 0, 0});
        mesh.normals.push_back({0, 1, 0});
        if (!mesh.uv0.empty()) mesh.uv0.push_back({0, 0});
        if (!mesh.tangents.empty()) mesh.tangents.push_back({1, 0, 0, 1});
        for (const std::uint32_t v : {0u, 100u, 200u}) mesh.indices.insert(mesh.indices.end(), {v, v + 1, last});
        CAPTURE(far);
        CHECK(chosen(mesh).view == alone.view);
        CHECK(chosen(mesh).camera == alone.camera);
    }
}

TEST_CASE("view: what is open at the top is seen from farther above", "[raster][view]") {
    const ViewSettings usual;
    // A block, and the same with a hole, of four blocks around it.
    const auto frame = [](float inner) {
        Scene scene;
        const float wall = (1 - inner) / 2, middle = (1 + inner) / 2;
        for (const auto& [half, at] :
             {std::pair{Vec3f{wall, 1, 1}, Vec3f{middle, 0, 0}}, std::pair{Vec3f{wall, 1, 1}, Vec3f{-middle, 0, 0}},
              std::pair{Vec3f{inner, 1, wall}, Vec3f{0, 0, middle}}, std::pair{Vec3f{inner, 1, wall}, Vec3f{0, 0, -middle}}}) {
            scene.instances.push_back({static_cast<int>(scene.meshes.size()), translation(at)});
            scene.meshes.push_back(make_box(half));
        }
        return scene;
    };
    const auto chosen = [&](const Scene& scene) { return choose_view(scene, scene_bounds(scene), 1.0f, usual); };
    const FramedView open = chosen(frame(0.5f));
    CHECK(open.view.elevation_deg == 35);
    CHECK(open.view.azimuth_deg == usual.azimuth_deg);
    CHECK(open.reason == ViewReason::hollow);
    Scene closed = frame(0.5f);  // with a lid
    closed.instances.push_back({static_cast<int>(closed.meshes.size()), translation({0, 0.9f, 0})});
    closed.meshes.push_back(make_box({0.5f, 0.1f, 0.5f}));
    CHECK(chosen(closed).view == usual);
    Scene slit = frame(0.5f);  // a wall is missing: nothing is enclosed
    slit.instances.pop_back();
    CHECK(chosen(slit).view.elevation_deg < 25);
}

TEST_CASE("view: like models get like views", "[raster][view]") {
    const ViewSettings usual;
    const auto chosen = [&](const Mesh& mesh) {
        const Scene scene = with(mesh);
        return choose_view(scene, scene_bounds(scene), 1.0f, usual).view;
    };
    const auto differ = [](const ViewSettings& a, const ViewSettings& b) {
        return std::max(std::abs(a.azimuth_deg - b.azimuth_deg), std::abs(a.elevation_deg - b.elevation_deg));
    };
    const ViewSettings torus = chosen(make_torus(1, 0.25f, 64, 32));
    Mesh upright_torus = make_torus(1, 0.25f, 64, 32);
    for (Vec3f& p : upright_torus.positions) p = {p.x, -p.z, p.y};
    const ViewSettings upright = chosen(upright_torus);
    for (const float tube : {0.15f, 0.2f, 0.3f, 0.35f, 0.4f}) {
        Mesh mesh = make_torus(1, tube, 64, 32);
        CHECK(differ(chosen(mesh), torus) < 5);
        for (Vec3f& p : mesh.positions) p = {p.x, -p.z, p.y};
        CHECK(differ(chosen(mesh), upright) < 5);
    }
    for (const bool flat : {true, false}) {
        const auto slab = [&](float thin) { return chosen(make_box(flat ? Vec3f{3, thin, 2} : Vec3f{3, 2, thin})); };
        for (float thin = 0.05f; thin < 2.0f; thin += 0.05f) CHECK(differ(slab(thin), slab(thin + 0.05f)) < 6);
        CHECK(differ(slab(0.05f), usual) > 20);
        CHECK(slab(2.0f) == usual);
    }
}

TEST_CASE("view: there is room for the shadow below what stands", "[raster][view]") {
    const Scene scene = with(make_box({1, 1, 1}));
    const Bounds bounds = scene_bounds(scene);
    const auto reach = [&](const Camera& camera, Vec3f point) {  // 1: the picture's border
        const Mat4 clip = raster::clip_from_world(camera, 1.0f);
        const auto row = [&](float Vec4f::*of) {
            return ((clip.c[0].*of * point.x + clip.c[1].*of * point.y) + clip.c[2].*of * point.z) + clip.c[3].*of;
        };
        return Vec2f{row(&Vec4f::x) / row(&Vec4f::w), row(&Vec4f::y) / row(&Vec4f::w)};
    };
    const Camera tight = frame_bounds(bounds, 1.0f, {}), roomy = choose_view(scene, bounds, 1.0f, {}).camera;
    float largest = 0, lowest = 0, low_before = 0, width_before = 0, width = 0;
    for (const float x : {-1.0f, 1.0f})
        for (const float y : {-1.0f, 1.0f})
            for (const float z : {-1.0f, 1.0f}) {
                const Vec2f before = reach(tight, {x, y, z}), after = reach(roomy, {x, y, z});
                largest = std::max({largest, std::abs(after.x), std::abs(after.y)});
                lowest = std::min(lowest, after.y), low_before = std::min(low_before, before.y);
                width_before = std::max(width_before, std::abs(before.x)), width = std::max(width, std::abs(after.x));
            }
    CHECK(largest < 0.93f);
    CHECK(lowest > low_before + 0.05f);
    CHECK(width > 0.93f * width_before);
    // Margins that were asked for stay, and drawings have no such shadow.
    ViewSettings view;
    view.margin_x = view.margin_y = 0.05;
    CHECK(choose_view(scene, bounds, 1.0f, view).camera == frame_scene(scene, bounds, 1.0f, view));
    view = {.orthographic = true};
    CHECK(choose_view(scene, bounds, 1.0f, view).camera == frame_scene(scene, bounds, 1.0f, view));
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
