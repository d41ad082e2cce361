// A pixel's story, compared with closed forms.
#include "halflit/explain.hpp"
#include "halflit/shapes.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"
#include "tests/raster/panes.hpp"

#include <cmath>
#include <random>
#include <string>

using namespace halflit;
using namespace halflit::test;

namespace {

PixelStory story_of(const Scene& scene, const Camera& camera, const Settings& settings, PictureSize size, int x, int y) {
    const auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    Renderer renderer;
    auto story = explain_pixel(renderer, *prepared, scene, camera, settings, size, x, y);
    if (!story) FAIL(story.error().message);
    return std::move(*story);
}

Settings diffuse_settings() {
    Settings settings;
    settings.shading.specular = SpecularModel::none;
    return settings;
}

Material clay(const Lobe& lobe = Lobe::lambert()) {
    Material material;
    material.name = "clay";
    material.base_color = {0.8f, 0.5f, 0.25f, 1};
    material.metallic = 0;
    material.lobe = lobe, material.has_own_lobe = true;
    return material;
}

/// A scene with a wall across the picture at z = 0, which faces the camera.
Scene wall(const Material& material) {
    Scene scene;
    add_pane(scene, material, 0, 0);
    scene.meshes[0].name = "wall";
    return scene;
}

constexpr PictureSize kSize{65, 65};
constexpr int kMiddle = 32;  // its pixel's middle is at x = y = 0

}  // namespace

TEST_CASE("explain: N.L, lobe and share of a wall under a sun are the closed forms", "[raster][explain]") {
    for (const Lobe& lobe : {Lobe::lambert(), Lobe::half_lambert(), Lobe::sloan(0.6f), Lobe::mcauley(0.3f, 2.5f)})
        for (const double degrees : {0.0, 35.0, 80.0, 100.0, 130.0}) {
            const double angle = degrees * std::acos(-1.0) / 180, x = std::cos(angle);
            Scene scene = wall(clay(lobe));
            Light sun;
            sun.color_linear = {0.5f, 0.7f, 0.9f};
            sun.direction_ws = {static_cast<float>(-std::sin(angle)), 0, static_cast<float>(-std::cos(angle))};
            scene.lights.push_back(sun);
            const PixelStory story = story_of(scene, camera_flat(), diffuse_settings(), kSize, kMiddle, kMiddle);
            INFO(degrees << " " << lobe.wrap);
            REQUIRE(story.shows == PixelShows::surface);
            CHECK(story.mesh_name == "wall");
            CHECK(story.material.name == "clay");
            REQUIRE(story.shares.size() == 1);
            const LightShare& share = story.shares[0];
            const double w = double{lobe.wrap},
                         value = double{lobe.scale()} * std::pow(std::max(0.0, (x + w) / (1 + w)), double{lobe.power});
            CHECK(share.cosine == Approx(x).margin(1e-7));
            CHECK(share.lambert == Approx(std::max(0.0, x)).margin(1e-7));
            CHECK(share.lobe == Approx(value).margin(1e-7));
            const double colors[3] = {0.5 * 0.8, 0.7 * 0.5, 0.9 * 0.25};
            for (std::size_t c = 0; c < 3; ++c) CHECK(share.linear[c] == Approx(colors[c] * value).epsilon(1e-6).margin(1e-7));
            CHECK(share.unhidden.has_value() == (value > 0));
            CHECK_FALSE(share.hidden_by);
        }
}

TEST_CASE("explain: the light of a point light falls off with the squared distance, and the brightest share comes first",
          "[raster][explain]") {
    Scene scene = wall(clay());
    scene.materials[0].emissive = {0.125f, 0, 0};
    for (const float z : {5.0f, 2.0f}) {
        Light lamp;
        lamp.type = LightType::point;
        lamp.position_ws = {0, 0, z};
        scene.lights.push_back(lamp);
    }
    const PixelStory story = story_of(scene, camera_flat(), diffuse_settings(), kSize, kMiddle, kMiddle);
    REQUIRE(story.shares.size() == 2);
    CHECK(story.shares[0].index == 1);
    CHECK(story.shares[1].index == 0);
    for (const LightShare& share : story.shares) {
        const double distance = share.index == 0 ? 5 : 2;
        CHECK(share.distance == Approx(distance));
        CHECK(share.linear[0] == Approx(0.8 / (distance * distance)).epsilon(1e-6));
    }
    CHECK(story.emitted[0] == Approx(0.125));
    CHECK(story.linear[0] == Approx(0.125 + 0.8 / 4 + 0.8 / 25).epsilon(1e-6));
}

TEST_CASE("explain: a box between a surface and a light is named as what hides it", "[raster][explain]") {
    // From the origin the light lies along (0.6, 0, 0.8). The ray enters the box at z = 1.8, after 2.25, and leaves it at z = 2.2,
    // after 2.75.
    Scene scene = wall(clay());
    Mesh box = make_box({0.2f, 0.2f, 0.2f});
    box.name = "box", box.material = 0;
    scene.meshes.push_back(box);
    scene.instances.push_back({1, translation({1.5f, 0, 2})});
    Light lamp;
    lamp.type = LightType::point;
    lamp.position_ws = {3, 0, 4};
    scene.lights.push_back(lamp);
    for (const bool double_sided : {false, true}) {
        scene.materials[0].double_sided = double_sided;
        const PixelStory story = story_of(scene, camera_flat(), diffuse_settings(), kSize, kMiddle, kMiddle);
        REQUIRE(story.shares.size() == 1);
        const LightShare& share = story.shares[0];
        CHECK(share.unhidden == 0.0);
        CHECK(share.linear == Rgb3{0, 0, 0});
        REQUIRE(share.hidden_by);
        CHECK(share.hidden_by->mesh_name == "box");
        CHECK(share.hidden_by->instance == 1);
        CHECK(share.hidden_by->mesh == 1);
        // Light passes through sides that turn their back to it, unless both sides count.
        CHECK(share.hidden_by->distance == Approx(double_sided ? 2.25 : 2.75).epsilon(1e-6));
        CHECK(share.hidden_by->back == double_sided);
    }
    scene.lights[0].position_ws = {1.2f, 0, 1.6f};  // before the box
    CHECK_FALSE(story_of(scene, camera_flat(), diffuse_settings(), kSize, kMiddle, kMiddle).shares[0].hidden_by);
}

TEST_CASE("explain: layers in front and hidden surfaces behind are listed with their distances", "[raster][explain]") {
    Scene scene = wall(clay());
    for (const float z : {2.0f, 1.0f, -1.0f, -3.0f}) {
        Material material = clay();
        material.name = "z " + std::to_string(static_cast<int>(z));
        if (z > 0) material.alpha_mode = AlphaMode::blend, material.base_color.w = z == 2.0f ? 0.25f : 0.5f;
        add_pane(scene, material, z, 0);
    }
    // A pane that turns its back to the camera is not drawn.
    add_pane(scene, clay(), -2, 0);
    scene.meshes.back().indices = {0, 2, 1, 0, 3, 2};
    const auto check = [&](const Camera& camera, double slope) {
        const PixelStory story = story_of(scene, camera, diffuse_settings(), kSize, 40, kMiddle);
        CHECK(story.instance == 0);
        REQUIRE(story.layers.size() == 2);
        CHECK(story.layers[0].material_name == "z 2");
        CHECK(story.layers[0].distance == Approx(8 * slope));
        CHECK(story.layers[0].alpha == 0.25);
        CHECK(story.layers[0].layer);
        CHECK(story.layers[1].distance == Approx(9 * slope));
        CHECK(story.layers[1].alpha == 0.5);
        REQUIRE(story.behind.size() == 2);
        CHECK(story.behind[0].material_name == "z -1");
        CHECK(story.behind[0].distance == Approx(11 * slope));
        CHECK(story.behind[1].material_name == "z -3");
        CHECK(story.behind[1].distance == Approx(13 * slope));
        CHECK_FALSE(story.behind[0].layer);
    };
    check(camera_flat(), 1.0);
    Camera lens = camera_at({0, 0, 10}, {0, 0, 0}, 0.15f);
    const double sideways = 16.0 / 65.0 * std::tan(0.075);  // of the middle of column 40, eight pixels from the axis
    check(lens, std::sqrt(1 + sideways * sideways));
}

TEST_CASE("explain: a pixel without a surface tells its layers and its background", "[raster][explain]") {
    Scene scene;
    Material film = clay();
    film.alpha_mode = AlphaMode::blend, film.base_color.w = 0.5f;
    film.unlit = true;
    add_pane(scene, film, 1, 0, 0, 2);  // over the right half
    Settings settings;
    settings.background_linear = {0.25f, 0.5f, 1, 1};
    for (const Camera& camera : {camera_flat(), camera_at({0, 0, 10}, {0, 0, 0}, 0.15f)}) {
        const PixelStory empty = story_of(scene, camera, settings, kSize, 10, 20);
        CHECK(empty.shows == PixelShows::background);
        CHECK(empty.background_kind == BackgroundKind::color);
        CHECK(empty.coverage == 0.0);
        CHECK(empty.layers.empty());
        CHECK(empty.background == Rgb3{0.25, 0.5, 1});
        const PixelStory covered = story_of(scene, camera, settings, kSize, 50, 20);
        CHECK(covered.shows == PixelShows::layers);
        REQUIRE(covered.layers.size() == 1);
        CHECK(covered.layers[0].position.z == Approx(1.0));
        const double base[3] = {0.8f, 0.5f, 0.25f};
        for (std::size_t c = 0; c < 3; ++c) {
            CHECK(covered.emitted[c] == Approx(0.5 * base[c]).epsilon(1e-6));
            CHECK(covered.background[c] == Approx(0.5 * empty.background[c]).epsilon(1e-6));
        }
    }
    settings.background_linear = {0, 0, 0, 0};
    CHECK(story_of(scene, camera_flat(), settings, kSize, 10, 20).background_kind == BackgroundKind::transparent);
}

TEST_CASE("explain: the background has its own codes, without a tone curve, and names the shadow on it", "[raster][explain]") {
    Scene scene;
    const Mesh box = make_box({0.5f, 0.5f, 0.5f});
    scene.materials = {clay()};
    scene.meshes = {box};
    scene.meshes[0].material = 0;
    scene.instances = {{0, translation({0, 0.5f, 0})}};
    Settings settings;
    settings.tone_curve = ToneCurve::neutral;
    settings.contact_shadow = 0.85f;
    settings.background_linear = {0.25f, 0.5f, 1, 1};
    int shadowed = 0, open = 0;
    for (int y = 0; y < kSize.height; ++y) {
        const PixelStory story = story_of(scene, camera_at({0, 3, 3}, {0, 0.5f, 0}, 0.9f), settings, kSize, 32, y);
        if (story.shows != PixelShows::background || story.coverage > 0.0) continue;
        (story.contact_shadow > 0.0 ? shadowed : open) += 1;
        for (std::size_t c = 0; c < 3; ++c) {
            CHECK(story.reference_codes[c] == Approx(double(story.codes[c])).margin(0.51));
            CHECK(story.background[c] == Approx(double((&settings.background_linear.x)[c]) * (1 - story.contact_shadow)).margin(1e-6));
        }
    }
    CHECK(shadowed > 2);
    CHECK(open > 2);
}

TEST_CASE("explain: lines and layers are no contact shadow, and an unlit surface has its own codes", "[raster][explain]") {
    Scene scene;
    Material pane = clay();
    pane.alpha_mode = AlphaMode::blend, pane.base_color.w = 0.5f;
    add_pane(scene, pane, 1, 0, 0.3f, 0.9f);
    Material sign = clay();
    sign.unlit = true;
    add_pane(scene, sign, 1, 0, -0.9f, -0.3f);
    Settings settings;
    settings.tone_curve = ToneCurve::neutral;
    settings.samples = 4;
    settings.background_linear = {0.25f, 0.5f, 1, 1};
    for (const auto& [opacity, edges] : {std::pair{0.0f, EdgeChoice::all}, {0.85f, EdgeChoice::all}, {0.85f, EdgeChoice::none}}) {
        settings.contact_shadow = opacity, settings.edges = edges;
        int unlit = 0;
        for (int x = 0; x < kSize.width; ++x) {
            const PixelStory story = story_of(scene, camera_flat(), settings, kSize, x, 20);
            CHECK(story.contact_shadow == 0.0);
            for (std::size_t c = 0; c < 3; ++c)
                CHECK(absolute(story.reference_codes[c] - double(story.codes[c])) <= story.error_codes[c] + 0.51);
            unlit += story.shows == PixelShows::surface;
        }
        CHECK(unlit > 2);
    }
}

TEST_CASE("explain: a hole of a mask is neither a surface nor in a light's way", "[raster][explain]") {
    // Texels of the left half are holes.
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < 64; ++i) texels.insert(texels.end(), {255, 255, 255, static_cast<std::uint8_t>(i % 8 < 4 ? 0 : 255)});
    auto texture = Texture::from_rgba8(texels, 8, 8, ColorSpace::srgb);
    REQUIRE(texture);
    Scene scene = wall(clay());
    Material leaf = clay();
    leaf.alpha_mode = AlphaMode::mask;
    leaf.textures[TextureSlot::base_color].texture = 0;
    scene.textures.push_back(*texture);
    add_pane(scene, leaf, -1, 0);
    scene.lights.push_back({});
    scene.lights[0].direction_ws = {0, 0, 1};
    for (const int x : {12, 52}) {
        const PixelStory story = story_of(scene, camera_flat(), diffuse_settings(), kSize, x, kMiddle);
        CHECK(story.behind.size() == (x == 12 ? 0u : 1u));
    }
    scene.instances[1].world_from_object = translation({0, 0, 1.5f});  // before the wall
    const PixelStory leaf_story = story_of(scene, camera_flat(), diffuse_settings(), kSize, 52, kMiddle);
    CHECK(leaf_story.instance == 1);
    REQUIRE(leaf_story.textures.size() == 1);
    // The leaf reaches from -2 to 2, and the picture from -1 to 1.
    CHECK(leaf_story.textures[0].u == Approx(0.5 + (2.0 * 52.5 / 65 - 1) / 4).epsilon(1e-5));
    CHECK(leaf_story.textures[0].full_size[3] == Approx(1.0));
    CHECK(story_of(scene, camera_flat(), diffuse_settings(), kSize, 12, kMiddle).instance == 0);
    scene.lights[0].direction_ws = {0, 0, -1};
    CHECK_FALSE(story_of(scene, camera_flat(), diffuse_settings(), kSize, 12, kMiddle).shares[0].hidden_by);
}

TEST_CASE("explain: of random pixels of the demo, the parts add up and the weights give the position", "[raster][explain]") {
    const Scene scene = demo_scene();
    const auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    Settings settings;
    settings.samples = 4;
    settings.shadow_size = 128;
    settings.background_linear = {0.1f, 0.3f, 0.2f, 0.5f};
    Renderer renderer;
    std::mt19937 random(11);
    int surfaces = 0;
    for (int i = 0; i < 200; ++i) {
        const int x = static_cast<int>(random() % 160), y = static_cast<int>(random() % 90);
        const auto story = explain_pixel(renderer, *prepared, scene, scene.cameras[0], settings, {160, 90}, x, y);
        REQUIRE(story);
        INFO(x << " " << y);
        CHECK(story->lights_left_out == 0);
        for (std::size_t c = 0; c < 3; ++c) {
            double sum = (story->around[c] + story->emitted[c]) + story->background[c];
            for (const LightShare& share : story->shares) sum += share.linear[c];
            CHECK(sum == Approx(story->linear[c] * story->alpha).epsilon(4e-6).margin(1e-6));  // float32 sums in another order
        }
        if (story->shows != PixelShows::surface) continue;
        ++surfaces;
        REQUIRE(story->corners.size() == 3);
        Vec3d sum{};
        double weights = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            CHECK(story->barycentrics[k] >= 0.0);
            sum = sum + story->corners[k] * story->barycentrics[k];
            weights += story->barycentrics[k];
        }
        CHECK(weights == Approx(1.0).epsilon(1e-14));
        const double size = length(story->position);
        CHECK(length(sum - story->position) <= 1e-6 * size);
        CHECK(story->position_error == Approx(length(sum - story->position)).margin(1e-15));
    }
    CHECK(surfaces > 150);
}

TEST_CASE("explain: instances have their own materials and colours", "[raster][explain]") {
    Scene scene = wall(clay());
    Material other = clay();
    other.name = "other";
    scene.materials.push_back(other);
    scene.instances[0].material = 1;
    scene.instances[0].color = {0.5f, 1, 1, 1};
    const PixelStory story = story_of(scene, camera_flat(), diffuse_settings(), kSize, kMiddle, kMiddle);
    CHECK(story.material_index == 1);
    CHECK(story.material.name == "other");
    CHECK(story.material.base_color.x == 0.4f);
    CHECK(story.albedo[0] == Approx(0.4));
}

TEST_CASE("explain: a pixel outside of the picture is an error that names the size, and so is a time limit that ends",
          "[raster][explain]") {
    const Scene scene = wall(clay());
    const auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    Renderer renderer;
    for (const auto& [x, y] : {std::pair{65, 0}, {0, 65}, {-1, 0}, {0, -1}}) {
        const auto story = explain_pixel(renderer, *prepared, scene, camera_flat(), {}, kSize, x, y);
        REQUIRE_FALSE(story);
        CHECK(story.error().code == ErrorCode::usage);
        CHECK(story.error().message.find("65x65") != std::string::npos);
    }
    Execution hurried;
    hurried.time_limit_s = 1e-9;
    const auto late = explain_pixel(renderer, *prepared, scene, camera_flat(), {}, kSize, 0, 0, hurried);
    REQUIRE_FALSE(late);
    CHECK(late.error().code == ErrorCode::limit);
}
