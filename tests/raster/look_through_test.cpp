// Glass that blurs what lies behind it by its roughness, and bends it by its thickness and index of refraction.
#include "shading/reference/reference.hpp"
#include "tests/raster/panes.hpp"
#include "tests/support/random.hpp"

#include <algorithm>

using namespace halflit;
using namespace halflit::test;

namespace {

Material rough_glass(float roughness, float thickness = 0) {
    Material material = glass(1);
    material.roughness = roughness, material.thickness = thickness;
    return material;
}

/// A channel of the middle row of a picture in which a pane lies before black and white halves that meet at `edge`.
std::vector<double> row_before_edge(const Material& material, double tilt, float edge, int width = 256, int channel = 0) {
    Scene scene;
    add_pane(scene, panel({0, 0, 0, 1}), -5, 0, -20, edge);
    add_pane(scene, panel({1, 1, 1, 1}), -5, 0, edge, 20);
    add_pane(scene, material, 0, tilt, -20, 20);
    Settings settings;
    settings.samples = 1;
    const Picture picture = draw(scene, settings, width, 32);
    std::vector<double> row;
    for (int x = 0; x < width; ++x) row.push_back(double{picture.linear[static_cast<std::size_t>(4 * (16 * width + x) + channel)]});
    return row;
}

/// Where a row first exceeds a share of its last value.
int first_above(const std::vector<double>& row, double share) {
    return static_cast<int>(std::find_if(row.begin(), row.end(), [&](double v) { return v > share * row.back(); }) - row.begin());
}

Scene balls_before_panels(Random& random) {
    Scene scene;
    scene.ambient = {{0.5f, 0.6f, 0.7f}, {0.3f, 0.2f, 0.1f}};
    scene.lights.push_back({.color_linear = {0.4f, 0.5f, 0.6f}, .direction_ws = {-0.3f, -0.4f, -0.8f}});
    for (int i = 0; i < 6; ++i) {
        const float left = random.real32(-1.5, 0.5);
        add_pane(scene, panel({random.real32(0, 1), random.real32(0, 1), random.real32(0, 1), 1}), -5, 0, left, left + 0.4f);
    }
    for (int i = 0; i < 5; ++i) {
        const float left = random.real32(-1.5, 0.5);
        Material material = rough_glass(random.real32(0, 0.8), random.index(2) == 0 ? 0.0f : 1.0f);
        material.dispersion = random.index(2) == 0 ? 0.0f : random.real32(0, 8);
        add_pane(scene, material, random.real32(0, 4), random.real(0, 1), left, left + 0.6f);
    }
    return scene;
}

}  // namespace

TEST_CASE("look through: a blurred and bent plain surface is that surface", "[raster][blend]") {
    Random random(91);
    for (int round = 0; round < 20; ++round) {
        Material material = rough_glass(random.real32(0.1, 1), random.index(2) == 0 ? 0.0f : random.real32(0, 2));
        const double tilt = random.real(0, 1), value = random.real(0, 3);
        const auto red = [&](float behind) {
            Scene scene;
            add_pane(scene, panel({behind, behind, behind, 1}), -5, 0, -3, 3);
            add_pane(scene, material, 0, tilt);
            const auto got = middle(draw(scene, {}, 33, 33), 33, 33);
            CHECK(got[3] == 1.0);
            return got[0];
        };
        const double rough = std::max(0.07, double{material.roughness}),
                     mirrored = 0.04 + (std::max(1 - rough, 0.04) - 0.04) * std::pow(1 - std::cos(tilt), 5);
        CHECK(red(static_cast<float>(value)) == Approx((1 - mirrored) * value).epsilon(2e-6).margin(1e-6));
    }
}

TEST_CASE("look through: an edge is blurred evenly to both sides, the wider the rougher the glass is", "[raster][blend]") {
    int before = 0;
    for (const float roughness : {0.08f, 0.2f, 0.35f, 0.5f}) {
        const std::vector<double> row = row_before_edge(rough_glass(roughness), 0, 0);
        CHECK(std::is_sorted(row.begin(), row.end()));
        for (int x = 96; x < 128; ++x) {
            INFO("roughness " << roughness << ", x " << x);
            CHECK(row[static_cast<std::size_t>(x)] + row[static_cast<std::size_t>(255 - x)] == Approx(row.back()).margin(1e-4));
        }
        const int width = first_above(row, 0.9) - first_above(row, 0.1);
        CHECK(width > before);
        before = width;
    }
    CHECK(before > 16);
}

TEST_CASE("look through: a body bends what is behind it by Snell's law and its thickness", "[raster][blend]") {
    constexpr int kWidth = 512;  // of a picture 32 pixels high: 2 world units are 32 pixels
    Random random(92);
    for (int round = 0; round < 12; ++round) {
        Material material = rough_glass(0, random.real32(0.2, 1.5));
        const double index = random.real(1.2, 2.2), tilt = random.real(-1.2, 1.2), abbe = random.real(0.6, 40);
        material.dielectric_reflectance = static_cast<float>(std::pow((index - 1) / (index + 1), 2));
        if (round % 3 != 0) material.dispersion = static_cast<float>(20 / abbe);
        for (int channel = 0; channel < 3; ++channel) {
            // Abbe's number is (index - 1) / (index of blue - index of red).
            const double own = std::max(1.0, index + (material.dispersion > 0.0f ? (channel - 1) * 0.5 * (index - 1) / abbe : 0.0));
            // The ray goes along -z; the normal is turned about y, and so is the ray within the body, towards the normal's other side.
            const double inside = std::asin(std::sin(std::abs(tilt)) / own), turned = std::abs(tilt) - inside;
            const double shift = (tilt > 0 ? -1 : 1) * double{material.thickness} * std::sin(turned);
            const std::vector<double> row = row_before_edge(material, tilt, 0, kWidth, channel);
            INFO("tilt " << tilt << ", index " << own << ", thickness " << material.thickness);
            // A pixel whose ray leaves at the edge shows it.
            CHECK(std::abs(first_above(row, 0.5) - (kWidth / 2 - 16 * shift)) <= 1.0);
        }
    }
}

TEST_CASE("look through: a body disperses light only where it has a thickness", "[raster][blend]") {
    const auto picture = [](float roughness, float thickness, float dispersion) {
        Scene scene;
        scene.ambient = {{0.8f, 0.7f, 0.6f}, {0.2f, 0.2f, 0.2f}};
        Material material = rough_glass(roughness, thickness);
        material.dispersion = dispersion;
        add_pane(scene, panel({0, 0, 0, 1}), -5, 0, -20, 0);
        add_pane(scene, panel({1, 1, 1, 1}), -5, 0, 0, 20);
        add_pane(scene, material, 0, 0.7);
        return draw(scene, {}, 32, 32);
    };
    CHECK(picture(0.4f, 0, 3) == picture(0.4f, 0, 0));
    CHECK_FALSE(picture(0.4f, 1, 3) == picture(0.4f, 1, 0));
}

TEST_CASE("look through: where there is no surface, rough glass shows the surroundings and clear glass the background", "[raster][blend]") {
    Scene scene;
    scene.ambient = {{0.8f, 0.7f, 0.6f}, {0.2f, 0.2f, 0.2f}};
    Settings settings;
    settings.background_linear = {0.5f, 0, 0, 1};
    const auto through = [&](const Material& material) {
        Scene with = scene;
        add_pane(with, material, 0, 0);
        return middle(draw(with, settings, 17, 17), 17, 17);
    };
    const double around = 0.5 * (0.8 + 0.2), mirrored = 0.04 * around;
    CHECK(through(rough_glass(0))[0] == Approx(0.96 * 0.5 + mirrored).epsilon(1e-5));
    CHECK(through(rough_glass(0.6f))[0] == Approx(0.96 * around + mirrored).epsilon(1e-5));
    CHECK(through(rough_glass(0, 1))[0] == Approx(0.96 * around + mirrored).epsilon(1e-5));
    settings.background_linear = {0, 0, 0, 0};
    CHECK(through(rough_glass(0.6f))[3] == 1.0);
}

TEST_CASE("look through: colours of the display stay under every exposure, up to the tone curve", "[raster][blend][tone]") {
    for (const float exposure : {0.25f, 4.0f}) {
        Scene scene;
        Material material = rough_glass(0.4f);
        material.dielectric_reflectance = 0.04f;
        add_pane(scene, panel({0.5f, 0.5f, 0.5f, 1}), -5, 0, -3, 3);
        add_pane(scene, material, 0, 0);
        Settings settings;
        settings.exposure = exposure;
        CHECK(middle(draw(scene, settings, 17, 17), 17, 17)[0] == Approx(0.5 * 0.96).epsilon(1e-5));
    }
}

TEST_CASE("look through: instruction sets, threads, tiles, samples and regions do not show", "[raster][blend]") {
    Random random(93);
    const Scene scene = balls_before_panels(random);
    constexpr int kWidth = 150, kHeight = 110;
    for (const int samples : {1, 4}) {
        Settings settings;
        settings.samples = samples;
        settings.tone_curve = ToneCurve::neutral;
        settings.background_linear = {0.1f, 0.3f, 0.6f, 0.7f};
        const Picture first = draw(scene, settings, kWidth, kHeight);
        check_sets_and_tiles(first, scene, settings, kWidth, kHeight);
        for (const Region region : {Region{0, 0, 20, 30}, Region{70, 50, 1, 1}, Region{33, 7, 90, 64}}) {
            settings.region = region;
            const Picture part = draw(scene, settings, kWidth, kHeight);
            bool same = true;
            for (int y = region.y; y < region.y + region.height; ++y)
                for (int i = 4 * (y * kWidth + region.x); i < 4 * (y * kWidth + region.x + region.width); ++i) {
                    const auto at = static_cast<std::size_t>(i);
                    same &= part.codes[at] == first.codes[at] && part.linear[at] == first.linear[at];
                }
            CHECK(same);
            settings.region = {};
        }
    }
}

TEST_CASE("look through: with accuracy reference the picture is that of the kernels, under an environment too", "[raster][blend]") {
    Random random(94);
    Scene scene = balls_before_panels(random);
    std::vector<float> rgb;
    for (int i = 0; i < 3 * 16 * 8; ++i) rgb.push_back(random.real32(0, 1));
    for (const bool environment : {false, true}) {
        if (environment) scene.environment = make_environment({16, 8, rgb}, {.keep_light = true}).value();
        for (Material& material : scene.materials)
            if (!material.unlit) material.roughness = std::max(material.roughness, 0.3f);
        const double worst = off_reference(scene, 60, 60);
        INFO((environment ? "environment" : "two colours"));
        CHECK(worst < (environment ? 2e-3 : 1e-5));  // an environment's diffuse light is summed in bands
    }
}

TEST_CASE("look through: a frame that was stopped leaves nothing behind, nor does one with glass", "[raster][blend][execution]") {
    Random random(95);
    const Scene scene = balls_before_panels(random);
    const auto prepared = PreparedScene::make(scene).value();
    Scene plain = scene;
    plain.materials.resize(6), plain.meshes.resize(6), plain.instances.resize(6);
    const auto prepared_plain = PreparedScene::make(plain).value();
    constexpr int kSide = 100;
    Settings settings;
    settings.region = {30, 40, 20, 10};
    const auto region_of = [&](Renderer& renderer, const PreparedScene& drawn, const Execution& execution) {
        std::vector<std::uint8_t> codes(std::size_t{4} * 20 * 10 + 64, 77);
        Target target{kSide, kSide, codes.data()};
        target.region_alone = true;
        const auto report = renderer.render(drawn, camera_flat(), settings, target, execution);
        for (std::size_t i = 800; i < codes.size(); ++i) CHECK(codes[i] == 77);  // behind the region's memory
        return report ? codes : std::vector<std::uint8_t>();
    };
    Renderer fresh, used;
    const auto truth = region_of(fresh, prepared, {}), truth_plain = region_of(fresh, prepared_plain, {});
    REQUIRE(!truth.empty());
    for (int after = 0; after < 12; ++after) {
        int asked = 0;
        Execution stopped;
        stopped.tile_size = 16, stopped.threads = 1;
        stopped.cancelled = [&] { return asked++ >= after; };
        region_of(used, prepared, stopped);
        Execution whole;
        whole.tile_size = 16;
        CHECK(region_of(used, prepared, whole) == truth);
        CHECK(region_of(used, prepared_plain, whole) == truth_plain);
    }
    Execution small;
    small.memory_limit = 1'000;
    CHECK(region_of(used, prepared, small).empty());
    CHECK(region_of(used, prepared, {}) == truth);
}

TEST_CASE("look through: an error budget is kept behind glass and in front of it", "[raster][blend][budget]") {
    Scene scene;
    scene.ambient = {{0.3f, 0.2f, 0.2f}, {0.1f, 0.1f, 0.1f}};
    Material wall;
    wall.lobe = Lobe::mcauley(0.4f, 2.3f);
    wall.roughness = 0.4f;
    add_pane(scene, wall, -1, 0);
    Material glass = rough_glass(0.5f);
    glass.lobe = Lobe::mcauley(0.7f, 1.7f);
    add_pane(scene, glass, 0, 0);
    for (int i = 0; i < 20; ++i) {
        const auto at = static_cast<float>(i) / 20.0f;
        scene.lights.push_back(
            {.type = LightType::point, .color_linear = {0.1f, 0.1f, 0.05f}, .position_ws = {at - 0.5f, 0.5f - at, 0.5f + at}});
    }
    Settings settings;
    settings.shadows = ShadowMode::off;
    const Picture exact = draw(scene, settings, 48, 32);
    for (const double budget : {0.5, 2.0, 8.0}) {
        settings.shading.max_error_codes = budget;
        Picture picture = exact;
        const auto report = render(scene, camera_flat(), settings, {48, 32, picture.codes.data(), picture.linear.data()});
        REQUIRE(report);
        double worst = 0;
        for (std::size_t i = 0; i < exact.linear.size(); ++i)
            worst = std::max(worst, std::abs(shading::reference::srgb_code(double{picture.linear[i]}) -
                                             shading::reference::srgb_code(double{exact.linear[i]})));
        INFO("budget " << budget << ", bound " << report->error.codes << ", measured " << worst);
        CHECK(report->error.codes <= budget);
        CHECK(report->error.codes > 0);
        CHECK(worst <= report->error.codes);
        CHECK(worst > 0);
    }
}
