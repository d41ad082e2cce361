// Cameras with sides of their own: calibrations, lens shift, pixels that are not square, orthographic views, and cameras that mirror.
#include "halflit/renderer.hpp"
#include "halflit/scene.hpp"
#include "halflit/shapes.hpp"
#include "raster/view/projection.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <vector>

using namespace halflit;
using halflit::test::camera_at;
using halflit::test::Random;

namespace {

/// A rotation about a random axis, row by row.
std::array<double, 9> random_rotation(Random& random) {
    double q[4], size = 0;
    do {
        size = 0;
        for (double& x : q) x = random.real(-1, 1), size += x * x;
    } while (size > 1 || size < 0.1);
    for (double& x : q) x /= std::sqrt(size);
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z),    1 - 2 * (x * x + z * z),
            2 * (y * z - w * x),     2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)};
}

/// Where a point appears, in pixels from the upper left corner of a picture.
std::array<double, 2> pixel_of(const Camera& camera, Vec3f p, int width, int height) {
    const Mat4 m = raster::clip_from_world(camera, static_cast<float>(width) / static_cast<float>(height));
    const auto row = [&](auto member) {
        return double{m.c[0].*member} * p.x + double{m.c[1].*member} * p.y + double{m.c[2].*member} * p.z + double{m.c[3].*member};
    };
    const double w = row(&Vec4f::w);
    return {(row(&Vec4f::x) / w + 1) * 0.5 * width, (1 - row(&Vec4f::y) / w) * 0.5 * height};
}

Scene box_scene() {
    Scene scene;
    scene.meshes.push_back(make_box({1, 1, 1}));
    scene.instances.push_back({0, {}});
    return scene;
}

std::vector<float> depths(const Scene& scene, const Camera& camera, int width, int height) {
    std::vector<float> depth(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    Target target{width, height, nullptr, nullptr};
    target.depth = depth.data();
    const auto drawn = render(scene, camera, {}, target);
    INFO((drawn ? "" : drawn.error().message));
    REQUIRE(drawn);
    return depth;
}

}  // namespace

TEST_CASE("camera: a calibration reprojects 1,000 points within 1e-3 pixel", "[raster][camera]") {
    Random random(3);
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
        const Intrinsics lens{600, 590, 331.3, 247.9, 640, 480, i % 2 == 0 ? 0.0 : 0.5};
        const auto r = random_rotation(random);
        const std::array<double, 3> t{random.real(-2, 2), random.real(-2, 2), random.real(-2, 2)};
        const auto camera = Camera::from_intrinsics(lens, r, t);
        REQUIRE(camera);
        // A point that the camera sees: a place in the picture, and a distance.
        const double u = random.real(0, 640), v = random.real(0, 480), z = random.real(0.5, 20);
        const double seen[] = {(u - lens.cx) / lens.fx * z - t[0], (v - lens.cy) / lens.fy * z - t[1], z - t[2]};
        double point[3];
        for (int k = 0; k < 3; ++k) {
            const auto c = static_cast<std::size_t>(k);
            point[k] = r[c] * seen[0] + r[3 + c] * seen[1] + r[6 + c] * seen[2];
        }
        const Vec3f p{static_cast<float>(point[0]), static_cast<float>(point[1]), static_cast<float>(point[2])};
        const auto at = pixel_of(*camera, p, 640, 480);
        // The middle of the first pixel is half a pixel from the picture's corner.
        const double corner = 0.5 - lens.first_pixel;
        worst = std::max({worst, std::fabs(at[0] - (u + corner)), std::fabs(at[1] - (v + corner))});
    }
    INFO("worst " << worst);
    CHECK(worst < 1e-3);
}

TEST_CASE("camera: a calibration in the middle with square pixels is the camera of its field of view", "[raster][camera]") {
    const Camera by_angle = camera_at({2, 3, 4}, {0, 0, 0});
    const double f = 240 / std::tan(0.5 * double{by_angle.fov_y_rad});
    Camera by_pixels = by_angle;
    by_pixels.sides = Camera::from_intrinsics({f, f, 319.5, 239.5, 640, 480}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0})->sides;
    const Scene scene = box_scene();
    const auto want = depths(scene, by_angle, 640, 480), got = depths(scene, by_pixels, 640, 480);
    std::size_t differing = 0;
    for (std::size_t i = 0; i < want.size(); ++i) differing += std::fabs(want[i] - got[i]) > 1e-4f ? 1 : 0;
    CHECK(differing < 40);  // pixels on an edge
    CHECK(by_pixels.made_for_aspect() == Approx(640.0 / 480));
}

TEST_CASE("camera: a part of a view by its sides is that part of the picture", "[raster][camera]") {
    const Scene scene = box_scene();
    Camera whole = camera_at({2, 3, 4}, {0, 0, 0});
    for (const bool orthographic : {false, true}) {
        whole.orthographic = orthographic;
        if (orthographic) whole.near_z = 0.1f, whole.far_z = 20;
        whole.sides = ViewSides{-0.5f, 0.5f, -0.25f, 0.25f};
        Camera upper_right = whole;
        upper_right.sides = ViewSides{0, 0.5f, 0, 0.25f};
        const auto all = depths(scene, whole, 128, 64), part = depths(scene, upper_right, 64, 32);
        std::size_t equal = 0;
        for (std::size_t y = 0; y < 32; ++y)
            for (std::size_t x = 0; x < 64; ++x) {
                const float a = all[y * 128 + 64 + x], b = part[y * 64 + x];
                equal += a == b || std::fabs(a - b) < 1e-4f ? 1 : 0;
            }
        CHECK(equal > 64 * 32 - 8);
    }
}

TEST_CASE("camera: a matrix that mirrors is refused with the reason, and so is a rotation that is none", "[raster][camera]") {
    const Scene scene = box_scene();
    Camera camera = camera_at({2, 3, 4}, {0, 0, 0});
    camera.world_from_camera.c[2] = {-camera.world_from_camera.c[2].x, -camera.world_from_camera.c[2].y, -camera.world_from_camera.c[2].z,
                                     0};
    const auto refused = render(scene, camera, {}, {8, 8, nullptr, nullptr});
    REQUIRE_FALSE(refused);
    CHECK(refused.error().code == ErrorCode::usage);
    CHECK(refused.error().message.find("mirrors") != std::string::npos);
    const Intrinsics lens{600, 600, 320, 240, 640, 480};
    const auto by = [&](std::array<double, 9> r) { return Camera::from_intrinsics(lens, r, {0, 0, 0}); };
    CHECK(by({1, 0, 0, 0, 1, 0, 0, 0, 1}).has_value());
    CHECK(by({1, 0, 0, 0, -1, 0, 0, 0, 1}).error().message.find("mirrors") != std::string::npos);
    CHECK_FALSE(by({2, 0, 0, 0, 1, 0, 0, 0, 1}).has_value());
    CHECK_FALSE(by({1, 0, 0, 0, 1, 0, 0, 0, std::nan("")}).has_value());
    CHECK_FALSE(Camera::from_intrinsics({0, 600, 320, 240, 640, 480}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}).has_value());
    camera = camera_at({2, 3, 4}, {0, 0, 0});
    camera.sides = ViewSides{1, -1, -1, 1};
    CHECK_FALSE(render(scene, camera, {}, {8, 8, nullptr, nullptr}).has_value());
}

TEST_CASE("camera: an orthographic view of a scene shows all of it, with the usual margin", "[raster][camera]") {
    Random random(8);
    for (int i = 0; i < 40; ++i) {
        Scene scene = box_scene();
        const auto size = [&] { return static_cast<float>(std::exp(random.real(-4, 4))); };
        scene.meshes[0] = make_box({size(), size(), size()});
        ViewSettings view;
        view.orthographic = true;
        view.azimuth_deg = static_cast<float>(random.real(0, 360)), view.elevation_deg = static_cast<float>(random.real(-90, 90));
        const Camera camera = frame_scene(scene, 1.5f, view);
        CHECK(camera.orthographic);
        double most_x = 0, most_y = 0;
        for (const Vec3f& p : scene.meshes[0].positions) {
            const auto at = pixel_of(camera, p, 300, 200);
            most_x = std::max(most_x, std::fabs(at[0] - 150) / 150), most_y = std::max(most_y, std::fabs(at[1] - 100) / 100);
            const Mat4 m = raster::clip_from_world(camera, 1.5f);
            const double z = double{m.c[0].z} * p.x + double{m.c[1].z} * p.y + double{m.c[2].z} * p.z + double{m.c[3].z};
            CHECK((z > 0 && z < 1));
        }
        CHECK(std::max(most_x, most_y) == Approx(0.87).margin(0.005));
    }
}
