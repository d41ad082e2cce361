// Environments as a host makes them: what is refused, their level, their suns, and a scene that they light.
#include "halflit/environment.hpp"
#include "halflit/renderer.hpp"
#include "halflit/scene.hpp"
#include "halflit/shapes.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>

using namespace halflit;

namespace {

constexpr double kPi = 3.14159265358979323846;

EnvironmentImage constant(int width, int height, Vec3f radiance) {
    EnvironmentImage image{width, height, {}, false};
    for (int i = 0; i < width * height; ++i)
        for (const float channel : {radiance.x, radiance.y, radiance.z}) image.rgb.push_back(channel);
    return image;
}

/// A dim sky with one bright pixel.
EnvironmentImage with_sun(int x, int y) {
    EnvironmentImage image = constant(64, 32, {0.1f, 0.1f, 0.1f});
    for (std::size_t c = 0; c < 3; ++c) image.rgb[3 * static_cast<std::size_t>(y * 64 + x) + c] = 5000;
    return image;
}

/// Directions to the middle of a pixel, as the header defines the image: the middle column along -z, three quarters along +x.
Vec3d direction_of(int x, int y, int width, int height) {
    const double turn = 2 * kPi * ((x + 0.5) / width - 0.5), polar = kPi * (y + 0.5) / height;
    return {std::sin(turn) * std::sin(polar), std::cos(polar), -std::cos(turn) * std::sin(polar)};
}

}  // namespace

TEST_CASE("environment: images that are no images are refused", "[raster][environment]") {
    const auto refused = [](const EnvironmentImage& image) {
        const auto made = make_environment(image);
        if (made) return false;
        CHECK(made.error().code == ErrorCode::bad_input);
        CHECK(!made.error().message.empty());
        CHECK(made.error().message.find('\n') == std::string::npos);
        return true;
    };
    CHECK(refused({}));
    CHECK(refused({0, 4, {}, false}));
    CHECK(refused({-4, -2, std::vector<float>(24, 1.0f), false}));
    CHECK(refused({8, 4, std::vector<float>(3 * 32 - 1, 1.0f), false}));
    CHECK(refused({8, 4, std::vector<float>(3 * 32 + 3, 1.0f), false}));
    CHECK(refused({std::numeric_limits<int>::max(), std::numeric_limits<int>::max(), {}, false}));
    using limits = std::numeric_limits<float>;
    for (const float bad : {-1.0f, -1e-30f, -limits::denorm_min(), limits::quiet_NaN(), limits::infinity(), -limits::infinity()})
        for (const std::size_t at : {0, 50, 95}) {
            EnvironmentImage image = constant(8, 4, {1, 1, 1});
            image.rgb[at] = bad;
            CHECK(refused(image));
        }
    CHECK(make_environment(constant(1, 1, {1, 1, 1})));
    CHECK(make_environment(constant(3, 7, {0, -0.0f, 0})));
}

TEST_CASE("environment: a rotation that is no angle is refused", "[raster][environment]") {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        const auto made = make_environment(constant(8, 4, {1, 1, 1}), {.rotate_rad = bad});
        REQUIRE(!made);
        CHECK(made.error().code == ErrorCode::usage);
    }
}

TEST_CASE("environment: the level of a constant image is that constant's luminance", "[raster][environment]") {
    for (const auto& [width, height] : {std::pair{1, 1}, {8, 4}, {16, 16}, {64, 3}, {512, 256}})
        for (const bool suns : {true, false}) {
            const auto white = make_environment(constant(width, height, {2.5f, 2.5f, 2.5f}), {.extract_suns = suns, .rotate_rad = 1.2});
            REQUIRE(white);
            CHECK(environment_level(**white) == Approx(2.5).epsilon(1e-9));
            CHECK(environment_suns(**white).empty());
            const auto coloured = make_environment(constant(width, height, {1, 2, 4}), {.extract_suns = suns});
            CHECK(environment_level(**coloured) == Approx(0.2126 + 2 * 0.7152 + 4 * 0.0722).epsilon(1e-3));
        }
}

TEST_CASE("environment: the level is the mean over the sphere, with the suns or without", "[raster][environment]") {
    for (const auto& [x, y] : {std::pair{40, 8}, {3, 15}, {63, 20}}) {
        const EnvironmentImage image = with_sun(x, y);
        // Area of the pixel on the sphere, over 4 pi.
        const double share = (std::cos(kPi * y / 32) - std::cos(kPi * (y + 1) / 32)) / (2 * 64);
        const double mean = 0.1 + (5000 - 0.1) * share;
        const auto split = make_environment(image), whole = make_environment(image, {.extract_suns = false});
        REQUIRE(split);
        REQUIRE(whole);
        CHECK(environment_suns(**whole).empty());
        REQUIRE(environment_suns(**split).size() == 1);
        CHECK(environment_level(**whole) == Approx(mean).epsilon(1e-6));
        CHECK(environment_level(**split) == Approx(mean).epsilon(1e-6));
    }
}

TEST_CASE("environment: a sun is where the image has it, turned as the image is", "[raster][environment]") {
    for (const auto& [x, y] : {std::pair{40, 8}, {3, 15}, {63, 20}})
        for (const double turn : {0.0, 0.5 * kPi, -2.0}) {
            const auto made = make_environment(with_sun(x, y), {.rotate_rad = turn});
            REQUIRE(made);
            REQUIRE(environment_suns(**made).size() == 1);
            const Light& sun = environment_suns(**made)[0];
            const Vec3d d = direction_of(x, y, 64, 32);
            // Counter-clockwise seen from above, about +y: z goes to x.
            const Vec3d wanted{d.x * std::cos(turn) + d.z * std::sin(turn), d.y, -d.x * std::sin(turn) + d.z * std::cos(turn)};
            const Vec3d towards{-double{sun.direction_ws.x}, -double{sun.direction_ws.y}, -double{sun.direction_ws.z}};
            CHECK(sun.type == LightType::directional);
            CHECK(length(towards) == Approx(1.0).epsilon(1e-6));
            CHECK(length(towards - wanted) < 0.02);  // within the pixel, which is 0.1 wide
        }
}

TEST_CASE("environment: its suns shine behind the lights, unless they are switched off", "[raster][environment]") {
    Lighting light;
    light.lights.resize(2);
    const std::shared_ptr<const Environment> sky = make_environment(with_sun(40, 8)).value();
    light.environment = sky;
    light.sun_shadow_radius_rad = 0.01f;
    std::vector<Light> all = light.all_lights();
    REQUIRE(all.size() == 3);
    CHECK(all[2].shadow_radius == 0.01f);
    all[2].shadow_radius = 0;
    CHECK(all[2] == environment_suns(*sky)[0]);
    light.suns = false;
    CHECK(light.all_lights() == light.lights);
    CHECK(Lighting{}.all_lights().empty());
}

TEST_CASE("environment: light that is given is drawn in the place of the scene's own", "[raster][environment]") {
    Scene scene;
    scene.meshes.push_back(make_sphere(1, 16, 8));
    scene.instances.push_back({0, {}});
    scene.lights.resize(1);
    Lighting other;
    other.environment = make_environment(with_sun(40, 8)).value();
    Scene lit = scene;
    static_cast<Lighting&>(lit) = other;
    const auto draw = [&](const Scene& drawn, const Lighting& light) {
        std::vector<float> linear(std::size_t{4} * 32 * 32);
        Camera camera;
        camera.world_from_camera.c[3] = {0, 0, 4, 1};
        REQUIRE(render(drawn, light, camera, {}, {.width = 32, .height = 32, .linear = linear.data()}));
        return linear;
    };
    CHECK(draw(scene, other) == draw(lit, lit));
    CHECK(draw(scene, scene) != draw(lit, lit));
    // A renderer draws one prepared scene by any light in turn.
    const auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    Renderer renderer;
    for (int i = 0; i < 2; ++i)
        for (const Lighting& light : {static_cast<const Lighting&>(scene), static_cast<const Lighting&>(other)}) {
            std::vector<float> linear(std::size_t{4} * 32 * 32);
            Camera camera;
            camera.world_from_camera.c[3] = {0, 0, 4, 1};
            REQUIRE(renderer.render(*prepared, light, camera, {}, {.width = 32, .height = 32, .linear = linear.data()}));
            CHECK(linear == draw(scene, light));
        }
}

TEST_CASE("environment: it outlives the image and the pointer that a scene was given", "[raster][environment]") {
    Scene scene;
    {
        EnvironmentImage image = constant(16, 8, {0.25f, 0.5f, 0.75f});
        scene.environment = make_environment(image, {.keep_image = true}).value();
        image.rgb.assign(image.rgb.size(), 9.0f);
    }
    Settings settings;
    settings.background_environment = true;
    std::vector<float> linear(4 * 6);
    REQUIRE(render(scene, Camera{}, settings, {.width = 3, .height = 2, .linear = linear.data()}));
    for (std::size_t i = 0; i < linear.size(); i += 4) {
        CHECK(double{linear[i]} == Approx(0.25).epsilon(1e-5));
        CHECK(double{linear[i + 2]} == Approx(0.75).epsilon(1e-5));
        CHECK(linear[i + 3] == 1.0f);
    }
}
