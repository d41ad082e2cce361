// Light that passes through surfaces: KHR_materials_transmission and the absorption of KHR_materials_volume, against float64 at each pixel.
#include "tests/raster/panes.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>

using namespace halflit;
using namespace halflit::test;

namespace {

/// A pane in float64 under a uniform ambient light: what it adds, and what it keeps of the light behind, a channel at a time.
struct PaneModel {
    std::array<double, 3> light, keep;
};
PaneModel model_of(const Material& m, double tilt, double ambient) {
    const auto schlick = [&](double f0) {
        const double rough = std::max(0.07, double{m.roughness});
        return f0 + (std::max(1 - rough, f0) - f0) * std::pow(1 - std::cos(tilt), 5);
    };
    const double k = double{m.dielectric_reflectance}, metallic = double{m.metallic}, t = double{m.transmission};
    const double a = m.alpha_mode == AlphaMode::blend ? double{m.base_color.w} : 1.0;
    const double colors[] = {double{m.base_color.x}, double{m.base_color.y}, double{m.base_color.z}};
    const double inside[] = {double{m.attenuation_color.x}, double{m.attenuation_color.y}, double{m.attenuation_color.z}};
    PaneModel out{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double passed = m.attenuation_distance > 0 ? std::pow(inside[c], double{m.thickness} / double{m.attenuation_distance}) : 1.0;
        const double matt = colors[c] * (1 - metallic) * (1 - k) * (1 - t), f0 = k * (1 - metallic) + metallic * colors[c];
        out.light[c] = a * ambient * (matt + schlick(f0));
        out.keep[c] = 1 - a + a * t * (1 - schlick(k)) * (1 - metallic) * colors[c] * passed;
    }
    return out;
}

Material random_glass(Random& random) {
    Material material = glass(random.real32(0.1, 1));
    material.base_color = {random.real32(0.2, 1), random.real32(0.2, 1), random.real32(0.2, 1), random.real32(0.3, 1)};
    material.metallic = random.index(2) == 0 ? 0.0f : random.real32(0, 0.5);
    material.roughness = random.real32(0, 1);
    material.dielectric_reflectance = random.real32(0, 0.3);
    material.alpha_mode = random.index(2) == 0 ? AlphaMode::opaque : AlphaMode::blend;
    material.double_sided = random.index(2) == 0;
    if (random.index(2) == 0) {
        material.thickness = random.real32(0, 2);
        material.attenuation_distance = random.real32(0.3, 3);
        material.attenuation_color = {random.real32(0, 1), random.real32(0.2, 1), 1};
    }
    return material;
}

/// The same, but light passes straight: it is neither blurred nor bent.
Material clear(Material material) {
    material.roughness = 0;
    if (material.thickness > 0.0f) material.dielectric_reflectance = 0;
    return material;
}

/// Panes and panels at random depths, mixed with layers that do not transmit.
Scene random_panes(Random& random, int count) {
    Scene scene;
    scene.ambient = {{0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}};
    add_pane(scene, panel({0.9f, 0.5f, 0.3f, 1}), -5, 0);
    for (int i = 0; i < count; ++i) {
        Material material = random_glass(random);
        if (random.index(4) == 0) material.transmission = 0, material.alpha_mode = AlphaMode::blend;
        const float left = random.real32(-1.5, 0.5);
        add_pane(scene, material, random.real32(-4, 4), random.real(0, 1.2), left, left + random.real32(0.5, 2));
    }
    return scene;
}

}  // namespace

TEST_CASE("transmission: layers of glass keep, tint and absorb what lies behind as float64 does, sorted by depth", "[raster][blend]") {
    Random random(31);
    double worst = 0;
    for (int round = 0; round < 60; ++round) {
        Scene scene;
        scene.ambient = {{0.7f, 0.7f, 0.7f}, {0.7f, 0.7f, 0.7f}};
        struct Pane {
            float z;
            double tilt;
            Material material;
        };
        std::vector<Pane> panes;
        const Vec4f behind{random.real32(0, 2), random.real32(0, 2), random.real32(0, 2), 1};
        for (int i = 0; i < 6; ++i) panes.push_back({random.real32(-4, 4), random.real(0, 1.4), clear(random_glass(random))});
        add_pane(scene, panel(behind), -5, 0);
        for (const Pane& pane : panes) add_pane(scene, pane.material, pane.z, pane.tilt);
        std::sort(panes.begin(), panes.end(), [](const Pane& a, const Pane& b) { return a.z < b.z; });
        double want[3] = {double{behind.x}, double{behind.y}, double{behind.z}};
        for (const Pane& pane : panes) {
            const PaneModel m = model_of(pane.material, pane.tilt, 0.7f);
            for (std::size_t c = 0; c < 3; ++c) want[c] = m.light[c] + m.keep[c] * want[c];
        }
        Settings settings;
        settings.samples = round % 2 == 0 ? 1 : 4;
        const auto got = middle(draw(scene, settings, 9, 9), 9, 9);
        for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(got[c] - want[c]));
        CHECK(got[3] == Approx(1.0));
    }
    CHECK(worst < 2e-6);
}

TEST_CASE("transmission: with accuracy reference the picture is that of the kernels within 1e-5", "[raster][blend]") {
    Random random(32);
    Scene scene = random_panes(random, 30);
    scene.lights.push_back({.color_linear = {0.4f, 0.5f, 0.6f}, .direction_ws = {-0.3f, -0.4f, -0.8f}});
    for (Material& material : scene.materials) material.roughness = std::max(material.roughness, 0.3f);
    const double worst = off_reference(scene, 60, 60);
    CHECK(worst < 1e-5);
    CHECK(worst > 0);
}

TEST_CASE("transmission: instruction sets, threads, tiles, regions and the order of submission do not show", "[raster][blend]") {
    Random random(33);
    Scene scene = random_panes(random, 40);
    scene.lights.push_back({.color_linear = {0.4f, 0.5f, 0.6f}, .direction_ws = {-0.3f, -0.4f, -0.8f}});
    constexpr int kWidth = 150, kHeight = 110;
    for (const ToneCurve curve : {ToneCurve::none, ToneCurve::aces}) {
        Settings settings;
        settings.samples = 4;
        settings.tone_curve = curve;
        settings.background_linear = {0.1f, 0.3f, 0.6f, 0.7f};
        const Picture first = draw(scene, settings, kWidth, kHeight);
        check_sets_and_tiles(first, scene, settings, kWidth, kHeight);
        for (std::size_t i = scene.instances.size() - 1; i > 0; --i)
            std::swap(scene.instances[i], scene.instances[static_cast<std::size_t>(random.index(static_cast<int>(i) + 1))]);
        CHECK(draw(scene, settings, kWidth, kHeight) == first);
    }
}

TEST_CASE("transmission: more layers at a pixel than its memory holds", "[raster][blend]") {
    constexpr int kLayers = 70'000;
    Material material = glass(1);
    material.dielectric_reflectance = 0, material.base_color = {0.99999f, 0.99998f, 1, 1};
    Scene scene;
    add_pane(scene, panel({1, 1, 1, 1}), -9, 0);
    add_pane(scene, material, 0, 0);
    Mesh& mesh = scene.meshes[1];
    mesh = {};
    mesh.material = 1;
    for (int i = 0; i < kLayers; ++i) {
        const float z = -8.0f + static_cast<float>(i) * 1e-4f;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Vec3f corner : {Vec3f{-4, -4, z}, Vec3f{12, -4, z}, Vec3f{-4, 12, z}}) {
            mesh.positions.push_back(corner);
            mesh.normals.push_back({0, 0, 1});
        }
        for (std::uint32_t k = 0; k < 3; ++k) mesh.indices.push_back(first + k);
    }
    Settings settings;
    settings.shading.specular = SpecularModel::none;
    const auto got = middle(draw(scene, settings, 2, 2), 2, 2);
    CHECK(got[0] == Approx(std::pow(double{0.99999f}, kLayers)).margin(1e-3));
    CHECK(got[1] == Approx(std::pow(double{0.99998f}, kLayers)).margin(1e-3));
    CHECK(got[2] == 1.0);
}

TEST_CASE("transmission: glass casts no shadow", "[raster][blend][shadow]") {
    const auto floor_behind = [](float share) {
        Scene scene;
        scene.lights.push_back({.direction_ws = {0, 0, -1}});
        Material matt;
        matt.metallic = 0;
        add_pane(scene, matt, -2, 0);
        add_pane(scene, glass(share), 0, 0, -2, -0.5f);
        Settings settings;
        settings.shadows = ShadowMode::hard;
        settings.shading.specular = SpecularModel::none;
        const auto picture = draw(scene, settings, 32, 32);
        return double{picture.linear[static_cast<std::size_t>(4 * (16 * 32 + 1))]};
    };
    CHECK(floor_behind(1) == Approx(1.0));      // lit floor, seen through clear glass
    CHECK(floor_behind(0.5f) == Approx(1.0));   // half the floor, half the glass's own diffuse light
    CHECK(floor_behind(0.01f) == Approx(1.0));  // nearly nothing passes, and the glass itself is lit
}

TEST_CASE("transmission: a mask cuts holes into glass", "[raster][blend]") {
    // Alpha of the vertices: 0 to the left, 1 to the right.
    Scene scene;
    Material material = glass(1);
    material.alpha_mode = AlphaMode::mask;
    material.base_color = {0.5f, 0.5f, 0.5f, 1};
    material.dielectric_reflectance = 0;
    add_pane(scene, panel({1, 1, 1, 1}), -5, 0);
    add_pane(scene, material, 0, 0);
    scene.meshes[1].colors = {{1, 1, 1, 0}, {1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 0}};
    Settings settings;
    settings.shading.specular = SpecularModel::none;
    const Picture picture = draw(scene, settings, 32, 32);
    for (int x = 0; x < 32; ++x) {
        const float red = picture.linear[static_cast<std::size_t>(4 * (16 * 32 + x))];
        CHECK(red == (x < 16 ? 1.0f : 0.5f));
    }
}

TEST_CASE("transmission: thickness follows its texture by Beer's law, once in a body that shows both sides", "[raster][blend]") {
    Scene scene;
    std::vector<std::uint16_t> texels;
    for (int i = 0; i < 4; ++i) texels.insert(texels.end(), {0, static_cast<std::uint16_t>(65535 * i / 3), 0, 65535});
    scene.textures.push_back(Texture::from_rgba16(texels, 4, 1).value());
    Material material = glass(1);
    material.thickness = 3, material.attenuation_distance = 1.5f;
    material.attenuation_color = {0.8f, 0.3f, 0};
    material.textures[TextureSlot::thickness].texture = 0;
    material.textures[TextureSlot::thickness].sampler = {
        .mag = TextureFilter::nearest, .min = TextureFilter::nearest, .mip = MipFilter::none};
    material.double_sided = true;
    add_pane(scene, panel({1, 1, 1, 1}), -5, 0);
    add_pane(scene, material, 0, 0, -1, 1);
    add_pane(scene, material, -1, 0, -1, 1);
    std::swap(scene.meshes[2].indices[1], scene.meshes[2].indices[2]);  // a back face
    std::swap(scene.meshes[2].indices[4], scene.meshes[2].indices[5]);
    Settings settings;
    settings.shading.specular = SpecularModel::none;
    const Picture picture = draw(scene, settings, 64, 8);
    for (int x = 0; x < 64; ++x) {
        const int column = std::clamp((x - 28) / 2, 0, 3);
        if (x < 28 || x >= 36) continue;
        const float* at = &picture.linear[static_cast<std::size_t>(4 * (4 * 64 + x))];
        const double ways = 2.0 * column / 3;
        INFO("x " << x);
        CHECK(double{at[0]} == Approx(std::pow(0.8, ways)).epsilon(1e-5));
        CHECK(double{at[1]} == Approx(std::pow(0.3, ways)).epsilon(1e-5));
        CHECK(double{at[2]} == Approx(column == 0 ? 1.0 : 0.0).margin(1e-6));
    }
}

TEST_CASE("transmission: clear glass leaves the background's codes under every tone curve, and coloured glass tints them",
          "[raster][blend][tone]") {
    for (const ToneCurve curve : {ToneCurve::none, ToneCurve::reinhard, ToneCurve::aces, ToneCurve::neutral}) {
        Settings settings;
        settings.tone_curve = curve;
        settings.samples = 4;
        settings.background_linear = {0.2f, 0.5f, 0.8f, 1};
        settings.shading.specular = SpecularModel::none;
        for (const Vec4f color : {Vec4f{1, 1, 1, 1}, Vec4f{0.25f, 0.5f, 1, 1}}) {
            Scene scene;
            Material material = glass(1);
            material.base_color = color;
            add_pane(scene, material, 0, 0);
            const Picture glazed = draw(scene, settings, 16, 16);
            Settings tinted = settings;
            tinted.background_linear = {0.2f * color.x, 0.5f * color.y, 0.8f * color.z, 1};
            const Picture empty = draw({}, tinted, 16, 16);
            INFO("curve " << static_cast<int>(curve));
            int apart = 0;
            for (std::size_t i = 0; i < glazed.codes.size(); ++i) apart = std::max(apart, std::abs(glazed.codes[i] - empty.codes[i]));
            CHECK(apart == 0);
        }
    }
}

TEST_CASE("transmission: over a transparent background alpha is what glass lacks, and at least its highlight", "[raster][blend]") {
    Scene scene;
    scene.ambient = {{0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}};
    Material material = clear(glass(1));
    material.base_color = {0.9f, 0.6f, 0.3f, 1};
    add_pane(scene, material, 0, 0);
    Settings settings;
    settings.background_linear = {0, 0, 0, 0};
    const PaneModel m = model_of(material, 0, 0.5);
    const auto dim = middle(draw(scene, settings, 9, 9), 9, 9);
    const double alpha = 1 - (m.keep[0] + m.keep[1] + m.keep[2]) / 3;
    CHECK(dim[3] == Approx(alpha).epsilon(1e-5));
    CHECK(dim[0] * dim[3] == Approx(m.light[0]).epsilon(1e-5));
    scene.ambient = {{20, 20, 20}, {20, 20, 20}};
    const auto bright = middle(draw(scene, settings, 9, 9), 9, 9);
    CHECK(bright[3] == Approx(20 * 0.04).epsilon(1e-5));
    CHECK(bright[0] == Approx(1.0).epsilon(1e-5));
}

TEST_CASE("transmission: a change of the share alone is drawn", "[raster][blend]") {
    Scene scene;
    Material material = glass(0);
    material.alpha_mode = AlphaMode::blend;
    add_pane(scene, panel({1, 1, 1, 1}), -5, 0);
    add_pane(scene, material, 0, 0);
    Settings settings;
    settings.shading.specular = SpecularModel::none;
    auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    Renderer renderer;
    std::vector<std::uint8_t> codes(4 * 8 * 8);
    REQUIRE(renderer.render(*prepared, camera_flat(), settings, {8, 8, codes.data()}));
    CHECK(codes[0] == 0);
    scene.materials[1].transmission = 1;
    REQUIRE(prepared->update({.materials = true}));
    REQUIRE(renderer.render(*prepared, camera_flat(), settings, {8, 8, codes.data()}));
    CHECK(codes[0] == 255);
}

TEST_CASE("transmission: a warning of rough glass behind rough glass names panes that lie over one another alone", "[raster][blend]") {
    const auto warnings = [](float left, float right) {
        Scene scene;
        Material rough = glass(0.8f);
        rough.roughness = 0.5f;
        add_pane(scene, rough, -1.0f, 0.0, -0.5f, 0.0f);
        add_pane(scene, rough, -1.5f, 0.0, left, right);
        std::vector<std::uint8_t> codes(std::size_t{4} * 32 * 32);
        const auto report = render(scene, camera_flat(), {}, {32, 32, codes.data()});
        REQUIRE(report);
        return report->warnings;
    };
    CHECK(warnings(0.2f, 0.6f).empty());
    const auto found = warnings(-0.2f, 0.6f);
    REQUIRE(found.size() == 1);
    CHECK(found[0] == "2 objects are of rough or thick glass: one is not seen through another");
}
