// Alpha for programs that blend codes: what such a blend shows, beside a blend of light.
#include "raster/passes/display_alpha.hpp"
#include "halflit/auto_setup.hpp"
#include "halflit/renderer.hpp"
#include "halflit/scene.hpp"
#include "halflit/shapes.hpp"
#include "shading/model/srgb.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

using namespace halflit;

namespace {

double light_of(int code) { return shading::linear_from_srgb(code / 255.0); }
double code_of(double light) { return 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055); }

/// Largest distance in codes between the blend of codes of the changed pixel and the blend of light of the first one.
double error_over(int background, const std::uint8_t (&pixel)[4]) {
    std::uint8_t changed[4] = {pixel[0], pixel[1], pixel[2], pixel[3]};
    raster::set_display_alpha(changed);
    const double cover = pixel[3] / 255.0, alpha = changed[3] / 255.0;
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
        const double right = code_of(light_of(pixel[c]) * cover + light_of(background) * (1 - cover));
        worst = std::max(worst, std::abs(changed[c] * alpha + background * (1 - alpha) - right));
    }
    return worst;
}

}  // namespace

TEST_CASE("alpha: a shadow laid over any background by its codes darkens it as it darkens light", "[raster][alpha]") {
    for (int cover = 0; cover <= 255; ++cover) {
        const std::uint8_t shadow[4] = {0, 0, 0, static_cast<std::uint8_t>(cover)};
        CAPTURE(cover);
        CHECK(error_over(255, shadow) <= 1.0);
        // Contact shadows have at most 0.85; alpha and what it is laid over are rounded.
        CHECK(error_over(128, shadow) <= (cover <= 217 ? 4.5 : 6.5));
        CHECK(error_over(0, shadow) <= 4.0);
    }
}

TEST_CASE("alpha: any colour is right over white, and no farther off elsewhere than without", "[raster][alpha]") {
    for (int cover = 1; cover < 255; cover += 2)
        for (const int red : {0, 30, 128, 200, 255})
            for (const int blue : {0, 90, 255}) {
                const std::uint8_t pixel[4] = {static_cast<std::uint8_t>(red), 100, static_cast<std::uint8_t>(blue),
                                               static_cast<std::uint8_t>(cover)};
                CAPTURE(cover, red, blue);
                // A colour is rounded to codes, and so is what it adds.
                CHECK(error_over(255, pixel) <= 1.5);
                CHECK(error_over(0, pixel) <= 70.0);
            }
    for (const std::uint8_t cover : {std::uint8_t{0}, std::uint8_t{255}}) {
        std::uint8_t pixel[4] = {10, 20, 30, cover};
        raster::set_display_alpha(pixel);
        CHECK((pixel[0] == 10 && pixel[1] == 20 && pixel[2] == 30 && pixel[3] == cover));
    }
}

TEST_CASE("alpha: codes have it by choice, floats and partly transparent backgrounds never", "[raster][alpha]") {
    Scene scene;
    scene.meshes.push_back(make_sphere_of(1.0f, 2000));
    scene.instances.push_back({0, {}});
    constexpr int kSide = 48;
    AutoSetup setup = auto_setup(scene, kSide, kSide, {});
    static_cast<Lighting&>(scene) = setup.light;
    CHECK(setup.settings.alpha == AlphaSpace::display);
    const auto drawn = [&](Vec4f background, AlphaSpace alpha, bool premultiplied = false) {
        setup.settings.background_linear = background, setup.settings.alpha = alpha;
        Image image;
        image.rgba8.resize(4 * kSide * kSide), image.rgba_linear.resize(4 * kSide * kSide);
        REQUIRE(render(scene, setup.camera, setup.settings,
                       {.width = kSide,
                        .height = kSide,
                        .pixels = image.rgba8.data(),
                        .linear = image.rgba_linear.data(),
                        .premultiplied = premultiplied}));
        return image;
    };
    const Image linear = drawn({}, AlphaSpace::linear), display = drawn({}, AlphaSpace::display);
    CHECK(linear.rgba_linear == display.rgba_linear);
    const Image white = drawn({1, 1, 1, 1}, AlphaSpace::display);
    int between = 0;
    for (std::size_t i = 0; i < linear.rgba8.size(); i += 4) {
        std::uint8_t expected[4] = {linear.rgba8[i], linear.rgba8[i + 1], linear.rgba8[i + 2], linear.rgba8[i + 3]};
        raster::set_display_alpha(expected);
        CHECK(std::equal(expected, expected + 4, &display.rgba8[i]));
        between += expected[3] > 0 && expected[3] < 255 ? 1 : 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double alpha = display.rgba8[i + 3] / 255.0;
            CHECK(std::abs(display.rgba8[i + c] * alpha + 255 * (1 - alpha) - white.rgba8[i + c]) <= 2.5);
        }
    }
    CHECK(between > 50);
    CHECK(drawn({1, 0, 0, 0.5f}, AlphaSpace::linear).rgba8 == drawn({1, 0, 0, 0.5f}, AlphaSpace::display).rgba8);
    const Image premultiplied = drawn({}, AlphaSpace::display, true);
    for (std::size_t i = 0; i < display.rgba8.size(); ++i) {
        const int alpha = display.rgba8[i / 4 * 4 + 3];
        CHECK(int{premultiplied.rgba8[i]} == (i % 4 == 3 ? alpha : (display.rgba8[i] * alpha + 127) / 255));
    }
}
