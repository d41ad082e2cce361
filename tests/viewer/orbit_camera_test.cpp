#include "apps/viewer/orbit_camera.hpp"

#include "apps/engine/job/view_choice.hpp"
#include "apps/engine/request/render_options.hpp"
#include "raster/view/projection.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

using namespace halflit;
using viewer::OrbitCamera;

namespace {

Bounds box() {
    Bounds bounds;
    bounds.add({-1, -2, -1});
    bounds.add({3, 2, 1});
    return bounds;
}

Vec3d column(const Camera& camera, std::size_t i) {
    const Vec4f& c = camera.world_from_camera.c[i];
    return {c.x, c.y, c.z};
}

/// Distance of a point from the line through the camera along its view.
double off_axis(const Camera& camera, Vec3d p) { return length(cross(p - column(camera, 3), column(camera, 2))); }

const Vec3d kCenter{1, 0, 0};

/// Looks at the centre.
Camera centred() { return engine::placed_camera(look_at({7, 3, 9}, to_float(kCenter)), 40.0f, box()); }

}  // namespace

TEST_CASE("orbit camera: without a motion it is the start camera, bit for bit", "[viewer]") {
    Camera start = frame_bounds(box(), 1.5f, {});
    start.name = "start";
    OrbitCamera orbit(start, box());
    CHECK(orbit.camera() == start);
    orbit.turn(30, 10);
    orbit.zoom(2);
    orbit.pan(5, 5, 100);
    CHECK_FALSE(orbit.camera() == start);
    orbit.reset();
    CHECK(orbit.camera() == start);
}

TEST_CASE("orbit camera: a turn keeps the centre in the middle and the distance", "[viewer]") {
    const Camera start = centred();
    OrbitCamera orbit(start, box());
    const double distance = orbit.distance(), off = off_axis(start, kCenter);
    for (int i = 0; i < 50; ++i) {
        orbit.turn(31, i % 2 == 0 ? 40 : -70);
        const Camera camera = orbit.camera();
        INFO(i);
        CHECK(off_axis(camera, kCenter) < off + 1e-5);
        CHECK(length(column(camera, 3) - kCenter) == Approx(distance).epsilon(1e-5));
        CHECK(column(camera, 0).y == Approx(0.0).margin(1e-6));  // the horizon is level
        CHECK(column(camera, 1).y > 0.0);                        // +y is up, also after many turns over the top
        CHECK(camera.near_z > 0.0f);
    }
}

TEST_CASE("orbit camera: a whole turn comes back, and a drag to the right moves the front to the right", "[viewer]") {
    OrbitCamera orbit(centred(), box());
    orbit.turn(0, 0);
    const Camera before = orbit.camera();
    orbit.turn(9, 0);
    // The point of the scene that is nearest to the viewer goes to the right in the picture.
    const Vec3d nearest = kCenter + column(before, 2);
    CHECK(dot(nearest - column(orbit.camera(), 3), column(orbit.camera(), 0)) > 0.01);
    for (int i = 0; i < 99; ++i) orbit.turn(OrbitCamera::kPixelsOfTurn / 100, 0);
    for (std::size_t i = 0; i < 4; ++i) CHECK(length(column(orbit.camera(), i) - column(before, i)) < 1e-4);
}

TEST_CASE("orbit camera: a pan moves the centre by the mouse's pixels", "[viewer]") {
    const Camera start = centred();
    OrbitCamera orbit(start, box());
    constexpr int kHeight = 200;
    orbit.pan(20, 10, kHeight);
    const Camera camera = orbit.camera();
    const Vec3d seen = kCenter - column(camera, 3);
    const double depth = -dot(seen, column(camera, 2));
    const double tangent = std::tan(static_cast<double>(camera.fov_y_rad) / 2);
    CHECK(dot(seen, column(camera, 0)) / depth / tangent * (kHeight / 2) == Approx(20).epsilon(1e-3));
    CHECK(dot(seen, column(camera, 1)) / depth / tangent * (kHeight / 2) == Approx(-10).epsilon(1e-3));
}

TEST_CASE("orbit camera: a zoom step is a tenth, in perspective and orthographic views", "[viewer]") {
    OrbitCamera orbit(frame_bounds(box(), 1.0f, {}), box());
    const double before = orbit.distance();
    orbit.zoom(1);
    CHECK(orbit.distance() == Approx(before / 1.1));
    Camera flat = frame_bounds(box(), 1.0f, {});
    flat.orthographic = true;
    flat.half_height = 3;
    flat.far_z = 100;
    OrbitCamera over(flat, box());
    over.zoom(-2);
    const Camera camera = over.camera();
    CHECK(camera.half_height == Approx(3 * 1.21));
    // The whole scene lies between the planes.
    const double depth = -dot(kCenter - column(camera, 3), column(camera, 2)), radius = static_cast<double>(box().radius());
    CHECK(static_cast<double>(camera.near_z) < depth - radius);
    CHECK(static_cast<double>(camera.far_z) > depth + radius);
}

TEST_CASE("orbit camera: its flags place a camera with the same view, far from the origin too", "[viewer]") {
    for (const bool shaped : {false, true}) {
        Camera start = centred();
        if (shaped) start.aspect = 2.0f;
        OrbitCamera orbit(start, box());
        Placement placement{{1e7, -3, 0.1}, 0.25};
        placement.up = shaped ? UpAxis::z : UpAxis::y;
        CHECK(orbit.flags(1.5, placement).empty());
        orbit.turn(40, -20);
        std::istringstream line(orbit.flags(1.5, placement));
        std::vector<std::string> flags;
        for (std::string word; line >> word;) flags.push_back(word);
        const auto options = engine::parse_render_flags(flags);
        REQUIRE(options);
        const auto drawn = [&](Vec3d p) { return to_float(placement.into(p)); };
        const Camera placed = engine::placed_camera(look_at(drawn(options->camera_position.value()), drawn(options->camera_target.value())),
                                                    options->view.fov_y_deg, box());
        const Mat4 a = raster::clip_from_world(placed, 1.5f), b = raster::clip_from_world(orbit.camera(), 1.5f);
        for (int i = 0; i < 4; ++i)
            for (const auto part : {&Vec4f::x, &Vec4f::y, &Vec4f::z, &Vec4f::w}) CHECK(a.c[i].*part == Approx(b.c[i].*part).margin(1e-5));
    }
    Camera flat = frame_bounds(box(), 1.0f, {});
    flat.orthographic = true;
    flat.half_height = 3;
    OrbitCamera over(flat, box());
    over.turn(10, 10);
    CHECK(over.flags(1.0, {}).empty());
}

TEST_CASE("orbit camera: a scene of one point, or none, has a finite camera", "[viewer]") {
    for (const bool none : {false, true}) {
        Bounds bounds;
        if (!none) bounds.add({5, 5, 5});
        OrbitCamera orbit(frame_bounds(bounds, 1.0f, {}), bounds);
        orbit.turn(100, 1000);
        orbit.zoom(300);
        orbit.zoom(-600);
        orbit.pan(1e3, 1e3, 0);
        for (std::size_t i = 0; i < 4; ++i) CHECK(std::isfinite(length(column(orbit.camera(), i))));
    }
}
