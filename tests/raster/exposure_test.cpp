#include "halflit/scene.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>

using namespace halflit;

namespace {

Bounds unit_ball() {
    Bounds bounds;
    bounds.min = {-2, -2, -1};
    bounds.max = {2, 2, 1};  // half the diagonal: 3
    bounds.empty = false;
    return bounds;
}

Light point_light(Vec3f position, Vec3f color) {
    Light light;
    light.type = LightType::point;
    light.position_ws = position;
    light.color_linear = color;
    return light;
}

}  // namespace

TEST_CASE("exposure: whole steps are exact powers of two, others match exp2", "[raster][exposure]") {
    for (int ev = -64; ev <= 64; ++ev) CHECK(exposure_factor(static_cast<float>(ev)) == std::ldexp(1.0f, ev));
    for (float ev = -12.0f; ev < 12.0f; ev += 0.0371f) {
        INFO("ev " << ev);
        CHECK(static_cast<double>(exposure_factor(ev)) == Approx(std::exp2(static_cast<double>(ev))).epsilon(1.2e-7));  // one float ulp
    }
    CHECK(exposure_factor(1e30f) == std::ldexp(1.0f, 64));
}

TEST_CASE("exposure: a directional light of luminance L is brought to 1", "[raster][exposure]") {
    Scene scene;
    scene.lights.push_back({});
    scene.lights[0].color_linear = {40, 40, 40};
    CHECK(auto_exposure(scene, unit_ball()) == Approx(1.0 / 40).epsilon(1e-6));
    scene.lights.push_back(scene.lights[0]);
    CHECK(auto_exposure(scene, unit_ball()) == Approx(1.0 / 80).epsilon(1e-6));
}

TEST_CASE("exposure: a point light falls off with the square of its distance from the middle, to half the radius", "[raster][exposure]") {
    Scene scene;
    scene.lights = {point_light({0, 10, 0}, {100, 100, 100})};
    CHECK(light_level(scene, unit_ball()).x == Approx(1.0));
    scene.lights = {point_light({0, 0, 0}, {9, 9, 9})};
    CHECK(light_level(scene, unit_ball()).x == Approx(4.0));  // 9 / 1.5^2
}

TEST_CASE("exposure: a light out of range counts for nothing", "[raster][exposure]") {
    Scene scene;
    scene.lights = {point_light({0, 10, 0}, {100, 100, 100})};
    scene.lights[0].range = 6.9f;  // the bounds begin at 7
    CHECK(light_level(scene, unit_ball()).x == 0.0f);
    scene.lights[0].range = 7.1f;
    CHECK(light_level(scene, unit_ball()).x == Approx(1.0));
}

TEST_CASE("exposure: no light, or none that is finite, leaves it at 1", "[raster][exposure]") {
    Scene scene;
    CHECK(auto_exposure(scene, Bounds{}) == 1.0f);
    scene.lights.push_back({});
    for (const float bad : {0.0f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(), -3.0f}) {
        scene.lights[0].color_linear = {bad, bad, bad};
        CHECK(auto_exposure(scene, unit_ball()) == 1.0f);
        CHECK(std::isfinite(soft_ambient(scene, unit_ball()).sky_linear.x));
    }
}

TEST_CASE("exposure: light in another unit gives the same picture", "[raster][exposure]") {
    Scene scene;
    scene.lights = {point_light({1, 4, 2}, {3, 2, 1}), {}};
    Scene brighter = scene;
    for (Light& light : brighter.lights) light.color_linear = light.color_linear * 1024.0f;
    CHECK(auto_exposure(brighter, unit_ball()) == auto_exposure(scene, unit_ball()) / 1024.0f);
    CHECK(soft_ambient(brighter, unit_ball()).sky_linear == soft_ambient(scene, unit_ball()).sky_linear * 1024.0f);
}
