// Environment behind a scene: every pixel is compared with the image where its view ray meets it; the bits do not depend on how it is
// drawn.
#include "halflit/renderer.hpp"
#include "shading/environment.hpp"
#include "tests/raster/test_scenes.hpp"
#include "tests/sh/sky_images.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/isas.hpp"
#include "tests/support/setup.hpp"

#include "tests/support/catch.hpp"

#include <cstring>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::test;

namespace {

constexpr int kWidth = 120, kHeight = 75;

std::shared_ptr<const Environment> kept(const Sky& sky, double rotate_rad) {
    return std::make_shared<Environment>(shading::make_environment(sky.view(), {false, rotate_rad, true}));
}

std::vector<float> drawn(const Scene& scene, const Camera& camera, halflit::test::Setup settings) {
    settings.background_environment = true;
    std::vector<float> rgba(4 * kWidth * kHeight, -1.0f);
    REQUIRE(render(scene, camera, settings, {kWidth, kHeight, nullptr, rgba.data()}, settings.execution));
    return rgba;
}

}  // namespace

TEST_CASE("background: directions and places in the image are each other's inverses", "[raster][background]") {
    for (int y = 0; y < 50; ++y)
        for (int x = 0; x < 50; ++x) {
            const double u = (x + 0.5) / 50, v = (y + 0.5) / 50;
            const sh::EquirectPoint point = sh::equirect_point(sh::equirect_direction(u, v) * (0.1 + x));
            CHECK(point.u == Approx(u).margin(1e-12));
            CHECK(point.v == Approx(v).margin(1e-12));
        }
    for (const double angle : {-3.1, -1.6, -0.8, 0.0, 0.3, 1.5, 2.4})
        CHECK(angle_of(std::sin(angle), std::cos(angle)) == Approx(angle).margin(1e-12));
}

TEST_CASE("background: a pixel shows the image where its view ray meets it, rotated as the light is", "[raster][background]") {
    // The colour is a linear function of the direction. Bilinear look-up between pixels' middles reproduces it, up to an error from their
    // size.
    const Sky sky = painted_sky(512, 256, [](Vec3d d) { return Vec3d{2 + d.x, 2 + d.y, 2 + d.z}; });
    for (const double angle : {0.0, 0.7}) {
        Scene scene;
        scene.environment = kept(sky, angle);
        const Camera camera = camera_at({3, 1, 2}, {0, 2, -1}, 1.2f);
        halflit::test::Setup settings;
        settings.exposure = 0.5f;
        const auto rgba = drawn(scene, camera, settings);
        const sh::Rotation back = sh::inverse(sh::rotation_about_y(angle));
        const double t = std::tan(0.5 * static_cast<double>(camera.fov_y_rad));
        double worst = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const double rx = ((x + 0.5) / kWidth * 2 - 1) * t * kWidth / kHeight, ry = (1 - (y + 0.5) / kHeight * 2) * t;
                const auto& c = camera.world_from_camera.c;
                const auto column = [&](int i) { return Vec3d{c[i].x, c[i].y, c[i].z}; };
                const Vec3d ray = column(0) * rx + column(1) * ry - column(2);
                const Vec3d want = back * (ray * (1.0 / length(ray)));
                const float* p = &rgba[static_cast<std::size_t>(4 * (y * kWidth + x))];
                worst =
                    std::max({worst, std::fabs(2 * p[0] - 2 - want.x), std::fabs(2 * p[1] - 2 - want.y), std::fabs(2 * p[2] - 2 - want.z)});
                CHECK(p[3] == 1.0f);
            }
        CHECK(worst < 1e-4);  // a pixel of the sky is 0.012 wide; linear interpolation errs by an eighth of its square
    }
}

TEST_CASE("background: the same bits for every instruction set, tile size, thread count, crop and number of samples",
          "[raster][background]") {
    raster::test::NamedScene s = raster::test::layers_scene();
    s.scene.environment = kept(random_sky(64, 32, 7), 0.4);
    for (const int samples : {1, 4, 8, 16}) {
        halflit::test::Setup settings;
        settings.samples = samples;
        settings.shadow_size = 64;
        settings.execution.isa = Isa::scalar;
        settings.execution.threads = 1;
        const auto want = drawn(s.scene, s.camera, settings);
        Scene empty;
        empty.environment = s.scene.environment;
        const auto bare = drawn(empty, s.camera, settings);
        int seen = 0;
        for (std::size_t i = 0; i < want.size(); i += 4) seen += std::memcmp(&want[i], &bare[i], 4 * sizeof(float)) == 0;
        CHECK(seen > 100);  // pixels where nothing is drawn
        CHECK(seen < kWidth * kHeight - 100);
        for (const Isa isa : available_isas())
            for (const int tile : {16, 32, 64}) {
                settings.execution.isa = isa;
                settings.execution.tile_size = tile;
                settings.execution.threads = tile == 32 ? 3 : 1;
                settings.region = {};
                CHECK(std::memcmp(drawn(s.scene, s.camera, settings).data(), want.data(), want.size() * sizeof(float)) == 0);
                settings.region = {13, 9, 70, 41};
                const auto part = drawn(s.scene, s.camera, settings);
                for (int y = 9; y < 50; ++y) {
                    const auto first = static_cast<std::size_t>(4 * (y * kWidth + 13));
                    CHECK(std::memcmp(&part[first], &want[first], 70 * 4 * sizeof(float)) == 0);
                }
            }
    }
}
