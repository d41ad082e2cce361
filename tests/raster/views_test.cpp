// Views of a drawing: named directions, one scale for all sides, and margins, compared with projections in double.
#include "halflit/camera.hpp"
#include "halflit/scene.hpp"
#include "halflit/shapes.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"
#include "tests/raster/edge_reference.hpp"
#include "tests/support/random.hpp"

#include <map>
#include <string>

using namespace halflit;
using namespace halflit::raster::test;
using halflit::test::Random;

namespace {

Vec3d axis(const Camera& camera, int i) {
    const Vec4f c = camera.world_from_camera.c[i];
    return {c.x, c.y, c.z};
}

ViewSettings named(std::string_view name) {
    for (const NamedView& view : kNamedViews)
        if (view.name == name) {
            ViewSettings settings;
            settings.azimuth_deg = view.azimuth_deg, settings.elevation_deg = view.elevation_deg;
            return settings;
        }
    FAIL("no such view");
    return {};
}

/// One to three meshes of random triangles, far from the origin and of any size.
Scene random_scene(Random& random) {
    Scene scene;
    const double size = random.chance(0.5) ? 1.0 : random.chance(0.5) ? 1e-3 : 2e4;
    const Vec3f middle{random.real32(-9 * size, 9 * size), random.real32(-9 * size, 9 * size), random.real32(-9 * size, 9 * size)};
    for (int m = random.index(3); m >= 0; --m) {
        Mesh mesh;
        const Vec3f half{random.real32(0.1, 1), random.real32(0.1, 1), random.real32(0.1, 1)};
        for (std::uint32_t i = 0; i < 60; ++i) {
            const auto one = [&](float most) { return random.real32(-double{most} * size, double{most} * size); };
            mesh.positions.push_back(middle + Vec3f{one(half.x), one(half.y), one(half.z)});
            mesh.indices.push_back(i);
        }
        scene.instances.push_back({m, {}});
        scene.meshes.insert(scene.meshes.begin(), std::move(mesh));
    }
    return scene;
}

/// The largest part of the half picture within the margins that a vertex takes: 1 at the margin.
double reach_of(const Scene& scene, const Camera& camera, float aspect, const ViewSettings& view) {
    constexpr int kHeight = 1000;
    const double width = kHeight * double{aspect};
    const WindowOf window(camera, 0, kHeight);  // the middle of the picture is x = 0
    double most = 0;
    for (const Mesh& mesh : scene.meshes)
        for (const Vec3f p : mesh.positions) {
            const Point2 at = window.point(to_double(p));
            REQUIRE(window.depth(to_double(p)) > double{camera.near_z});
            most = std::max({most, std::abs(at.x) / (0.5 * width * (1 - view.margin_x)),
                             std::abs(at.y - 0.5 * kHeight) / (0.5 * kHeight * (1 - view.margin_y))});
        }
    return most;
}

Vec3d middle_of(const Scene& scene) {
    const Bounds bounds = scene_bounds(scene);
    return (to_double(bounds.min) + to_double(bounds.max)) * 0.5;
}
double distance_of(const Camera& camera, Vec3d middle) { return length(axis(camera, 3) - middle); }

/// Cameras have coordinates of 24 bits, a scene nine sizes away from the origin 20 of them for itself.
constexpr double kRounding = 1e-5;

}  // namespace

TEST_CASE("views: names are the sides of a technical drawing", "[raster][views]") {
    Scene scene;
    scene.meshes.push_back(make_box({1, 2, 3}));
    scene.instances.push_back({0, {}});
    const std::map<std::string, std::pair<Vec3d, Vec3d>> right_and_up = {
        {"front", {{1, 0, 0}, {0, 1, 0}}},  {"back", {{-1, 0, 0}, {0, 1, 0}}}, {"left", {{0, 0, 1}, {0, 1, 0}}},
        {"right", {{0, 0, -1}, {0, 1, 0}}}, {"top", {{1, 0, 0}, {0, 0, -1}}},  {"bottom", {{1, 0, 0}, {0, 0, 1}}}};
    for (const auto& [name, axes] : right_and_up) {
        const Camera camera = frame_scene(scene, 1.0f, named(name));
        CAPTURE(name);
        CHECK(length(axis(camera, 0) - axes.first) < 1e-7);
        CHECK(length(axis(camera, 1) - axes.second) < 1e-7);
        CHECK(length(axis(camera, 2) - cross(axes.first, axes.second)) < 1e-7);
        CHECK(dot(axis(camera, 3), axis(camera, 2)) > 3);  // the eye is on that side
    }
    CHECK(std::size(kNamedViews) == right_and_up.size() + 1);
}

TEST_CASE("views: iso shows three equal axes at 120 degrees", "[raster][views]") {
    Scene scene;
    scene.meshes.push_back(make_box({1, 1, 1}));
    scene.instances.push_back({0, {}});
    ViewSettings view = named("iso");
    view.orthographic = true;
    const Camera camera = frame_scene(scene, 1.0f, view);
    const WindowOf window(camera, 1000, 1000);
    const Point2 o = window.point({0, 0, 0});
    double angle[3], size[3];
    const Vec3d axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int k = 0; k < 3; ++k) {
        const Point2 p = window.point(axes[k]);
        size[k] = std::hypot(p.x - o.x, p.y - o.y);
        angle[k] = std::atan2(o.y - p.y, p.x - o.x) * 180 / 3.14159265358979;
    }
    for (const int k : {1, 2}) CHECK(std::abs(size[k] / size[0] - 1) < 1e-6);
    CHECK(std::abs(angle[1] - 90) < 1e-4);
    CHECK(std::abs(angle[0] + 30) < 1e-4);
    CHECK(std::abs(angle[2] + 150) < 1e-4);
}

TEST_CASE("views: any_side keeps 200 directions of a scene within the margins, at one distance and one scale", "[raster][views]") {
    Random random(77);
    double largest = 0;
    for (int trial = 0; trial < 16; ++trial) {
        const Scene scene = random_scene(random);
        const Vec3d middle = middle_of(scene);
        const float aspect = random.real32(0.4, 2.5);
        ViewSettings view;
        view.any_side = true;
        view.orthographic = trial % 2 == 1;
        view.margin_x = random.real(0, 0.5), view.margin_y = random.real(0, 0.5);
        const Camera first = frame_scene(scene, aspect, view);
        for (int k = 0; k < 200; ++k) {
            view.azimuth_deg = random.real32(-180, 180), view.elevation_deg = random.real32(-90, 90);
            const Camera camera = frame_scene(scene, aspect, view);
            const double reach = reach_of(scene, camera, aspect, view);
            largest = std::max(largest, reach);
            CHECK(reach < 1 + kRounding);
            CHECK(std::abs(distance_of(camera, middle) / distance_of(first, middle) - 1) < kRounding);
            CHECK(camera.half_height == first.half_height);
            CHECK(camera.fov_y_rad == first.fov_y_rad);
            CHECK(camera.near_z == first.near_z);
        }
    }
    CHECK(largest > 0.9);  // of spheres by their farthest vertex: some direction comes near the margin
}

TEST_CASE("views: of several the tightest touches its margin and none crosses it", "[raster][views]") {
    Random random(78);
    for (int trial = 0; trial < 60; ++trial) {
        const Scene scene = random_scene(random);
        const Vec3d middle = middle_of(scene);
        const float aspect = random.real32(0.4, 2.5);
        ViewSettings view;
        view.orthographic = trial % 2 == 1;
        view.margin_x = random.real(0, 0.5), view.margin_y = random.real(0, 0.5);
        std::vector<ViewSettings> views;
        for (int k = random.index(6); k >= 0; --k) {
            view.azimuth_deg = random.real32(-180, 180), view.elevation_deg = random.real32(-90, 90);
            views.push_back(view);
        }
        const auto cameras = frame_views(scene, scene_bounds(scene), aspect, views);
        REQUIRE(cameras.size() == views.size());
        double tightest = 0;
        for (const Camera& camera : cameras) {
            tightest = std::max(tightest, reach_of(scene, camera, aspect, view));
            CHECK(camera.half_height == cameras[0].half_height);
            CHECK(camera.fov_y_rad == cameras[0].fov_y_rad);
            if (!view.orthographic) CHECK(std::abs(distance_of(camera, middle) / distance_of(cameras[0], middle) - 1) < kRounding);
            const Point2 at = WindowOf(camera, 0, 1000).point(middle);
            CHECK(std::hypot(at.x, at.y - 500) < 1000 * kRounding);
        }
        CAPTURE(trial, view.orthographic, views.size());
        CHECK(std::abs(tightest - 1) < kRounding);
    }
}

TEST_CASE("views: no views, an empty scene and one point give usable cameras", "[raster][views]") {
    const Scene empty;
    CHECK(frame_views(empty, scene_bounds(empty), 1.0f, {}).empty());
    Scene point;
    point.meshes.resize(1);
    point.meshes[0].positions = {{3, 4, 5}};
    point.meshes[0].indices = {0, 0, 0};
    point.instances.push_back({0, {}});
    for (const Scene& scene : {empty, point})
        for (const bool orthographic : {false, true})
            for (const bool any_side : {false, true}) {
                ViewSettings view;
                view.orthographic = orthographic, view.any_side = any_side;
                view.margin_x = std::nan(""), view.margin_y = 1e300;
                for (const Camera& camera : frame_views(scene, scene_bounds(scene), 1.0f, std::vector{view, view})) {
                    CHECK(check_camera(camera));
                    for (int k = 0; k < 4; ++k) CHECK(std::isfinite(length(axis(camera, k))));
                    CHECK((camera.near_z >= 0 && std::isfinite(camera.far_z) && camera.half_height > 0));
                }
            }
}
