// The soft shadow below a model that stands, against the share of the sky that rays find hidden, and where there is none.
#include "halflit/renderer.hpp"
#include "halflit/scene.hpp"
#include "halflit/shapes.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/isas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

using namespace halflit;

namespace {

constexpr int kWidth = 120, kHeight = 90;
constexpr Vec3f kEye{2.6f, 2.2f, 3.4f}, kTarget{0, 0.4f, 0};

struct Block {
    Vec3f middle, half;
};

Scene blocks(const std::vector<Block>& all) {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].metallic = 0;
    scene.ambient = {{0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}};
    for (const Block& block : all) {
        scene.instances.push_back({static_cast<std::int32_t>(scene.meshes.size()), translation(block.middle)});
        scene.meshes.push_back(make_box(block.half));
        scene.meshes.back().material = 0;
    }
    return scene;
}

Scene cube() { return blocks({{{0, 0.5f, 0}, {0.5f, 0.5f, 0.5f}}}); }

Camera looking(Vec3f eye, Vec3f target = kTarget) {
    Camera camera;
    camera.world_from_camera = look_at(eye, target);
    return camera;
}

Settings shadowed(float opacity = 1.0f) {
    Settings settings;
    settings.contact_shadow = opacity;
    return settings;
}

std::vector<float> drawn(const Scene& scene, const Camera& camera, const Settings& settings) {
    std::vector<float> linear(static_cast<std::size_t>(4 * kWidth * kHeight));
    REQUIRE(render(scene, camera, settings, {.width = kWidth, .height = kHeight, .linear = linear.data()}));
    return linear;
}

bool has_shadow(const Scene& scene, const Camera& camera, const Settings& settings) {
    Settings without = settings;
    without.contact_shadow = 0;
    return drawn(scene, camera, settings) != drawn(scene, camera, without);
}

/// The point of the ground that a pixel of looking(kEye) shows.
Vec3d ground_at(int x, int y) {
    const Camera camera = looking(kEye);
    const auto column = [&](int k) {
        const Vec4f c = camera.world_from_camera.c[k];
        return Vec3d{c.x, c.y, c.z};
    };
    const double half = std::tan(0.5 * double{camera.fov_y_rad});
    const double sx = (2 * (x + 0.5) / kWidth - 1) * half * kWidth / kHeight, sy = (1 - 2 * (y + 0.5) / kHeight) * half;
    const Vec3d d = column(0) * sx + column(1) * sy - column(2), eye = to_double(kEye);
    return eye + d * (-eye.y / d.y);
}

/// Share of an even sky that boxes hide from a point of the ground, by rays.
double hidden_share(const std::vector<Block>& all, Vec3d from) {
    constexpr int kRings = 24, kWays = 96;
    int hidden = 0;
    for (int ring = 0; ring < kRings; ++ring)
        for (int way = 0; way < kWays; ++way) {
            const double radius = std::sqrt((ring + 0.5) / kRings);  // equal areas of the disc are equal light
            const SinCos turn = sin_cos(2 * kPi * (way + 0.5) / kWays);
            const double v[3] = {radius * turn.cos, std::sqrt(1 - radius * radius), radius * turn.sin}, o[3] = {from.x, 0, from.z};
            hidden += std::any_of(all.begin(), all.end(), [&](const Block& block) {
                const double middle[3] = {block.middle.x, block.middle.y, block.middle.z};
                const double half[3] = {block.half.x, block.half.y, block.half.z};
                double enter = 0, leave = 1e300;
                for (int k = 0; k < 3; ++k) {
                    const double a = (middle[k] - half[k] - o[k]) / v[k], b = (middle[k] + half[k] - o[k]) / v[k];
                    enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
                }
                return enter < leave;
            });
        }
    return static_cast<double>(hidden) / (kRings * kWays);
}

}  // namespace

TEST_CASE("contact shadow: the share of the sky that the model hides from the ground", "[raster][contact-shadow]") {
    const std::vector<Block> table{{{0, 0.9f, 0}, {0.8f, 0.05f, 0.6f}},
                                   {{-0.7f, 0.425f, -0.5f}, {0.06f, 0.425f, 0.06f}},
                                   {{0.7f, 0.425f, -0.5f}, {0.06f, 0.425f, 0.06f}},
                                   {{-0.7f, 0.425f, 0.5f}, {0.06f, 0.425f, 0.06f}},
                                   {{0.7f, 0.425f, 0.5f}, {0.06f, 0.425f, 0.06f}}};
    for (const std::vector<Block>& all : {std::vector<Block>{{{0, 0.5f, 0}, {0.5f, 0.5f, 0.5f}}}, table}) {
        const std::vector<float> picture = drawn(blocks(all), looking(kEye), shadowed());
        double error = 0, over = 0, sum = 0;
        int pixels = 0, near = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const float* const p = &picture[static_cast<std::size_t>(4 * (y * kWidth + x))];
                const Vec3d at = ground_at(x, y);
                if (p[0] != 0.0f || at.y > 1e-9 || length(at) > 2.5) continue;  // the model, above the horizon, or far from it
                const double expected = hidden_share(all, at), more = double{p[3]} - expected;
                over = std::max(over, more);
                ++pixels;
                const Vec3f& half = all[0].half;  // the shadow fades with the distance
                if (std::abs(at.x) > double{half.x} + 0.1 || std::abs(at.z) > double{half.z} + 0.1) continue;
                error += std::abs(more), sum += expected;
                ++near;
            }
        CAPTURE(pixels, near, error / near, sum / near, over);
        CHECK(pixels > 2000);
        CHECK(near > 60);
        CHECK(error / near < 0.12);
        CHECK(over < 0.35);  // a cell beside the foot
    }
}

TEST_CASE("contact shadow: its opacity follows what covers the ground, and how opaque that is", "[raster][contact-shadow]") {
    // The darkest ground below a table whose top is a plate, or bars that cover a tenth of it.
    const auto darkest = [](bool plate, float transmission) {
        std::vector<Block> all;
        for (const float x : {-0.7f, 0.7f})
            for (const float z : {-0.7f, 0.7f}) all.push_back({{x, 0.25f, z}, {0.02f, 0.25f, 0.02f}});
        if (plate) all.push_back({{0, 0.52f, 0}, {0.8f, 0.02f, 0.8f}});
        for (int k = 0; !plate && k < 8; ++k) all.push_back({{-0.7f + 0.2f * static_cast<float>(k), 0.52f, 0}, {0.01f, 0.01f, 0.8f}});
        Scene scene = blocks(all);
        scene.materials[0].transmission = transmission;
        const std::vector<float> picture = drawn(scene, looking(kEye), shadowed());
        float most = 0;
        for (std::size_t i = 0; i < picture.size(); i += 4)
            if (picture[i] == 0.0f && picture[i + 3] < 1.0f) most = std::max(most, picture[i + 3]);
        return most;
    };
    const float plate = darkest(true, 0), bars = darkest(false, 0), glass = darkest(true, 1);
    CAPTURE(plate, bars, glass);
    CHECK(plate > 0.4f);
    CHECK(bars > 0.02f);
    CHECK(bars < 0.35f * plate);
    CHECK(glass > 0.05f);
    CHECK(glass < 0.4f * plate);
}

TEST_CASE("contact shadow: it is a black surface before the background, whatever that is", "[raster][contact-shadow]") {
    const Scene scene = cube();
    const std::vector<float> alone = drawn(scene, looking(kEye), shadowed(0.7f));
    Settings on_grey = shadowed(0.7f);
    on_grey.background_linear = {0.4f, 0.5f, 0.6f, 1.0f};
    const std::vector<float> grey = drawn(scene, looking(kEye), on_grey);
    double most = 0;
    int shadowed_pixels = 0;
    for (std::size_t i = 0; i < alone.size(); i += 4) {
        const double alpha = double{alone[i + 3]};
        if (alpha == 1.0) continue;
        if (alpha > 0) {
            ++shadowed_pixels;
            CHECK(alone[i] == 0.0f);
        }
        most = std::max(most, alpha);
        CHECK(grey[i + 1] == Approx(0.5 * (1 - alpha)).margin(1e-6));
        CHECK(grey[i + 3] == 1.0f);
    }
    CHECK(shadowed_pixels > 200);
    CHECK(most > 0.3);
    CHECK(most < 0.7);
    CHECK(alone[3] == 0.0f);  // far from the model there is nothing
}

TEST_CASE("contact shadow: on black there is none to see, through glass and tone curves too", "[raster][contact-shadow]") {
    Scene scene = cube();
    scene.materials.push_back(scene.materials[0]);
    const bool transmits = GENERATE(false, true);
    scene.materials[1].alpha_mode = transmits ? AlphaMode::opaque : AlphaMode::blend;
    scene.materials[1].transmission = transmits ? 0.7f : 0.0f;
    scene.materials[1].base_color = {0.9f, 0.8f, 0.7f, 0.5f};
    scene.meshes.push_back(make_sphere(0.5f, 16, 16));
    scene.meshes.back().material = 1;
    scene.instances.push_back({1, translation({0.9f, 0.5f, 0.5f})});
    for (const ToneCurve curve : {ToneCurve::none, ToneCurve::reinhard, ToneCurve::aces, ToneCurve::neutral})
        for (const int samples : {1, 4, 8}) {
            const auto picture = [&](float opacity) {
                Settings settings = shadowed(opacity);
                settings.samples = samples;
                settings.tone_curve = curve;
                settings.exposure = 4.0f;
                settings.background_linear = {0, 0, 0, 1};
                std::vector<std::uint8_t> pixels(static_cast<std::size_t>(4 * kWidth * kHeight));
                REQUIRE(render(scene, looking(kEye), settings, {.width = kWidth, .height = kHeight, .pixels = pixels.data()}));
                return pixels;
            };
            CAPTURE(static_cast<int>(curve), samples, transmits);
            const auto with = picture(1.0f), without = picture(0.0f);
            int most = 0;
            for (std::size_t i = 0; i < with.size(); ++i) most = std::max(most, std::abs(int{with[i]} - int{without[i]}));
            CHECK(most <= 1);
        }
}

TEST_CASE("contact shadow: what stands has one, and what leans out or is seen from below or by parallel rays has none",
          "[raster][contact-shadow]") {
    const Camera above = looking(kEye);
    CHECK(has_shadow(cube(), above, shadowed()));
    CHECK(has_shadow(
        blocks({{{-0.8f, 0.5f, 0}, {0.05f, 0.5f, 0.3f}}, {{0.8f, 0.5f, 0}, {0.05f, 0.5f, 0.3f}}, {{0, 1, 0}, {0.9f, 0.05f, 0.3f}}}), above,
        shadowed()));
    // A beam with a thin pin below one end.
    CHECK_FALSE(has_shadow(blocks({{{0, 1, 0}, {1, 0.1f, 0.1f}}, {{-0.95f, 0.5f, 0}, {0.02f, 0.5f, 0.02f}}}), above, shadowed()));
    CHECK_FALSE(has_shadow(cube(), looking({2, -1, 3}), shadowed()));
    Camera parallel = above;
    parallel.orthographic = true;
    parallel.half_height = 2;
    CHECK_FALSE(has_shadow(cube(), parallel, shadowed()));
    Settings off = shadowed();
    off.shadows = ShadowMode::off;
    CHECK_FALSE(has_shadow(cube(), above, off));
    Scene on_ground = cube();
    add_ground(on_ground, scene_bounds(on_ground));
    CHECK_FALSE(has_shadow(on_ground, above, shadowed()));
    on_ground.instances.back().color = {0.5f, 1, 1, 1};
    CHECK_FALSE(has_shadow(on_ground, above, shadowed()));
    CHECK_FALSE(has_shadow(Scene{}, above, shadowed()));
    Scene flat = cube();
    flat.instances[0].world_from_object.c[0].x = std::numeric_limits<float>::quiet_NaN();
    CHECK_FALSE(has_shadow(flat, above, shadowed()));
}

TEST_CASE("contact shadow: the same bits by every instruction set, tile size, number of threads and samples, and in a crop",
          "[raster][contact-shadow]") {
    Scene scene = cube();
    const bool layers = GENERATE(false, true);
    if (layers) {
        scene.materials.push_back(scene.materials[0]);
        scene.materials[1].alpha_mode = AlphaMode::blend;
        scene.materials[1].base_color = {1, 0.2f, 0.1f, 0.4f};
        scene.meshes.push_back(make_sphere(0.5f, 16, 16));
        scene.meshes.back().material = 1;
        scene.instances.push_back({1, translation({0.9f, 0.5f, 0.5f})});
    }
    for (const int samples : {1, 4}) {
        Settings settings = shadowed(0.8f);
        settings.samples = samples;
        settings.tone_curve = samples == 1 ? ToneCurve::none : ToneCurve::neutral;
        settings.background_linear = {0.2f, 0.3f, 0.4f, 0.5f};
        const auto picture = [&](const Settings& with, const Execution& execution) {
            std::vector<std::uint8_t> pixels(static_cast<std::size_t>(4 * kWidth * kHeight));
            REQUIRE(render(scene, looking(kEye), with, {.width = kWidth, .height = kHeight, .pixels = pixels.data()}, execution));
            return pixels;
        };
        const auto expected = picture(settings, {.threads = 1, .isa = Isa::scalar});
        for (const Isa isa : test::available_isas())
            for (const int tile : {16, 64})
                for (const int threads : {1, 3}) CHECK(picture(settings, {.threads = threads, .tile_size = tile, .isa = isa}) == expected);
        // Its own tiles are empty, crossed by edges, or under layers: crops move them.
        for (const Region& region : {Region{31, 47, 40, 33}, Region{70, 60, 7, 5}}) {
            Settings crop = settings;
            crop.region = region;
            const auto part = picture(crop, {.tile_size = 32});
            bool same = true;
            for (int y = region.y; y < region.y + region.height; ++y)
                for (int x = region.x; x < region.x + region.width; ++x)
                    for (int c = 0; c < 4; ++c) {
                        const auto at = static_cast<std::size_t>(4 * (y * kWidth + x) + c);
                        same &= part[at] == expected[at];
                    }
            CHECK(same);
        }
    }
}

TEST_CASE("contact shadow: what views leave out does not change it", "[raster][contact-shadow]") {
    const std::vector<Block> alone{{{0, 0.5f, 0}, {0.5f, 0.5f, 0.5f}}};
    std::vector<Block> strayed = alone;
    strayed.push_back({{400, 0.001f, 400}, {0.001f, 0.001f, 0.001f}});  // behind the eye, as low as the cube
    const auto expected = drawn(blocks(alone), looking(kEye), shadowed());
    const Scene scene = blocks(strayed);
    for (const int tile : {16, 64}) {
        std::vector<float> linear(static_cast<std::size_t>(4 * kWidth * kHeight));
        REQUIRE(
            render(scene, looking(kEye), shadowed(), {.width = kWidth, .height = kHeight, .linear = linear.data()}, {.tile_size = tile}));
        CHECK(linear == expected);
    }
}

TEST_CASE("contact shadow: it follows a model that moves, in the frames of one renderer", "[raster][contact-shadow]") {
    Scene scene = cube();
    auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    Renderer renderer;
    for (const float x : {0.0f, 0.2f, 0.5f, 0.5f}) {
        scene.instances[0].world_from_object = translation({x, 0.5f + x, 0});
        REQUIRE(prepared->update({.changed_instances = {0}}));
        std::vector<float> linear(static_cast<std::size_t>(4 * kWidth * kHeight));
        REQUIRE(renderer.render(*prepared, looking(kEye), shadowed(), {.width = kWidth, .height = kHeight, .linear = linear.data()}));
        CHECK((linear == drawn(scene, looking(kEye), shadowed())));
    }
}
