// KHR_materials_diffuse_transmission: light that a thin surface scatters to its far side, against float64 at a pixel, the white furnace,
// shadows of either side, accuracy reference, error budgets, and the same bits in any way to draw.
#include "sh/vec3d.hpp"
#include "tests/raster/panes.hpp"
#include "tests/support/random.hpp"

#include <algorithm>

using namespace halflit;
using namespace halflit::test;

namespace {

Material leaf(float share, Vec3f color) {
    Material material;
    material.metallic = 0;
    material.diffuse_transmission = share, material.diffuse_transmission_color = color;
    return material;
}

Material random_leaf(Random& random) {
    Material material = leaf(random.real32(0, 1), {random.real32(0, 1), random.real32(0, 1), random.real32(0, 1)});
    material.base_color = {random.real32(0, 1), random.real32(0, 1), random.real32(0, 1), 1};
    material.metallic = random.index(2) == 0 ? 0.0f : random.real32(0, 1);
    material.roughness = random.real32(0.3, 1);
    material.dielectric_reflectance = random.real32(0, 0.2);
    material.lobe = Lobe::mcauley(random.index(2) == 0 ? 0.0f : random.real32(0, 1), random.real32(0.5, 3));
    material.double_sided = random.index(2) == 0;
    return material;
}

/// The lobe's value, scale included.
double lobe_at(const Lobe& lobe, double x) {
    const double w = double{lobe.wrap}, n = double{lobe.power};
    return x > -w ? (n + 1) / (2 * (1 + w)) * std::pow((x + w) / (1 + w), n) : 0.0;
}

/// The picture's middle pixel, which shows a pane whose normal is turned by `tilt`.
std::array<double, 4> seen(Scene scene, const Material& material, double tilt, const Settings& settings = {}) {
    add_pane(scene, material, 0, tilt);
    return middle(draw(scene, settings, 9, 9), 9, 9);
}

/// A directional light that arrives from this direction.
Light from(Vec3f to_light, Vec3f color) { return {.color_linear = color, .direction_ws = to_light * -1.0f}; }

int add_texel(Scene& scene, std::array<double, 4> value) {
    std::array<std::uint16_t, 4> texel{};
    for (std::size_t c = 0; c < 4; ++c) texel[c] = static_cast<std::uint16_t>(std::lround(value[c] * 65535));
    scene.textures.push_back(Texture::from_rgba16(texel, 1, 1).value());
    return static_cast<int>(scene.textures.size()) - 1;
}

/// Leaves before one another under lights on both sides.
Scene leaves(Random& random) {
    Scene scene;
    scene.ambient = {{0.5f, 0.6f, 0.7f}, {0.3f, 0.2f, 0.1f}};
    scene.lights.push_back(from({0.3f, 0.4f, -0.8f}, {0.8f, 0.7f, 0.6f}));
    scene.lights.push_back(from({-0.4f, 0.5f, 0.7f}, {0.3f, 0.3f, 0.5f}));
    scene.lights.push_back({.type = LightType::point, .color_linear = {2, 1, 1}, .position_ws = {0.3f, 0.2f, -1.5f}, .range = 6});
    for (int i = 0; i < 6; ++i) {
        const float left = random.real32(-1.5, 0.5);
        Material material = random_leaf(random);
        material.double_sided = true;
        if (i == 2) material.sheen_color = {0.4f, 0.5f, 0.3f}, material.sheen_roughness = 0.5f;
        if (i == 3) material.clearcoat = 0.8f, material.clearcoat_roughness = 0.4f;
        if (i == 4) material.transmission = 0.5f;
        if (i == 5) material.iridescence = 0.5f, material.specular_color = {1, 0.5f, 0.3f};
        add_pane(scene, material, random.real32(-3, 3), random.real(-1, 1), left, left + 0.7f);
    }
    return scene;
}

}  // namespace

TEST_CASE("diffuse transmission: light from behind passes by the lobe, tinted, and is taken from what is reflected",
          "[raster][diffuse-transmission]") {
    Random random(201);
    for (int round = 0; round < 60; ++round) {
        const Material material = random_leaf(random);
        const double tilt = random.real(-1, 1);
        const Vec3d normal{std::sin(tilt), 0, std::cos(tilt)};
        // A light on the far side makes no highlight, so that all is scattered; without highlights it may be on either side.
        Settings settings;
        settings.shadows = ShadowMode::off;
        if (round % 2 == 0) settings.shading.specular = SpecularModel::none;
        Vec3f to_light = normalize_or({random.real32(-1, 1), random.real32(-1, 1), random.real32(-1, 1)}, {0, 0, 1});
        double x = dot(normal, to_double(to_light));
        if (round % 2 == 1 && x > 0) to_light = to_light * -1.0f, x = -x;
        Scene scene;
        scene.lights.push_back(from(to_light, {0.9f, 0.8f, 0.7f}));
        const auto got = seen(scene, material, tilt, settings);
        const double f = double{material.diffuse_transmission},
                     enters = round % 2 == 0 ? 1.0 : (1 - double{material.metallic}) * (1 - double{material.dielectric_reflectance});
        const Vec3f base{material.base_color.x, material.base_color.y, material.base_color.z}, far = material.diffuse_transmission_color;
        const auto want = [&](float base_c, float far_c, double light) {
            return light * enters * ((1 - f) * double{base_c} * lobe_at(material.lobe, x) + f * double{far_c} * lobe_at(material.lobe, -x));
        };
        INFO("round " << round << ", N.L " << x << ", wrap " << material.lobe.wrap << ", power " << material.lobe.power);
        CHECK(got[0] == Approx(want(base.x, far.x, double{0.9f})).epsilon(2e-5).margin(2e-6));
        CHECK(got[1] == Approx(want(base.y, far.y, double{0.8f})).epsilon(2e-5).margin(2e-6));
        CHECK(got[2] == Approx(want(base.z, far.z, double{0.7f})).epsilon(2e-5).margin(2e-6));
        CHECK(got[3] == 1.0);
    }
}

TEST_CASE("diffuse transmission: the far side takes the surroundings behind the surface", "[raster][diffuse-transmission]") {
    Scene scene;
    scene.ambient = {{0.9f, 0.9f, 0.9f}, {0.1f, 0.1f, 0.1f}};
    Settings settings;
    settings.shading.specular = SpecularModel::none;
    Material material = leaf(0.75f, {1, 0.5f, 0});
    material.base_color = {0.4f, 0.4f, 0.4f, 1};
    // The pane is turned about y: both sides see the same height. Its normal turned to the ground sees the sky behind it.
    const auto level = seen(scene, material, 0.3, settings);
    CHECK(level[0] == Approx(0.5 * (0.25 * 0.4 + 0.75)).epsilon(1e-5));
    CHECK(level[1] == Approx(0.5 * (0.25 * 0.4 + 0.75 * 0.5)).epsilon(1e-5));
    Scene tipped = scene;
    add_pane(tipped, material, 0, 0);
    tipped.meshes[0].normals.assign(4, {0, -0.6f, 0.8f});
    const auto down = middle(draw(tipped, settings, 9, 9), 9, 9);
    const double below = 0.1 + 0.8 * (1 - 0.6) / 2, above = 0.1 + 0.8 * (1 + 0.6) / 2;
    CHECK(down[0] == Approx(0.25 * 0.4 * below + 0.75 * above).epsilon(1e-5));
    CHECK(down[2] == Approx(0.25 * 0.4 * below).epsilon(1e-5));
}

TEST_CASE("diffuse transmission: a white surface shows a uniform sky whatever its share is",
          "[raster][diffuse-transmission][environment]") {
    Scene scene;
    const std::vector<float> rgb(std::size_t{3} * 32 * 16, 0.7f);
    scene.environment = make_environment({32, 16, rgb}).value();
    for (const float roughness : {0.2f, 1.0f})
        for (const double tilt : {0.0, 0.8}) {
            Material material = leaf(0, {1, 1, 1});
            material.roughness = roughness;
            const auto want = seen(scene, material, tilt);
            for (const float share : {0.3f, 1.0f}) {
                material.diffuse_transmission = share;
                CHECK(seen(scene, material, tilt)[1] == Approx(want[1]).epsilon(2e-5));
            }
        }
}

TEST_CASE("diffuse transmission: share and colour are multiplied by their textures", "[raster][diffuse-transmission]") {
    Scene scene;
    scene.lights.push_back(from({0.2f, 0.1f, -0.9f}, {1, 1, 1}));
    Settings settings;
    settings.shadows = ShadowMode::off;
    const Material plain = leaf(0.25f, {0.5f, 0.25f, 0.125f});
    Material textured = leaf(0.5f, {1, 0.5f, 0.25f});
    textured.textures[TextureSlot::diffuse_transmission].texture = add_texel(scene, {0.1, 0.2, 0.3, 0.5});
    textured.textures[TextureSlot::diffuse_transmission_color].texture = add_texel(scene, {0.5, 0.5, 0.5, 0.1});
    const auto want = seen(scene, plain, 0.4, settings), got = seen(scene, textured, 0.4, settings);
    CHECK(want[0] > 0.05);
    for (std::size_t c = 0; c < 3; ++c) CHECK(got[c] == Approx(want[c]).epsilon(5e-5));  // texels of 16 bits
}

TEST_CASE("diffuse transmission: without a share, and without light, there is nothing of it", "[raster][diffuse-transmission]") {
    Scene scene;
    scene.lights.push_back(from({0.2f, 0.1f, -0.9f}, {1, 1, 1}));
    scene.ambient = {{0.5f, 0.6f, 0.7f}, {0.3f, 0.2f, 0.1f}};
    const Material none = leaf(0, {1, 1, 1});
    Material tinted = leaf(0, {0.3f, 0.2f, 0.1f});
    tinted.textures[TextureSlot::diffuse_transmission].texture = add_texel(scene, {1, 1, 1, 1});
    CHECK(seen(scene, none, 0.3) == seen(scene, tinted, 0.3));
    tinted.diffuse_transmission = 1, tinted.unlit = true;
    CHECK(seen(scene, tinted, 0.3)[0] == 1.0);
    CHECK(seen({}, leaf(1, {1, 1, 1}), 0.3)[0] == 0.0);
}

TEST_CASE("diffuse transmission: a leaf does not shade its own far side, and what is behind it does",
          "[raster][diffuse-transmission][shadow]") {
    for (const ShadowMode mode : {ShadowMode::hard, ShadowMode::soft_split})
        for (const bool double_sided : {false, true}) {
            Settings settings;
            settings.shadows = mode;
            Scene scene;
            scene.lights.push_back(from({0, 0, -1}, {1, 1, 1}));
            Material material = leaf(1, {0.5f, 0.5f, 0.5f});
            material.double_sided = double_sided;
            const auto blocked = [&](float left) {
                Scene with = scene;
                Material plate;
                plate.double_sided = true;
                add_pane(with, plate, -2, 0, left, left + 3);
                return seen(with, material, 0, settings)[0];
            };
            CHECK(seen(scene, material, 0, settings)[0] == Approx(0.48).epsilon(1e-5));  // F0 is 0.04
            CHECK(blocked(1) == Approx(0.48).epsilon(1e-5));
            CHECK(blocked(-1.5f) == 0.0);
        }
}

TEST_CASE("diffuse transmission: with accuracy reference the picture is that of the kernels, under an environment and sky shadows too",
          "[raster][diffuse-transmission]") {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        Random random(300 + seed);
        Scene scene = leaves(random);
        const bool environment = seed % 2 == 0;
        if (environment) {
            std::vector<float> rgb;
            for (int i = 0; i < 3 * 16 * 8; ++i) rgb.push_back(random.real32(0, 1));
            scene.environment = make_environment({16, 8, rgb}, {.keep_light = true}).value();
        }
        INFO("seed " << seed);
        CHECK(off_reference(scene, 60, 60) < (environment ? 4e-3 : 4e-5));  // an environment's diffuse light is summed in bands
    }
}

TEST_CASE("diffuse transmission: instruction sets, threads, tiles and samples do not show", "[raster][diffuse-transmission]") {
    Random random(310);
    const Scene scene = leaves(random);
    for (const int samples : {1, 4}) {
        Settings settings;
        settings.samples = samples;
        settings.shadow_terminator_offset = samples == 4;
        check_sets_and_tiles(draw(scene, settings, 90, 70), scene, settings, 90, 70);
    }
}

TEST_CASE("diffuse transmission: no random leaves exceed the promised error", "[raster][diffuse-transmission][budget]") {
    int within = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        Random random(320 + seed);
        Scene scene;
        scene.ambient = {{0.2f, 0.3f, 0.3f}, {0.1f, 0.1f, 0.1f}};
        for (int i = 0; i < 12; ++i)
            scene.lights.push_back({.type = LightType::point,
                                    .color_linear = {random.real32(0, 0.5), random.real32(0, 0.5), random.real32(0, 0.5)},
                                    .position_ws = {random.real32(-1, 1), random.real32(-1, 1), random.real32(-2, 2)}});
        std::vector<std::uint16_t> texels;
        for (int i = 0; i < 4 * 16 * 16; ++i) texels.push_back(static_cast<std::uint16_t>(random.integer(20000, 60000)));
        scene.textures.push_back(Texture::from_rgba16(texels, 16, 16).value());
        Material material = random_leaf(random);
        material.lobe.power = std::max(material.lobe.power, 1.0f);
        if (seed % 2 == 0) {
            material.textures[TextureSlot::diffuse_transmission].texture = 0;
            material.textures[TextureSlot::diffuse_transmission_color].texture = 0;
        }
        add_pane(scene, material, 0, random.real(-0.5, 0.5));
        Settings settings;
        settings.shadows = ShadowMode::off;
        const Picture truth = draw(scene, settings, 48, 32);
        settings.shading.max_error_codes = seed % 3 == 0 ? 4.0 : 1.0;
        Picture picture{std::vector<std::uint8_t>(4 * 48 * 32), std::vector<float>(4 * 48 * 32)};
        const auto report = render(scene, camera_flat(), settings, {48, 32, picture.codes.data(), picture.linear.data()});
        REQUIRE(report);
        const auto code = [](float linear) {
            const double x = std::clamp(double{linear}, 0.0, 1.0);
            return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
        };
        double worst = 0;
        for (std::size_t i = 0; i < truth.linear.size(); ++i)
            worst = std::max(worst, std::abs(code(picture.linear[i]) - code(truth.linear[i])));
        INFO("seed " << seed << ", bound " << report->error.codes << ", measured " << worst);
        CHECK(worst <= report->error.codes);
        within += report->error.codes > 0 ? 1 : 0;
    }
    CHECK(within >= 4);
}
