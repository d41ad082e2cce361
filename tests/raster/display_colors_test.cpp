// Colours of materials without light are those of the display: their codes are the same under every tone curve and exposure, beside lit
// surfaces, behind layers and at edges.
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "tests/raster/test_scenes.hpp"

#include "shading/model/srgb.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <cmath>
#include <vector>

using namespace halflit;

namespace {

constexpr int kSide = 64;
constexpr int kCodes[] = {0, 1, 40, 128, 220, 255};

float linear(int code) { return static_cast<float>(shading::linear_from_srgb(code / 255.0)); }

Mesh card(int material, float x0, float x1, float z) {
    Mesh mesh;
    mesh.positions = {{x0, -1, z}, {x1, -1, z}, {x1, 1, z}, {x0, 1, z}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.material = material;
    return mesh;
}

/// Cards side by side, one for each code, and behind them a lit one.
Scene cards() {
    Scene scene;
    int at = 0;
    const float width = 2.0f / std::size(kCodes);
    for (const int code : kCodes) {
        Material material;
        material.unlit = true;
        material.base_color = {linear(code), linear(code), linear(255 - code), 1};
        scene.materials.push_back(material);
        const float x = -1 + width * static_cast<float>(at);
        scene.meshes.push_back(card(at, x, x + width, 0));
        scene.instances.push_back({at, {}});
        ++at;
    }
    Material lit;
    lit.base_color = {0.5f, 0.2f, 0.1f, 1};
    scene.materials.push_back(lit);
    scene.meshes.push_back(card(at, -1.5f, 1.5f, -1));
    scene.instances.push_back({at, {}});
    Light sun;
    sun.color_linear = {1e4f, 1e4f, 1e4f};
    scene.lights.push_back(sun);
    return scene;
}

Camera front() {
    Camera camera;
    camera.orthographic = true;
    camera.half_width = camera.half_height = 1;
    camera.near_z = 0.1f;
    camera.far_z = 10;
    camera.world_from_camera.c[3] = {0, 0, 3, 1};
    return camera;
}

std::vector<std::uint8_t> draw(const Scene& scene, const Settings& settings) {
    std::vector<std::uint8_t> codes(std::size_t{4} * kSide * kSide);
    REQUIRE(render(scene, front(), settings, {kSide, kSide, codes.data(), nullptr}));
    return codes;
}

std::array<int, 4> pixel(const std::vector<std::uint8_t>& codes, int x, int y) {
    std::array<int, 4> out{};
    const auto first = static_cast<std::size_t>(4 * (y * kSide + x));
    for (std::size_t i = 0; i < 4; ++i) out[i] = codes[first + i];
    return out;
}

}  // namespace

TEST_CASE("display colours: codes of unlit materials are the same under every tone curve, exposure and number of samples", "[raster]") {
    const Scene scene = cards();
    for (const ToneCurve curve : {ToneCurve::none, ToneCurve::reinhard, ToneCurve::aces, ToneCurve::neutral})
        for (const float exposure : {1e-4f, 1.0f, 30.0f})
            for (const int samples : {1, 4, 16}) {
                Settings settings;
                settings.tone_curve = curve;
                settings.exposure = exposure;
                settings.samples = samples;
                settings.background_linear = {0.2f, 0.3f, 0.4f, 1};
                INFO(static_cast<int>(curve) << " " << exposure << " " << samples);
                const auto codes = draw(scene, settings);
                for (std::size_t i = 0; i < std::size(kCodes); ++i) {
                    const int x = static_cast<int>((2 * i + 1) * kSide / (2 * std::size(kCodes)));
                    CHECK(pixel(codes, x, kSide / 2) == std::array<int, 4>{kCodes[i], kCodes[i], 255 - kCodes[i], 255});
                }
            }
}

TEST_CASE("display colours: layers over them, and they as layers, mix what the display shows", "[raster]") {
    Scene scene = cards();
    Material half;
    half.unlit = true;
    half.alpha_mode = AlphaMode::blend;
    half.base_color = {linear(200), linear(100), linear(0), 0.5f};
    scene.materials.push_back(half);
    const int layer = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(card(static_cast<int>(scene.materials.size()) - 1, -1, 1, 0.5f));
    scene.instances.push_back({layer, {}});
    for (const ToneCurve curve : {ToneCurve::none, ToneCurve::neutral})
        for (const int samples : {1, 4}) {
            Settings settings;
            settings.tone_curve = curve;
            settings.exposure = 1e-4f;
            settings.samples = samples;
            const auto codes = draw(scene, settings);
            const auto mixed = [](int over, int under) {
                const double light = 0.5 * static_cast<double>(linear(over)) + 0.5 * static_cast<double>(linear(under));
                const double shown = light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
                return static_cast<int>(std::lround(255.0 * shown));
            };
            for (std::size_t i = 0; i < std::size(kCodes); ++i) {
                const int x = static_cast<int>((2 * i + 1) * kSide / (2 * std::size(kCodes)));
                const auto found = pixel(codes, x, kSide / 2);
                CHECK(std::abs(found[0] - mixed(200, kCodes[i])) <= 1);
                CHECK(std::abs(found[1] - mixed(100, kCodes[i])) <= 1);
                CHECK(std::abs(found[2] - mixed(0, 255 - kCodes[i])) <= 1);
            }
        }
}

TEST_CASE("display colours: behind glass they are tinted, and each region has the bits of the whole", "[raster][blend]") {
    Scene scene = cards();
    Material glass;
    glass.metallic = 0, glass.roughness = 0, glass.transmission = 1;
    glass.base_color = {0.5f, 1, 1, 1};
    scene.materials.push_back(glass);
    scene.meshes.push_back(card(static_cast<int>(scene.materials.size()) - 1, -0.7f, 0.53f, 0.5f));
    scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, {}});
    for (const ToneCurve curve : {ToneCurve::none, ToneCurve::aces, ToneCurve::neutral})
        for (const int samples : {1, 4}) {
            Settings settings;
            settings.tone_curve = curve;
            settings.samples = samples;
            settings.exposure = 1e-6f;  // of the pane's own light nothing is seen
            const auto whole = draw(scene, settings);
            for (const Region region : {Region{0, 0, 64, 7}, Region{11, 3, 1, 50}, Region{20, 20, 17, 5}, Region{33, 0, 31, 64}}) {
                settings.region = region;
                const auto part = draw(scene, settings);
                int apart = 0;
                for (int y = region.y; y < region.y + region.height; ++y)
                    for (int x = region.x; x < region.x + region.width; ++x) apart += pixel(part, x, y) != pixel(whole, x, y) ? 1 : 0;
                INFO(static_cast<int>(curve) << " " << samples << ", region " << region.x);
                CHECK(apart == 0);
            }
            settings.region = {};
            if (curve == ToneCurve::none) continue;
            const int code = pixel(whole, 37, 32)[1];  // in the middle of the pane, over the code 128
            CHECK(std::abs(code - 126) <= 3);
        }
}

TEST_CASE("display colours: the setting emission_scale is a factor on emission alone", "[raster][settings]") {
    Scene scene = cards();
    scene.materials.back().emissive = {1e-3f, 2e-3f, 0};
    scene.instances.erase(scene.instances.begin(), scene.instances.begin() + 3);
    Settings settings;
    settings.shading.emission_scale = 500.0f;
    const auto scaled = draw(scene, settings);
    scene.materials.back().emissive = {0.5f, 1.0f, 0};
    CHECK(scaled == draw(scene, Settings{}));
}
