#include "halflit/camera.hpp"
#include "halflit/scene.hpp"
#include "halflit/shapes.hpp"
#include "raster/view/projection.hpp"
#include "sh/mat4.hpp"
#include "sh/trig.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/random.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace halflit;
using namespace halflit::raster;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

struct Ndc {
    double x, y, z, w;  // w before the division
};

Ndc project(const Mat4& clip, Vec3d p) {
    double r[4];
    const double in[4] = {p.x, p.y, p.z, 1.0};
    for (int row = 0; row < 4; ++row) {
        r[row] = 0.0;
        for (int j = 0; j < 4; ++j) {
            const Vec4f& c = clip.c[j];
            const float e[4] = {c.x, c.y, c.z, c.w};
            r[row] += e[row] * in[j];
        }
    }
    return {r[0] / r[3], r[1] / r[3], r[2] / r[3], r[3]};
}

bool all_finite(const Mat4& m) {
    for (const Vec4f& c : m.c)
        if (!std::isfinite(c.x) || !std::isfinite(c.y) || !std::isfinite(c.z) || !std::isfinite(c.w)) return false;
    return true;
}

std::vector<Vec3d> corners(const Bounds& b) {
    std::vector<Vec3d> out;
    for (int i = 0; i < 8; ++i) out.push_back({i & 1 ? b.max.x : b.min.x, i & 2 ? b.max.y : b.min.y, i & 4 ? b.max.z : b.min.z});
    return out;
}

Bounds box(Vec3f low, Vec3f high) {
    Bounds b;
    b.add(low);
    b.add(high);
    return b;
}

}  // namespace

TEST_CASE("camera: reversed depth is 1 at the near plane and 0 at the far plane", "[raster][camera]") {
    for (const bool orthographic : {false, true}) {
        Camera camera;
        camera.orthographic = orthographic;
        camera.near_z = 0.25f;
        camera.far_z = 40.0f;
        const Mat4 clip = clip_from_world(camera, 1.5f);
        INFO("orthographic " << orthographic);
        CHECK(project(clip, {0.3, -0.2, -0.25}).z == Approx(1.0).epsilon(1e-6));
        CHECK(project(clip, {0.3, -0.2, -40.0}).z == Approx(0.0).margin(1e-6));
        // Depth falls with distance everywhere.
        double last = 2.0;
        for (double z = 0.25; z < 40.0; z *= 1.1) {
            const double depth = project(clip, {0, 0, -z}).z;
            CHECK(depth < last);
            last = depth;
        }
    }
}

TEST_CASE("camera: without a far limit depth is near over distance", "[raster][camera]") {
    Camera camera;
    camera.near_z = 0.5f;
    const Mat4 clip = clip_from_world(camera, 1.0f);
    for (const double distance : {0.5, 1.0, 7.0, 1e6, 1e30})
        CHECK(project(clip, {0, 0, -distance}).z == Approx(0.5 / distance).epsilon(1e-6));
}

TEST_CASE("camera: perspective projection follows its closed form", "[raster][camera]") {
    Camera camera;
    camera.fov_y_rad = 1.0f;
    const Mat4 clip = clip_from_world(camera, 2.0f);
    const double t = std::tan(0.5);
    const Ndc p = project(clip, {0.7, -0.4, -3.0});
    CHECK(p.w == Approx(3.0).epsilon(1e-7));
    CHECK(p.x == Approx(0.7 / (3.0 * t * 2.0)).epsilon(1e-6));
    CHECK(p.y == Approx(-0.4 / (3.0 * t)).epsilon(1e-6));
}

TEST_CASE("camera: a placed camera sees what is in front of it in the middle", "[raster][camera]") {
    // Quarter turn to the left about y: the camera at (1, 2, 3) looks along -x.
    Camera camera;
    camera.world_from_camera = {{{0, 0, -1, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}, {1, 2, 3, 1}}};
    for (const bool orthographic : {false, true}) {
        camera.orthographic = orthographic;
        const Mat4 clip = clip_from_world(camera, 1.0f);
        const Ndc middle = project(clip, {-4, 2, 3});
        CHECK(middle.x == Approx(0).margin(1e-6));
        CHECK(middle.y == Approx(0).margin(1e-6));
        CHECK(middle.w > 0);
        CHECK(project(clip, {-4, 2.5, 3}).y > 0);  // up in the world is up in the picture
        CHECK(project(clip, {-4, 2, 2.5}).x > 0);  // looking along -x, -z is to the right
    }
}

TEST_CASE("camera: an orthographic view of half height 1 is the identity in x and y", "[raster][camera]") {
    Camera camera;
    camera.orthographic = true;
    camera.near_z = 0.0f;
    camera.far_z = 1.0f;
    const Mat4 clip = clip_from_world(camera, 1.0f);
    for (const Vec3f p : {Vec3f{0.1f, -0.7f, -0.3f}, Vec3f{-1.0f, 1.0f, -0.9f}}) {
        const Vec4f c = clip * Vec4f{p.x, p.y, p.z, 1.0f};
        CHECK(c.x == p.x);
        CHECK(c.y == p.y);
        CHECK(c.z == 1.0f + p.z);
        CHECK(c.w == 1.0f);
    }
}

TEST_CASE("camera: the picture shows at least the view the camera is made for, and fits one side of it", "[raster][camera]") {
    for (const bool orthographic : {false, true})
        for (const float made_for : {0.5f, 1.0f, 1.7777778f, 4.0f})
            for (const float picture : {0.25f, 0.5f, 1.0f, 1.5f, 1.7777778f, 3.0f, 10.0f}) {
                Camera camera;
                camera.orthographic = orthographic;
                camera.aspect = made_for;
                camera.fov_y_rad = 0.8f;
                camera.half_height = 2.0f;
                camera.half_width = 2.0f * made_for;
                const Mat4 clip = clip_from_world(camera, picture);
                const double y = orthographic ? 2.0 : std::tan(0.4), x = y * made_for;
                const Ndc corner = project(clip, {x, y, -1.0});
                INFO("orthographic " << orthographic << " made for " << made_for << " picture " << picture);
                CHECK(corner.x <= 1.0 + 1e-6);
                CHECK(corner.y <= 1.0 + 1e-6);
                CHECK(std::max(corner.x, corner.y) == Approx(1.0).epsilon(1e-6));
                // Square pixels: equal lengths stay equal on the screen.
                CHECK(corner.x / x * picture == Approx(corner.y / y).epsilon(1e-6));
            }
}

TEST_CASE("camera: invalid numbers still give a finite projection that looks ahead", "[raster][camera]") {
    for (const float fov : {0.0f, -1.0f, 3.14159274f, 100.0f, kNan, kInf, 1e-30f})
        for (const float near_z : {0.0f, -1.0f, 1e-3f, 5.0f, kNan, kInf})
            for (const float far_z : {0.0f, -3.0f, 1e-3f, 5.0f, kNan, kInf})
                for (const float aspect : {0.0f, -1.0f, 1.0f, 1e30f, kNan, kInf})
                    for (const bool orthographic : {false, true}) {
                        Camera camera;
                        camera.orthographic = orthographic;
                        camera.fov_y_rad = fov;
                        camera.half_height = fov;
                        camera.half_width = aspect;
                        camera.aspect = aspect;
                        camera.near_z = near_z;
                        camera.far_z = far_z;
                        const Mat4 clip = clip_from_world(camera, aspect);
                        INFO("fov " << fov << " near " << near_z << " far " << far_z << " aspect " << aspect << " ortho " << orthographic);
                        REQUIRE(all_finite(clip));
                        const Ndc a = project(clip, {0, 0, -10}), b = project(clip, {0, 0, -20});
                        CHECK(a.w > 0);
                        CHECK(a.z >= b.z);
                        CHECK(clip.c[0].x > 0);
                        CHECK(clip.c[1].y > 0);
                    }
}

TEST_CASE("framing: every corner is in the picture, with a margin, and one side is filled", "[raster][camera]") {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    int framed = 0;
    for (const float aspect : {0.2f, 0.5625f, 1.0f, 1.7777778f, 3.0f})
        for (float azimuth = -180; azimuth <= 180; azimuth += 30)
            for (const float elevation : {-90.0f, -30.0f, 0.0f, 20.0f, 89.0f, 90.0f, 135.0f})
                for (const float fov : {1.0f, 35.0f, 90.0f}) {
                    const float size = std::pow(10.0f, unit(random) * 8 - 4);
                    const Vec3f low{unit(random) * 10 - 5, unit(random) * 10 - 5, unit(random) * 10 - 5};
                    const Vec3f extent{unit(random) * size, unit(random) * size, unit(random) * size};
                    const Bounds bounds = box(low, low + extent);
                    const Camera camera = frame_bounds(bounds, aspect, {azimuth, elevation, 1.0f, fov});
                    const Mat4 clip = clip_from_world(camera, aspect);
                    INFO("aspect " << aspect << " azimuth " << azimuth << " elevation " << elevation << " fov " << fov << " size " << size);
                    double widest = 0, nearest = 1e300;
                    for (const Vec3d& p : corners(bounds)) {
                        const Ndc c = project(clip, p);
                        REQUIRE(c.w > 0);
                        CHECK(c.z < 1.0);  // behind the near plane
                        CHECK(c.z > 0.0);
                        widest = std::max({widest, std::abs(c.x), std::abs(c.y)});
                        nearest = std::min(nearest, c.w);
                    }
                    // Margin of 8 %. The tolerance is the rounding of the eye's float coordinates, as seen at the nearest corner.
                    const Vec4f eye = camera.world_from_camera.c[3];
                    const double eye_rounding = 1e-6 * (1.0 + length(Vec3d{eye.x, eye.y, eye.z}));
                    const double tolerance = 1e-5 + eye_rounding / (std::tan(0.5 * camera.fov_y_rad) * std::min(1.0f, aspect) * nearest);
                    CHECK(widest == Approx(0.87).margin(tolerance));
                    ++framed;
                }
    CHECK(framed == 5 * 13 * 7 * 3);
}

TEST_CASE("framing: a scene is fitted to its vertices, tightly for any shape", "[raster][camera]") {
    Scene scene;
    scene.meshes = {make_torus(2.0f, 0.3f, 48, 16), make_sphere(0.5f, 24, 16)};
    scene.instances = {{0, rotation({0.5f, 0.5f, 0.5f, 0.5f})}, {1, translation({3, 1, -2})}};
    // Margins that are asked for leave no room for a shadow.
    ViewSettings view = {.margin_x = 0.1, .margin_y = 0.1};
    for (const float aspect : {0.5f, 1.0f, 1.7777778f})
        for (float azimuth = 0; azimuth < 360; azimuth += 45)
            for (const float elevation : {-60.0f, 0.0f, 20.0f, 90.0f}) {
                view.azimuth_deg = azimuth, view.elevation_deg = elevation;
                const Mat4 clip = clip_from_world(frame_scene(scene, aspect, view), aspect);
                double left = 0, right = 0, top = 0, bottom = 0;
                for (const Instance& instance : scene.instances)
                    for (const Vec3f& p : scene.meshes[static_cast<std::size_t>(instance.mesh)].positions) {
                        const Vec3f at = transform_point(instance.world_from_object, p);
                        const Ndc c = project(clip, {at.x, at.y, at.z});
                        REQUIRE(c.w > 0);
                        REQUIRE(c.z < 1.0);
                        left = std::max(left, -c.x), right = std::max(right, c.x), bottom = std::max(bottom, -c.y),
                        top = std::max(top, c.y);
                    }
                INFO("aspect " << aspect << " azimuth " << azimuth << " elevation " << elevation);
                CHECK(std::max({left, right, top, bottom}) == Approx(0.9).margin(1e-4));
                // The direction that limits the fit touches both margins.
                CHECK(std::max(std::min(left, right), std::min(top, bottom)) == Approx(0.9).margin(1e-4));
                // The margins of the other one are equal, up to a step of the search.
                CHECK(left == Approx(right).margin(0.01));
                CHECK(top == Approx(bottom).margin(0.01));
            }
}

TEST_CASE("framing: several views are those framed one by one, and by parallel rays the extents of the vertices", "[raster][camera]") {
    Scene scene;
    scene.meshes = {make_torus(2.0f, 0.3f, 48, 16), make_sphere(0.5f, 24, 16)};
    scene.instances = {{0, rotation({0.5f, 0.5f, 0.5f, 0.5f})}, {1, translation({3, 1, -2})}};
    const Bounds bounds = scene_bounds(scene);
    constexpr float kAspect = 1.25f;
    std::vector<ViewSettings> views;
    for (const bool parallel : {false, true})
        for (float azimuth = 0; azimuth < 360; azimuth += 40)
            views.push_back({.azimuth_deg = azimuth, .elevation_deg = 0.3f * azimuth - 60.0f, .orthographic = parallel});
    const std::vector<Camera> cameras = frame_each(scene, bounds, kAspect, views);
    REQUIRE(cameras.size() == views.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
        CHECK(cameras[i] == frame_scene(scene, bounds, kAspect, views[i]));
        if (!views[i].orthographic) continue;
        const Mat4& m = cameras[i].world_from_camera;
        double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
        for (const Instance& instance : scene.instances)
            for (const Vec3f& p : scene.meshes[static_cast<std::size_t>(instance.mesh)].positions) {
                const Vec3f at = transform_point(instance.world_from_object, p);
                for (std::size_t k = 0; k < 2; ++k) {
                    const double x = double{m.c[k].x} * at.x + double{m.c[k].y} * at.y + double{m.c[k].z} * at.z;
                    low[k] = std::min(low[k], x), high[k] = std::max(high[k], x);
                }
            }
        const double half = std::max(0.5 * (high[1] - low[1]), 0.5 * (high[0] - low[0]) / kAspect) / 0.87;
        CHECK(cameras[i].half_height == Approx(half).epsilon(1e-6));
    }
}

TEST_CASE("framing: azimuth goes round to the right, elevation goes up", "[raster][camera]") {
    const Bounds bounds = box({-1, -1, -1}, {1, 1, 1});
    const auto eye = [&](float azimuth, float elevation) {
        return frame_bounds(bounds, 1.0f, {azimuth, elevation, 1.0f, 35.0f}).world_from_camera.c[3];
    };
    CHECK(eye(0, 0).z > 1);
    CHECK(eye(0, 0).x == Approx(0).margin(1e-6));
    CHECK(eye(90, 0).x > 1);
    CHECK(eye(0, 90).y > 1);
    CHECK(eye(0, 45).y > 0.5f);
}

TEST_CASE("framing: the camera is placed by a rotation", "[raster][camera]") {
    for (float azimuth = 0; azimuth < 360; azimuth += 17)
        for (float elevation = -90; elevation <= 90; elevation += 15) {
            const Mat4 m = frame_bounds(box({0, 0, 0}, {1, 2, 3}), 1.0f, {azimuth, elevation, 1.0f, 35.0f}).world_from_camera;
            CHECK(determinant3(m) == Approx(1.0).epsilon(1e-6));
            const Vec3f c[3] = {{m.c[0].x, m.c[0].y, m.c[0].z}, {m.c[1].x, m.c[1].y, m.c[1].z}, {m.c[2].x, m.c[2].y, m.c[2].z}};
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) CHECK(dot(c[i], c[j]) == Approx(i == j ? 1.0 : 0.0).margin(1e-6));
        }
}

TEST_CASE("framing: zoom 2 doubles every distance on the screen", "[raster][camera]") {
    const Bounds bounds = box({-1, 0, -2}, {1, 1, 2});
    for (const float zoom : {0.25f, 1.0f, 2.0f, 50.0f}) {
        const Mat4 plain = clip_from_world(frame_bounds(bounds, 1.6f, {20, 30, 1.0f, 40.0f}), 1.6f);
        const Mat4 zoomed = clip_from_world(frame_bounds(bounds, 1.6f, {20, 30, zoom, 40.0f}), 1.6f);
        for (const Vec3d& p : corners(bounds)) {
            CHECK(project(zoomed, p).x == Approx(zoom * project(plain, p).x).epsilon(1e-5).margin(1e-6));
            CHECK(project(zoomed, p).y == Approx(zoom * project(plain, p).y).epsilon(1e-5).margin(1e-6));
        }
    }
}

TEST_CASE("framing: no bounds, a point, a line, a plane and huge boxes give a camera that looks at them", "[raster][camera]") {
    const float huge = std::numeric_limits<float>::max();
    for (const Bounds& bounds :
         {Bounds{}, box({0, 0, 0}, {0, 0, 0}), box({5e5f, -3, 2}, {5e5f, -3, 2}), box({1e-30f, 0, 0}, {1e-30f, 0, 0}),
          box({0, 0, -4}, {0, 0, 4}), box({-1, 0, -1}, {1, 0, 1}), box({-huge, -huge, -huge}, {huge, huge, huge})})
        for (const float azimuth : {0.0f, 35.0f, 90.0f})
            for (const float aspect : {1.0f, kNan, 0.0f}) {
                const Camera camera = frame_bounds(bounds, aspect, {azimuth, 0.0f, kNan, kNan});
                INFO("bounds from " << bounds.min.x << " to " << bounds.max.x << ", azimuth " << azimuth);
                REQUIRE(all_finite(camera.world_from_camera));
                CHECK(camera.near_z > 0.0f);
                CHECK(std::isfinite(camera.near_z));
                CHECK(camera.fov_y_rad > 0.0f);
                if (bounds.max.x == huge) continue;  // beyond what the framing promises to show
                const Vec3f c = bounds.center();
                const Ndc middle = project(clip_from_world(camera, aspect), {c.x, c.y, c.z});
                CHECK(middle.w > 0);
                CHECK(std::abs(middle.x) < 1.0);
                CHECK(std::abs(middle.y) < 1.0);
                CHECK(middle.z < 1.0);
            }
}

TEST_CASE("bounds: points that are not finite are left out", "[raster][camera]") {
    Bounds bounds;
    bounds.add({kNan, 0, 0});
    bounds.add({0, kInf, 0});
    CHECK(bounds.empty);
    bounds.add({1, 2, 3});
    bounds.add({-1, 4, kNan});
    bounds.add({3, -2, 3});
    CHECK(bounds.min == Vec3f{1, -2, 3});
    CHECK(bounds.max == Vec3f{3, 2, 3});
    CHECK(bounds.center() == Vec3f{2, 0, 3});
    CHECK(bounds.radius() == Approx(std::sqrt(5.0)));
}

TEST_CASE("orbit: away from the poles it is look_at from the same eye", "[camera]") {
    test::Random random(7);
    for (int i = 0; i < 500; ++i) {
        const double azimuth = random.real(-400, 400), elevation = random.real(-85, 85), distance = random.real(0.1, 50);
        const Vec3d target{random.real(-9, 9), random.real(-9, 9), random.real(-9, 9)};
        const double a = azimuth * (3.14159265358979323846 / 180), e = elevation * (3.14159265358979323846 / 180);
        const Vec3d eye{target.x + distance * std::cos(e) * std::sin(a), target.y + distance * std::sin(e),
                        target.z + distance * std::cos(e) * std::cos(a)};
        const Mat4 made = orbit(target, azimuth, elevation, distance);
        const auto narrow = [](Vec3d v) { return Vec3f{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; };
        const Mat4 looked = look_at(narrow(eye), narrow(target));
        const auto near = [&](float x, float y, double scale) { return std::abs(x - y) <= 2e-6 * scale; };
        for (std::size_t c = 0; c < 4; ++c) {
            // look_at() has points rounded to float: 5e-7 at 9, over the distance.
            const double scale = c == 3 ? 20 : 1 + 9 / distance;
            CHECK((near(made.c[c].x, looked.c[c].x, scale) && near(made.c[c].y, looked.c[c].y, scale) &&
                   near(made.c[c].z, looked.c[c].z, scale)));
        }
    }
}

TEST_CASE("orbit: from straight above, the picture's up is that of the side", "[camera]") {
    const Mat4 above = orbit({1, 2, 3}, 0, 90, 4);
    CHECK(std::abs(above.c[1].z + 1) < 1e-6f);  // away from the viewer in front
    CHECK(std::abs(above.c[3].y - 6) < 1e-6f);
    const Mat4 right = orbit({1, 2, 3}, 90, 90, 4);
    CHECK(std::abs(right.c[1].x + 1) < 1e-6f);
}
