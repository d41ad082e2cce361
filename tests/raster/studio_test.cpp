// The built-in studio: how bright it is, where its light comes from, and that it turns with the camera.
#include "halflit/auto_setup.hpp"
#include "halflit/renderer.hpp"
#include "halflit/scene.hpp"
#include "halflit/shapes.hpp"
#include "raster/built_in/studio_light.hpp"
#include "sh/equirect.hpp"
#include "shading/environment.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

using namespace halflit;

namespace {

/// Light that a white Lambert surface of this normal reflects, by a sum over the image's pixels.
double reflected(const EnvironmentImage& image, Vec3d normal) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double cosine = dot(sh::equirect_direction((x + 0.5) / image.width, (y + 0.5) / image.height), normal);
            const auto* const rgb = &image.rgb[static_cast<std::size_t>(3 * (y * image.width + x))];
            if (cosine > 0)
                sum += cosine * sh::luminance({double{rgb[0]}, double{rgb[1]}, double{rgb[2]}}) *
                       sh::pixel_solid_angle(image.width, image.height, y);
        }
    return sum / kPi;
}

Camera seen_from(Vec3f eye) {
    Camera camera;
    camera.world_from_camera = look_at(eye, {0, 0, 0});
    return camera;
}

/// A white sphere in the studio, from a place; 40 x 40 linear pixels.
std::vector<float> sphere_seen_from(Vec3f eye) {
    Scene scene;
    scene.meshes.push_back(make_sphere_of(1.0f, 4000));
    scene.meshes[0].material = 0;
    scene.instances.push_back({0, {}});
    scene.materials.resize(1);
    scene.materials[0].metallic = 0;
    const Camera camera = seen_from(eye);
    add_studio(scene, camera);
    std::vector<float> linear(4 * 40 * 40);
    REQUIRE(render(scene, camera, {}, {.width = 40, .height = 40, .linear = linear.data()}));
    return linear;
}

}  // namespace

TEST_CASE("studio: its light has the bits that the code computes, whether or not the build made them", "[raster][studio]") {
    shading::ImageLightParts made = raster::studio_parts();
    const shading::ImageLightParts computed = raster::computed_studio_parts();
    CHECK(made.width == computed.width);
    CHECK(made.rgb == computed.rgb);
    CHECK(made.radiance.bands == computed.radiance.bands);
    CHECK(made.radiance.c == computed.radiance.c);
    CHECK(made.reflections.rgba == computed.reflections.rgba);
    CHECK(std::equal(std::begin(made.reflections.first), std::end(made.reflections.first), std::begin(computed.reflections.first)));
    REQUIRE(made.lobes.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) CHECK(made.lobes[i].errors->relative[4] == computed.lobes[i].errors->relative[4]);
    // Bounds of other lobes are computed from the image.
    const EnvironmentImage image = studio_image();
    const shading::ImageLight of_image(image.width, image.height, image.rgb, sh::Projection(shading::view_of(image)));
    const shading::ImageLight of_parts(std::move(made));
    for (const sh::WrapLobe lobe : {sh::WrapLobe{0.0, 1.0, 1.0}, {1.0, 1.0, 1.0}, {1.0, 2.0, 1.0}, {0.4, 1.7, 0.9}}) {
        CHECK(of_parts.order_bounds(lobe).by_order == of_image.order_bounds(lobe).by_order);
        CHECK(of_parts.band_errors(lobe).least == of_image.band_errors(lobe).least);
        CHECK(of_parts.band_errors(lobe).relative[2] == of_image.band_errors(lobe).relative[2]);
        CHECK(of_parts.irradiance(lobe)->rgba == of_image.irradiance(lobe)->rgba);
    }
}

TEST_CASE("studio: a share of it is its light times that share", "[raster][studio]") {
    const auto whole = studio_environment(seen_from({1, 2, 5})), half = studio_environment(seen_from({1, 2, 5}), 0, 0.5f);
    for (std::size_t i = 0; i < whole->radiance.c.size(); ++i) CHECK(half->radiance.c[i] == whole->radiance.c[i] * 0.5);
    CHECK(half->light->image().rgb[100] == 0.5f * whole->light->image().rgb[100]);
    const sh::WrapLobe lambert{0.0, 1.0, 1.0}, other{0.4, 1.7, 0.9};
    for (const sh::WrapLobe& lobe : {lambert, other})
        for (std::size_t i = 0; i < 10; ++i) {
            const double of_half = half->light->order_bounds(lobe).by_order[i].x, of_whole = whole->light->order_bounds(lobe).by_order[i].x;
            CHECK(of_half == Approx(0.5 * of_whole).epsilon(1e-6));
        }
    const auto map = half->light->reflections(shading::in_turn), full = whole->light->reflections(shading::in_turn);
    for (std::size_t i = 0; i < map->rgba.size(); i += 97) CHECK(map->rgba[i][1] == 0.5f * full->rgba[i][1]);
}

TEST_CASE("studio: white surfaces reflect what its header says, brightest upwards and darkest downwards", "[raster][studio]") {
    const EnvironmentImage image = studio_image();
    CHECK(image.calibrated);
    REQUIRE(image.rgb.size() == static_cast<std::size_t>(3 * image.width * image.height));
    CHECK(reflected(image, {0, 1, 0}) == Approx(0.7).margin(0.05));
    CHECK(reflected(image, {0, -1, 0}) == Approx(0.5).margin(0.05));
    double least = 1e9, most = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x) {
            const double light = reflected(image, sh::equirect_direction((x + 0.5) / 32, (y + 0.5) / 16));
            least = std::min(least, light), most = std::max(most, light);
        }
    CHECK(least > 0.35);  // nothing is lost in black
    CHECK(most < 0.8);    // the key light is as strong
    // More light comes from the viewer's left than from the right, and a mirror sees soft boxes well above the walls.
    CHECK(reflected(image, {-0.6, 0.6, 0.52}) > reflected(image, {0.6, 0.6, 0.52}));
    CHECK(*std::max_element(image.rgb.begin(), image.rgb.end()) > 1.5f);
}

TEST_CASE("studio: a sphere looks the same from every side", "[raster][studio]") {
    const std::vector<float> front = sphere_seen_from({0, 1, 4});
    CHECK(front[4 * (20 * 40 + 20)] > 0.2f);
    for (const double azimuth : {0.7, 2.0, 3.14159, 4.5}) {
        const std::vector<float> other =
            sphere_seen_from({static_cast<float>(4 * std::sin(azimuth)), 1, static_cast<float>(4 * std::cos(azimuth))});
        double worst = 0;
        for (int y = 12; y < 28; ++y)
            for (int x = 12; x < 28; ++x)
                for (int c = 0; c < 3; ++c) {
                    const auto i = static_cast<std::size_t>(4 * (y * 40 + x) + c);
                    worst = std::max(worst, std::abs(double{front[i]} - double{other[i]}));
                }
        CHECK(worst < 0.02);  // the facets of the sphere, and the bands left out
    }
}

TEST_CASE("studio: faces of a grey box differ by 28 codes and more, however it is turned", "[raster][studio]") {
    Scene scene;
    scene.meshes.push_back(make_box({1, 1, 1}));
    scene.meshes[0].material = 0;
    scene.instances.push_back({0, {}});
    scene.materials.resize(1);
    scene.materials[0].metallic = 0;
    scene.materials[0].base_color = {0.5f, 0.5f, 0.5f, 1};
    constexpr int kSide = 64;
    for (int azimuth = 0; azimuth < 90; azimuth += 15) {
        ViewSettings view;
        view.azimuth_deg = static_cast<float>(azimuth), view.elevation_deg = 20;
        AutoSetup setup = auto_setup(scene, kSide, kSide, {.frame = true, .view = view});
        setup.settings.samples = 1;
        std::vector<std::uint8_t> pixels(4 * kSide * kSide);
        std::vector<float> normal(3 * kSide * kSide);
        scene.lights = setup.light.lights, scene.environment = setup.light.environment;
        REQUIRE(render(scene, setup.camera, setup.settings,
                       {.width = kSide, .height = kSide, .pixels = pixels.data(), .normal = normal.data()}));
        scene.lights.clear(), scene.environment = nullptr;
        // The mean code of each face that is more than a line.
        double sum[6] = {}, count[6] = {};
        for (std::size_t i = 0; i < kSide * kSide; ++i)
            for (std::size_t face = 0; face < 6; ++face)
                if (normal[3 * i + face / 2] * (face % 2 == 0 ? 1.0f : -1.0f) > 0.9f) sum[face] += pixels[4 * i + 1], count[face] += 1;
        std::vector<double> codes;
        for (std::size_t face = 0; face < 6; ++face)
            if (count[face] > 60) codes.push_back(sum[face] / count[face]);
        CAPTURE(azimuth, codes);
        CHECK(codes.size() >= 2);
        std::sort(codes.begin(), codes.end());
        for (std::size_t i = 1; i < codes.size(); ++i) CHECK(codes[i] - codes[i - 1] >= 28);
        CHECK(codes.front() > 100);
    }
}

TEST_CASE("studio: a mirror shows light and dark, a third of white in the median", "[raster][studio]") {
    const EnvironmentImage image = studio_image();
    // Directions that a ball mirrors to a viewer on +z, at equal areas of its disc.
    std::vector<double> light;
    for (double y = -0.95; y < 1; y += 0.05)
        for (double x = -0.95; x < 1; x += 0.05) {
            if (x * x + y * y > 0.95) continue;
            const Vec3d normal{x, y, std::sqrt(1 - x * x - y * y)};
            const sh::EquirectPoint at = sh::equirect_point(normal * (2 * normal.z) - Vec3d{0, 0, 1});
            const auto row = std::min(static_cast<int>(at.v * image.height), image.height - 1);
            const auto column = std::min(static_cast<int>(at.u * image.width), image.width - 1);
            light.push_back(image.rgb[static_cast<std::size_t>(3 * (row * image.width + column) + 1)]);
        }
    std::sort(light.begin(), light.end());
    const auto part = [&](double share) { return light[static_cast<std::size_t>(share * static_cast<double>(light.size()))]; };
    CHECK(part(0.5) > 0.35);
    CHECK(part(0.1) < 0.25);
    CHECK(part(0.95) > 1.0);
}

TEST_CASE("studio: cameras that look straight down or up have it upright in their picture", "[raster][studio]") {
    // The picture's left edge shows what faces left: the side of the main soft box.
    for (const float height : {4.0f, -4.0f}) {
        const std::vector<float> linear = sphere_seen_from({0, height, 0});
        const auto at = [&](int x, int y) { return double{linear[static_cast<std::size_t>(4 * (y * 40 + x) + 1)]}; };
        CHECK(at(12, 20) > at(28, 20));
    }
}
