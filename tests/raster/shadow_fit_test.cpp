// Shadow maps that fit: the shadow of a box against rays, for lights far away and wide floors, and planes that face their light.
#include "sh/vec3d.hpp"
#include "tests/raster/box_shadow.hpp"
#include "tests/raster/shadow_city.hpp"
#include "tests/support/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>

using namespace halflit;
using namespace halflit::test;

TEST_CASE("shadow fit: the shadow of a box has the area that rays give it, near and far from the light, on small and on wide floors",
          "[raster][shadow]") {
    const Vec3d to_light = Vec3d{0.5, 0.7, 0.3} * (1 / std::sqrt(0.83));
    for (const LightType type : {LightType::directional, LightType::point, LightType::spot})
        for (const double floor : {3.0, 50.0, 500.0, 1000.0})
            for (const double distance : {2.0, 20.0, 70.0, 200.0, 1000.0}) {
                if (type == LightType::directional && distance > 2.0) continue;
                INFO("light " << static_cast<int>(type) << ", " << distance << " away, floor of half-width " << floor);
                ShadowSetup setup(Lobe::sloan(0), ShadowMode::hard);
                add_metre_box(setup, {});
                setup.add(make_plane(static_cast<float>(floor), 1));
                Light& light = setup.scene.lights[0];
                light.type = type;
                light.direction_ws = to_float(to_light * -1.0);
                light.position_ws = to_float(to_light * distance);
                light.color_linear = Vec3f{1, 1, 1} * static_cast<float>(distance * distance);
                check_area(shadow_area(setup, {}, {metre_box({})}, to_light, type == LightType::directional ? 0.0 : distance));
            }
}

namespace {

Vec3d random_direction(Random& random) {
    for (;;) {
        const Vec3d v{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
        if (const double size = length(v); size > 0.1 && size < 1) return v * (1 / size);
    }
}

/// Turns make_plane's square towards `normal`.
Mat4 facing(Vec3d center, Vec3d normal) {
    const Vec3d side = std::abs(normal.x) < 0.8 ? Vec3d{1, 0, 0} : Vec3d{0, 0, 1};
    Vec3d x = cross(normal, side);
    x = x * (1 / length(x));
    const auto column = [](Vec3d v, float w) {
        const Vec3f f = to_float(v);
        return Vec4f{f.x, f.y, f.z, w};
    };
    return {{column(x, 0), column(normal, 0), column(cross(x, normal), 0), column(center, 1)}};
}

/// Pixels of a square that its light meets at a random angle, and that are darker with shadows. Small boxes around it make the map wide.
/// Half of the maps are cut to what the camera sees. Half of the scenes lie far from the origin, where positions are coarse.
int darkened_pixels(Random& random, LightType type, bool cube, int size) {
    constexpr int kPixels = 24;
    constexpr double kHalf = 0.6;
    ShadowSetup setup(Lobe::sloan(0.5f), random.chance(0.5) ? ShadowMode::hard : ShadowMode::soft_split);
    setup.settings.shadow_size = size;
    setup.settings.shadow_terminator_offset = random.chance(0.5);  // a map that is not cut; look-ups of planes are not moved
    const Vec3d origin = random.chance(0.5) ? random_direction(random) * 300.0 : Vec3d{};
    const Vec3d to_square = random_direction(random), center = origin + to_square * random.real(1, 3);
    Vec3d normal = to_square * -1.0 + random_direction(random) * random.real(0, 0.99);
    normal = normal * (1 / length(normal));
    setup.add(make_plane(static_cast<float>(kHalf), random.index(3) + 1), facing(center, normal));
    // A light sees boxes on all sides, or only beside and behind the square.
    for (int k = 0; k < 8; ++k) {
        Vec3d at{k & 1 ? 5.0 : -5.0, k & 2 ? 5.0 : -5.0, k & 4 ? 5.0 : -5.0};
        if (type == LightType::directional && dot(at, to_square) < 0) at = at * -1.0;  // not between the light and the square
        setup.add(make_box({0.05f, 0.06f, 0.05f}), translation(to_float(cube ? origin + at : center + to_square * 3.0 + at * 0.2)));
    }
    Light& light = setup.scene.lights[0];
    light.type = type;
    light.position_ws = to_float(origin);
    light.direction_ws = to_float(to_square);
    light.color_linear = {4, 4, 4};
    light.outer_cone_rad = static_cast<float>(random.real(0.5, 1.3));
    setup.camera = camera_at(to_float(center + normal * 0.4), to_float(center));
    setup.camera.orthographic = true;
    setup.camera.half_height = static_cast<float>(kHalf);
    setup.camera.near_z = 0.0f;
    setup.camera.far_z = 0.5f;
    const std::vector<float> with = setup.draw(kPixels, kPixels);
    setup.settings.shadows = ShadowMode::off;
    return differing(with, setup.draw(kPixels, kPixels));
}

void check_lit_planes(int directions) {
    Random random(7);
    for (const int size : {256, 1024, 4096})
        for (int i = 0; i < directions; ++i) {
            INFO("map of " << size << ", plane " << i);
            REQUIRE(darkened_pixels(random, LightType::directional, false, size) == 0);
            REQUIRE(darkened_pixels(random, LightType::directional, true, size) == 0);
            REQUIRE(darkened_pixels(random, LightType::point, false, size) == 0);
            REQUIRE(darkened_pixels(random, LightType::point, true, size) == 0);
            REQUIRE(darkened_pixels(random, LightType::spot, true, size) == 0);
        }
}

}  // namespace

TEST_CASE("shadow fit: a plane that faces its light is not darkened at any angle", "[raster][shadow]") { check_lit_planes(12); }

TEST_CASE("shadow fit: a plane that faces its light is not darkened in any of 1,000 directions", "[raster][shadow][deep]") {
    check_lit_planes(1000);
}

TEST_CASE("shadow fit: without a size of its own a map has three texels for two pixels of what is seen", "[raster][shadow]") {
    for (const LightType type : {LightType::directional, LightType::spot, LightType::point})
        for (const bool orthographic : {false, true})
            for (const int height : {64, 200, 1000}) {
                ShadowSetup setup(Lobe::sloan(0), ShadowMode::hard);
                setup.settings.shadow_size = 0;
                setup.add(make_sphere(1, 24, 12));
                Light& light = setup.scene.lights[0];
                light.type = type;
                light.direction_ws = {0, -1, 0};
                light.position_ws = {0, type == LightType::point ? 0.2f : 10.0f, 0};
                setup.camera = camera_at({0, 0, 20}, {0, 0, 0});
                setup.camera.orthographic = orthographic, setup.camera.half_height = 2, setup.camera.half_width = 4;
                setup.camera.far_z = 40;
                const auto plan_at = [&](Region region) {
                    setup.settings.region = region;
                    const raster::FramePlan plan = plan_of(setup, 2 * height, height);
                    REQUIRE_FALSE(plan.shading.shadow_maps.empty());
                    return plan.shading.shadow_maps.back();
                };
                const shading::ShadowMapPlan map = plan_at({});
                INFO("light " << static_cast<int>(type) << (orthographic ? ", orthographic, " : ", ") << height << ": " << map.size);
                CHECK(map.size % 32 == 0);
                const int side = type == LightType::point ? 2 * map.size : map.size;
                CHECK(side >= 256);
                CHECK(side <= std::min(4 * std::max(height, 64), 2048));
                const double pixel = orthographic ? 4.0 / height : 40 * std::tan(0.5 * double{setup.camera.fov_y_rad}) / height;
                const double texel_px = double{map.texel_size} *
                                        (type == LightType::spot    ? 10
                                         : type == LightType::point ? std::sqrt(3.0)
                                                                    : 1.0) /
                                        pixel;
                if (side > 256 && side < std::min(4 * height, 2048)) {
                    CHECK(texel_px < 0.70);
                    CHECK(texel_px > 0.45);
                }
                CHECK(plan_at({3, 5, 20, 10}).size == map.size);
                setup.settings.shadow_size = 640;
                CHECK(plan_at({}).size == (type == LightType::point ? 320 : 640));
            }
}
