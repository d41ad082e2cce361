// Promised errors of environment light, suns included, and its light where a normal is zero.
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "shading/environment.hpp"
#include "shading/reference/reference.hpp"
#include "tests/support/cameras.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace halflit;
using namespace halflit::raster;

namespace {

constexpr int kWidth = 64, kHeight = 64;

struct Picture {
    std::vector<float> linear = std::vector<float>(std::size_t{4} * kWidth * kHeight);
    RenderReport report;
};

Picture draw(const Scene& scene, Settings settings, Accuracy accuracy, double codes = 0.0) {
    Picture picture;
    settings.shading.accuracy = accuracy;
    settings.shading.max_error_codes = codes;
    const auto report = render(scene, halflit::test::camera_flat(1.1f), settings, {kWidth, kHeight, nullptr, picture.linear.data()});
    REQUIRE(report);
    picture.report = *report;
    return picture;
}

struct Difference {
    double linear = 0, codes = 0;
};
Difference largest_difference(const Picture& a, const Picture& b) {
    Difference most;
    for (std::size_t i = 0; i < a.linear.size(); ++i) {
        const double x = static_cast<double>(a.linear[i]), y = static_cast<double>(b.linear[i]);
        if (!std::isfinite(x - y)) return {HUGE_VAL, HUGE_VAL};
        most.linear = std::max(most.linear, std::fabs(x - y));
        most.codes = std::max(most.codes, std::fabs(shading::reference::srgb_code(x) - shading::reference::srgb_code(y)));
    }
    return most;
}

/// Light of one level all around, and a round sun of the given radius in it, reddish on one side.
std::vector<float> sky(int width, float level, float sun, double radius_rad) {
    const int height = width / 2;
    const Vec3d middle = sh::equirect_direction(0.61, 0.27);
    std::vector<float> rgb;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Vec3d at = sh::equirect_direction((x + 0.5) / width, (y + 0.5) / height);
            const bool lit = dot(at, middle) > std::cos(radius_rad);
            const float l = level + (lit ? sun : 0.0f);
            rgb.insert(rgb.end(), {l, l, lit && at.x > middle.x ? 0.7f * l : l});
        }
    return rgb;
}

Scene lit_ball(const std::vector<float>& rgb, int width, bool suns, const Lobe& lobe) {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].lobe = lobe;
    scene.meshes = {make_sphere(1, 96, 64)};
    scene.meshes[0].material = 0;
    scene.instances = {{0, {}}};
    EnvironmentOptions options;
    options.extract_suns = suns;
    options.keep_light = true;
    scene.environment = *make_environment({width, width / 2, rgb}, options);
    return scene;
}

Settings plain() {
    Settings settings;
    settings.shadows = ShadowMode::off;
    settings.shading.specular = SpecularModel::none;
    return settings;
}

}  // namespace

TEST_CASE("environment budget: a sun drawn as a directional light keeps to the bound, which counts its size",
          "[raster][budget][environment][slow]") {
    struct Case {
        Lobe lobe;
        double radius;
        bool shadows;
    };
    for (const auto& [lobe, radius, shadows] : {Case{Lobe::lambert(), 0.06, false},
                                                {Lobe::mcauley(0.5f, 4.0f), 0.06, false},
                                                {Lobe::valve(), 0.02, false},
                                                {Lobe::sloan(0.5f), 0.06, true}}) {
        constexpr int kColumns = 256;
        const std::vector<float> rgb = sky(kColumns, 0.1f, static_cast<float>(0.5 / (radius * radius)), radius);
        const Scene scene = lit_ball(rgb, kColumns, true, lobe), whole = lit_ball(rgb, kColumns, false, lobe);
        REQUIRE(scene.all_lights().size() == 1);
        Settings settings = plain();
        Picture truth = draw(scene, settings, Accuracy::reference);
        // The sun as a part of the image, which is summed in patches of 0.7 degrees.
        const double apart = largest_difference(draw(whole, settings, Accuracy::reference), truth).linear;
        if (shadows) {
            settings.shadows = ShadowMode::soft_split, settings.shadow_size = 256;
            truth = draw(scene, settings, Accuracy::reference);
        }
        const Picture exact = draw(scene, settings, Accuracy::exact), bounded = draw(scene, settings, Accuracy::exact, 1.0);
        REQUIRE(exact.report.environment.size() == 1);
        const EnvironmentUse& use = exact.report.environment[0];
        const ErrorBound& bound = bounded.report.error;
        const double error = largest_difference(exact, truth).linear, codes = largest_difference(bounded, exact).codes;
        INFO("w " << lobe.wrap << ", n " << lobe.power << ", radius " << radius << ": off by " << error << ", bound " << use.bound
                  << "; codes " << codes << ", bound " << bound.codes << "; references apart " << apart);
        CHECK(apart <= 2e-3);
        CHECK(error <= use.bound);
        CHECK(error >= 0.05 * use.bound);
        CHECK(use.within == (use.bound <= settings.shading.environment_tolerance));
        CHECK(codes <= bound.codes);
        CHECK(bound.codes <= 1.0);
    }
}

TEST_CASE("environment: a zero normal gets the light that N.L = 0 gives for every direction", "[raster][environment]") {
    const std::vector<float> rgb = sky(32, 0.3f, 0.0f, 0.0);
    for (const Lobe lobe : {Lobe::lambert(), Lobe::half_lambert(), Lobe::sloan(0.3f)})
        for (const SpecularModel specular : {SpecularModel::none, SpecularModel::blinn}) {
            Scene scene = lit_ball(rgb, 32, true, lobe);
            scene.meshes[0].normals.assign(scene.meshes[0].normals.size(), {0, 0, 0});
            Settings settings = plain();
            settings.shading.specular = specular;
            const Picture exact = draw(scene, settings, Accuracy::exact), truth = draw(scene, settings, Accuracy::reference);
            const auto middle = static_cast<double>(exact.linear[4 * (kHeight / 2 * kWidth + kWidth / 2)]);
            // (1/pi) times the integral of L f(0) over 4 pi.
            if (specular == SpecularModel::none) CHECK(std::fabs(middle - 4 * 0.3 * shading::reference::lobe_value(lobe, 0)) < 1e-5);
            CHECK(largest_difference(exact, truth).linear < 1e-4);
        }
}

TEST_CASE("reference: texture coordinates that are NaN read as 0, infinite ones as the limit", "[raster][reference]") {
    std::vector<std::uint8_t> rgba;
    for (int i = 0; i < 64; ++i)
        rgba.insert(rgba.end(), {static_cast<std::uint8_t>(100 + i), static_cast<std::uint8_t>(150 - i), 240, 255});
    for (const float odd : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e30f}) {
        Scene scene;
        scene.textures.push_back(*Texture::from_rgba8(rgba, 8, 8, ColorSpace::linear));
        scene.materials.resize(1);
        scene.materials[0].textures[TextureSlot::normal].texture = 0;
        scene.materials[0].textures[TextureSlot::base_color].texture = 0;
        scene.meshes = {make_sphere(1, 24, 16)};
        scene.meshes[0].material = 0;
        generate_tangents(scene.meshes[0], 0);
        for (Vec2f& uv : scene.meshes[0].uv0) uv = {odd, odd};
        scene.instances = {{0, {}}};
        scene.lights.resize(1);
        scene.lights[0].direction_ws = {-1, -1, -2};
        const Picture exact = draw(scene, plain(), Accuracy::exact), truth = draw(scene, plain(), Accuracy::reference);
        INFO("coordinate " << odd);
        CHECK(*std::max_element(exact.linear.begin(), exact.linear.end()) > 0.1f);
        CHECK(largest_difference(exact, truth).linear < 1e-4);
    }
}
