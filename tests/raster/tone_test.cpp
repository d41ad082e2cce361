// Tone curves in frames: where they are applied, what does without them, and the same bits however a frame is drawn.
#include "shading/reference/tone.hpp"
#include "halflit/auto_setup.hpp"
#include "halflit/renderer.hpp"
#include "shading/environment.hpp"
#include "shading/model/srgb.hpp"
#include "shading/reference/reference.hpp"
#include "tests/raster/test_scenes.hpp"
#include "tests/sh/sky_images.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/isas.hpp"
#include "tests/support/setup.hpp"

#include "tests/support/catch.hpp"

#include <array>
#include <cstring>

using namespace halflit;
using namespace halflit::test;
namespace reference = halflit::shading::reference;

namespace {

constexpr int kWidth = 120, kHeight = 75;
constexpr ToneCurve kCurves[] = {ToneCurve::reinhard, ToneCurve::aces, ToneCurve::neutral};

/// Materials that all have light: colours without it are the display's.
raster::test::NamedScene lit_materials() {
    raster::test::NamedScene named = raster::test::materials_scene();
    for (Material& material : named.scene.materials) material.unlit = false;
    return named;
}

struct Drawn {
    std::vector<std::uint8_t> codes = std::vector<std::uint8_t>(4 * kWidth * kHeight, 0xa5);
    std::vector<float> linear = std::vector<float>(4 * kWidth * kHeight, -1.0f);
};

Drawn drawn(const Scene& scene, const Camera& camera, const halflit::test::Setup& settings, bool with_linear = true) {
    Drawn d;
    const Target target{kWidth, kHeight, d.codes.data(), with_linear ? d.linear.data() : nullptr};
    const auto report = render(scene, camera, settings, target, settings.execution);
    REQUIRE(report);
    return d;
}

halflit::test::Setup setup_of(ToneCurve curve, int samples) {
    halflit::test::Setup settings;
    settings.tone_curve = curve;
    settings.samples = samples;
    settings.shadow_size = 64;
    settings.background_linear = usual_settings().background_linear;
    settings.exposure = 2.5f;  // much of the scene is brighter than white
    return settings;
}

/// Codes of display light that is a share of light through the curve, and the rest the background's.
std::array<double, 3> codes_of(ToneCurve curve, Vec3d light, double share = 1.0, Vec3d back = {}) {
    const Vec3d shown = reference::toned(curve, light) * share + back * (1.0 - share);
    return {reference::srgb_code(shown.x), reference::srgb_code(shown.y), reference::srgb_code(shown.z)};
}

double largest_difference(const std::array<double, 3>& codes, const std::uint8_t* pixel) {
    double most = 0;
    for (std::size_t c = 0; c < 3; ++c) most = std::max(most, std::fabs(codes[c] - pixel[c]));
    return most;
}

Vec3d light_at(const std::vector<float>& linear, std::size_t i) {
    return {static_cast<double>(linear[i]), static_cast<double>(linear[i + 1]), static_cast<double>(linear[i + 2])};
}

/// A square in the plane z, from (x0, -1) to (x1, 1), that glows in this colour.
void add_square(Scene& scene, float x0, float x1, float z, Vec4f color) {
    Material material;
    material.double_sided = true;
    material.base_color = {0, 0, 0, color.w};
    material.dielectric_reflectance = 0;
    material.emissive = {color.x, color.y, color.z};
    if (color.w < 1.0f) material.alpha_mode = AlphaMode::blend;
    Mesh mesh;
    mesh.positions = {{x0, -1, z}, {x1, -1, z}, {x1, 1, z}, {x0, 1, z}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(material);
    scene.meshes.push_back(mesh);
    scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, {}});
}

}  // namespace

TEST_CASE("tone: a pixel's codes are those of its light through the curve", "[raster][tone]") {
    const raster::test::NamedScene s = lit_materials();
    for (const ToneCurve curve : kCurves) {
        auto settings = setup_of(curve, 1);
        settings.background_linear = {0, 0, 0, 0};
        const Drawn d = drawn(s.scene, s.camera, settings);
        int compared = 0, bright = 0;
        double worst = 0;
        for (std::size_t i = 0; i < d.codes.size(); i += 4) {
            if (!(d.linear[i + 3] > 0.0f)) continue;
            ++compared;
            bright += d.linear[i] > 1.0f;
            worst = std::max(worst, largest_difference(codes_of(curve, light_at(d.linear, i)), &d.codes[i]));
        }
        INFO("curve " << static_cast<int>(curve));
        CHECK(compared > 1000);
        CHECK(bright > 100);
        CHECK(worst <= 0.511);
    }
}

TEST_CASE("tone: linear light is the same bits whatever the curve", "[raster][tone]") {
    for (const raster::test::NamedScene& s : raster::test::all_scenes())
        for (const int samples : {1, 4, 8, 16}) {
            const Drawn none = drawn(s.scene, s.camera, setup_of(ToneCurve::none, samples));
            for (const ToneCurve curve : kCurves) {
                const Drawn with = drawn(s.scene, s.camera, setup_of(curve, samples));
                INFO(s.name << ", " << samples << " samples, curve " << static_cast<int>(curve));
                CHECK(std::memcmp(with.linear.data(), none.linear.data(), none.linear.size() * sizeof(float)) == 0);
                CHECK(with.codes != none.codes);
                CHECK(drawn(s.scene, s.camera, setup_of(curve, samples), false).codes == with.codes);
                for (std::size_t i = 3; i < none.codes.size(); i += 4)
                    if (with.codes[i] != none.codes[i]) FAIL("alpha of pixel " << i / 4);
            }
        }
}

TEST_CASE("tone: the background colour keeps its codes under every curve, beside surfaces and behind nothing", "[raster][tone]") {
    const raster::test::NamedScene s = raster::test::layers_scene();
    for (const int samples : {1, 4, 8, 16})
        for (const ToneCurve curve : kCurves)
            for (const std::array<int, 4> color :
                 {std::array{0x3a, 0x3f, 0x47, 255}, {255, 255, 255, 255}, {255, 0, 1, 255}, {9, 200, 77, 128}}) {
                auto settings = setup_of(curve, samples);
                const auto linear = [&](std::size_t c) { return static_cast<float>(shading::linear_from_srgb(color[c] / 255.0)); };
                settings.background_linear = {linear(0), linear(1), linear(2), static_cast<float>(color[3]) / 255.0f};
                auto transparent = settings;
                transparent.background_linear = {0, 0, 0, 0};
                const Drawn seen = drawn(s.scene, s.camera, transparent), d = drawn(s.scene, s.camera, settings);
                int bare = 0, off = 0;
                for (std::size_t i = 0; i < d.codes.size(); i += 4) {
                    if (seen.linear[i + 3] != 0.0f) continue;
                    ++bare;
                    for (std::size_t c = 0; c < 4; ++c) off += d.codes[i + c] != color[c];
                }
                CHECK(bare > 100);
                CHECK(off == 0);
            }
}

TEST_CASE("tone: the mean of samples is taken of what a display shows", "[raster][tone]") {
    // A light of fifty times white beside a dark grey wall, both in front of the camera and without perspective.
    Scene scene;
    add_square(scene, -2, 0.0037f, 0, {50, 40, 10, 1});
    add_square(scene, 0.0037f, 2, 0, {0.02f, 0.02f, 0.02f, 1});
    Camera camera = camera_at({0, 0, 3}, {0, 0, 0}, 0.5f);
    for (const int samples : {4, 8})
        for (const ToneCurve curve : kCurves) {
            auto settings = setup_of(curve, samples);
            settings.exposure = 1.0f;
            const Drawn d = drawn(scene, camera, settings);
            const Vec3d lamp = reference::toned(curve, {50, 40, 10}), wall = reference::toned(curve, {0.02, 0.02, 0.02});
            int mixed = 0;
            double worst = 0;
            for (std::size_t i = 0; i < d.codes.size(); i += 4) {
                const double share = (static_cast<double>(d.linear[i]) - 0.02) / 49.98;  // of samples that show the light
                mixed += share > 0.01 && share < 0.99;
                const Vec3d shown = lamp * share + wall * (1 - share);
                const std::array<double, 3> want{reference::srgb_code(shown.x), reference::srgb_code(shown.y),
                                                 reference::srgb_code(shown.z)};
                worst = std::max(worst, largest_difference(want, &d.codes[i]));
            }
            CHECK(mixed > 10);
            CHECK(worst <= 0.511);
        }
}

TEST_CASE("tone: light is mapped as it is without alpha, and laid over the background colour", "[raster][tone]") {
    // Two layers of glowing glass, the second over half of the first.
    Scene scene;
    const Vec4f far_layer{6, 3, 1, 0.5f}, near_layer{0.5f, 4, 9, 0.25f};
    add_square(scene, -2, 2, 0, far_layer);
    add_square(scene, 0, 2, 0.5f, near_layer);
    const Camera camera = camera_at({0, 0, 3}, {0, 0, 0}, 0.4f);
    const auto layer = [](Vec4f v) { return Vec3d{double{v.x}, double{v.y}, double{v.z}}; };
    const double both = 0.25 + 0.75 * 0.5;
    const Vec3d one = layer(far_layer), two = (layer(near_layer) * 0.25 + layer(far_layer) * (0.75 * 0.5)) * (1 / both);
    const Vec3d back{0.1, 0.5, 0.9};
    for (const int samples : {1, 4, 8, 16})
        for (const ToneCurve curve : kCurves) {
            auto settings = setup_of(curve, samples);
            settings.exposure = 1.0f;
            const std::size_t left = 4 * (kHeight / 2 * kWidth + 20), right = 4 * (kHeight / 2 * kWidth + 100);
            settings.background_linear = {0, 0, 0, 0};
            const Drawn clear = drawn(scene, camera, settings);
            CHECK(largest_difference(codes_of(curve, one), &clear.codes[left]) <= 0.511);
            CHECK(largest_difference(codes_of(curve, two), &clear.codes[right]) <= 0.511);
            CHECK(clear.codes[left + 3] == 128);
            CHECK(clear.codes[right + 3] == 159);  // 0.625
            settings.background_linear = {0.1f, 0.5f, 0.9f, 1.0f};
            const Drawn over = drawn(scene, camera, settings);
            CHECK(largest_difference(codes_of(curve, one, 0.5, back), &over.codes[left]) <= 0.511);
            CHECK(largest_difference(codes_of(curve, two, both, back), &over.codes[right]) <= 0.511);
            CHECK(over.codes[left + 3] == 255);
        }
}

TEST_CASE("tone: the same bits for every instruction set, tile size, thread count, crop and number of samples", "[raster][tone]") {
    raster::test::NamedScene s = raster::test::layers_scene();
    s.scene.environment = std::make_shared<Environment>(shading::make_environment(random_sky(64, 32, 7).view(), {false, 0.4, true}));
    for (const ToneCurve curve : kCurves)
        for (const int samples : {1, 4, 16})
            for (const int back : {0, 1, 2}) {
                auto settings = setup_of(curve, samples);
                settings.background_environment = back == 1;
                if (back == 2) settings.background_linear = {0, 0, 0, 0};
                settings.execution.isa = Isa::scalar;
                settings.execution.threads = 1;
                const Drawn want = drawn(s.scene, s.camera, settings);
                for (const Isa isa : available_isas())
                    for (const int tile : {16, 64}) {
                        settings.execution.isa = isa;
                        settings.execution.tile_size = tile;
                        settings.execution.threads = tile == 16 ? 3 : 1;
                        settings.region = {};
                        CHECK(drawn(s.scene, s.camera, settings).codes == want.codes);
                        settings.region = {13, 9, 70, 41};
                        const Drawn part = drawn(s.scene, s.camera, settings);
                        for (int y = 9; y < 50; ++y) {
                            const auto first = static_cast<std::size_t>(4 * (y * kWidth + 13));
                            CHECK(std::memcmp(&part.codes[first], &want.codes[first], 70 * 4) == 0);
                        }
                    }
            }
}

TEST_CASE("tone: an environment behind the scene goes through the curve", "[raster][tone]") {
    Scene scene;
    scene.environment = std::make_shared<Environment>(shading::make_environment(random_sky(64, 32, 3).view(), {false, 0.0, true}));
    const Camera camera = camera_at({0, 0, 3}, {0, 0, 0}, 0.9f);
    for (const int samples : {1, 4})
        for (const ToneCurve curve : kCurves) {
            auto settings = setup_of(curve, samples);
            settings.background_environment = true;
            const Drawn d = drawn(scene, camera, settings);
            double worst = 0;
            for (std::size_t i = 0; i < d.codes.size(); i += 4)
                worst = std::max(worst, largest_difference(codes_of(curve, light_at(d.linear, i)), &d.codes[i]));
            CHECK(worst <= 0.511);
        }
}

TEST_CASE("tone: accuracy reference goes through the same curve, in float64", "[raster][tone]") {
    const raster::test::NamedScene s = lit_materials();
    for (const ToneCurve curve : kCurves) {
        auto settings = setup_of(curve, 1);
        settings.shading.accuracy = Accuracy::reference;
        settings.background_linear = {0, 0, 0, 0};
        const Drawn d = drawn(s.scene, s.camera, settings);
        double worst = 0;
        for (std::size_t i = 0; i < d.codes.size(); i += 4)
            if (d.linear[i + 3] > 0.0f) worst = std::max(worst, largest_difference(codes_of(curve, light_at(d.linear, i)), &d.codes[i]));
        CHECK(worst > 0.4);
        CHECK(worst <= 0.505);
    }
}

TEST_CASE("tone: an error budget promises codes after the curve, and keeps the promise", "[raster][tone]") {
    int spent = 0;
    for (const raster::test::NamedScene& s : raster::test::all_scenes())
        for (const ToneCurve curve : {ToneCurve::none, ToneCurve::reinhard, ToneCurve::aces, ToneCurve::neutral})
            for (const double budget : {0.5, 4.0}) {
                auto settings = setup_of(curve, 1);
                settings.background_linear = {0, 0, 0, 0};
                settings.shading.lobe = Lobe::sloan(0.3f);
                const Drawn truth = drawn(s.scene, s.camera, settings);
                settings.shading.max_error_codes = budget;
                Drawn d;
                const auto report = render(s.scene, s.camera, settings, {kWidth, kHeight, nullptr, d.linear.data()});
                REQUIRE(report);
                const ErrorBound& error = report->error;
                INFO(s.name << ", curve " << static_cast<int>(curve) << ", budget " << budget << ", bound " << error.codes);
                CHECK(error.budget == budget);
                CHECK(error.codes <= budget);
                CHECK((error.tone_growth == ErrorGrowth{}) == (curve == ToneCurve::none));
                CHECK(error.codes <=
                      error.rounding + error.lobes + error.specular + error.environment + error.cells + error.left_out + 1e-9);
                double worst = 0;
                for (std::size_t i = 0; i < d.linear.size(); i += 4) {
                    const auto a = codes_of(curve, light_at(truth.linear, i)), b = codes_of(curve, light_at(d.linear, i));
                    for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::fabs(a[c] - b[c]));
                }
                CHECK(worst <= error.codes);
                spent += worst > 0.0;
            }
    CHECK(spent > 8);
}

TEST_CASE("tone: a curve that no name stands for is refused", "[raster][tone]") {
    Settings settings;
    settings.tone_curve = static_cast<ToneCurve>(4);
    CHECK_FALSE(check_settings(settings, 8, 8));
}
