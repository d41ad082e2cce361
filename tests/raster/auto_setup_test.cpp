// The automatic setup: lights, ambient light, exposure and camera by the rules that its header gives.
#include "halflit/auto_setup.hpp"

#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "tests/raster/auto_light.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <limits>

using namespace halflit;
using halflit::test::set_up;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

/// A unit box at the origin.
Scene box_scene() {
    Scene scene;
    scene.meshes.push_back(make_box({1, 1, 1}));
    scene.instances.push_back({0, {}});
    return scene;
}

Camera seen_from(Vec3f eye, Vec3f target) {
    Camera camera;
    camera.world_from_camera = look_at(eye, target);
    return camera;
}

Light sun(Vec3f color) {
    Light light;
    light.color_linear = color;
    return light;
}

std::shared_ptr<const Environment> grey(float radiance, bool calibrated) {
    return make_environment({8, 4, std::vector<float>(3 * 8 * 4, radiance), calibrated}).value();
}

bool same(Vec3f a, Vec3f b) { return a == b; }
bool same(const Ambient& a, const Ambient& b) { return same(a.sky_linear, b.sky_linear) && same(a.ground_linear, b.ground_linear); }

bool chosen(const Camera& camera, Scene scene = box_scene()) {
    scene.cameras.assign(1, camera);
    const Camera* found = choose_camera(scene, scene_bounds(scene));
    CHECK((found == nullptr || found == scene.cameras.data()));
    const AutoSetup setup = set_up(scene, 200, 100);
    CHECK(setup.framed == (found == nullptr));
    if (found != nullptr) CHECK(setup.camera == camera);
    return found != nullptr;
}

}  // namespace

TEST_CASE(
    "setup: the usual settings are four samples over dark grey, the neutral curve, hidden skies, a contact shadow, anisotropic filters, "
    "points that close their surface and have form, lines that contrast, "
    "and else defaults",
    "[raster][setup]") {
    Settings s = usual_settings();
    CHECK(s.samples == 4);
    CHECK(s.tone_curve == ToneCurve::neutral);
    CHECK(s.shading.anisotropy == 4);
    std::vector<std::uint8_t> pixels(4);
    REQUIRE(render(Scene{}, Camera{}, s, {.width = 1, .height = 1, .pixels = pixels.data()}));
    CHECK(pixels == std::vector<std::uint8_t>{0x2c, 0x30, 0x36, 0xff});
    CHECK(s.sky_shadows == kSkyShadowsAuto);
    CHECK(s.contact_shadow == 0.85f);
    s.samples = Settings{}.samples;
    s.sky_shadows = Settings{}.sky_shadows;
    s.contact_shadow = Settings{}.contact_shadow;
    CHECK(s.point_size == 0.0f);
    CHECK(s.edl == EyeDomeLighting::automatic);
    CHECK(s.edge_contrast);
    s.point_size = Settings{}.point_size;
    s.edl = Settings{}.edl;
    s.edge_contrast = Settings{}.edge_contrast;
    s.tone_curve = Settings{}.tone_curve;
    s.shading.anisotropy = Settings{}.shading.anisotropy;
    CHECK(s.shadow_softness_deg == 3);
    s.shadow_softness_deg = 0;
    CHECK(s.alpha == AlphaSpace::display);
    s.alpha = Settings{}.alpha;
    s.background_linear = Settings{}.background_linear;
    CHECK(s == Settings{});
}

TEST_CASE("setup: a scene without light gets the studio with a key light, and exposure 1", "[raster][setup]") {
    for (const bool calibrated : {true, false}) {
        Scene scene = box_scene(), wanted = box_scene();
        scene.calibrated = calibrated;
        const AutoSetup setup = set_up(scene, 200, 100);
        add_studio(wanted, setup.camera);
        CHECK(setup.settings.exposure == 1.0f);
        CHECK(scene.lights == wanted.lights);
        REQUIRE(scene.lights.size() == 1);
        REQUIRE(scene.environment != nullptr);
        CHECK(environment_level(*scene.environment) == environment_level(*wanted.environment));
        CHECK(same(scene.ambient, Ambient{}));
        // A second call finds light, and leaves it: the same view and exposure.
        const std::shared_ptr<const Environment> studio = scene.environment;
        const AutoSetup again = set_up(scene, 200, 100);
        CHECK(scene.lights.size() == 1);
        CHECK(scene.environment == studio);
        CHECK(again.camera == setup.camera);
        CHECK(again.settings == setup.settings);
    }
    Scene scene = box_scene();
    static_cast<void>(set_up(scene, 200, 100, {.add_lights = false}));
    CHECK(scene.lights.empty());
    CHECK(scene.environment == nullptr);
    CHECK(same(scene.ambient, Ambient{}));
}

TEST_CASE("setup: lights that give no light count as none", "[raster][setup]") {
    Scene scene = box_scene(), wanted = box_scene();
    scene.lights = {sun({0, 0, 0})};
    scene.calibrated = false;
    const AutoSetup setup = set_up(scene, 200, 100);
    add_studio(wanted, setup.camera);
    REQUIRE(scene.lights.size() == 2);
    CHECK(scene.lights[1] == wanted.lights[0]);
    REQUIRE(scene.environment != nullptr);
    CHECK(environment_level(*scene.environment) == environment_level(*wanted.environment));
    CHECK(setup.settings.exposure == 1.0f);
}

TEST_CASE("setup: without the studio, a scene without light gets the default lights", "[raster][setup]") {
    Scene scene = box_scene(), wanted = box_scene();
    const AutoSetup setup = set_up(scene, 200, 100, {.studio = StudioUse::never});
    add_default_lights(wanted, setup.camera);
    CHECK(scene.environment == nullptr);
    CHECK(scene.lights == wanted.lights);
    CHECK(same(scene.ambient, wanted.ambient));
    CHECK(setup.settings.exposure == 1.0f);
}

TEST_CASE("setup: lights of a file add to the studio, and get an exposure that makes them 1 at most", "[raster][setup]") {
    Scene dark = box_scene();
    static_cast<void>(set_up(dark, 200, 100));
    const double whole = environment_level(*dark.environment);
    for (const LightType type : {LightType::directional, LightType::point}) {
        Scene scene = box_scene();
        scene.lights = {sun({300, 200, 100}), sun({50, 0, 0})};
        for (Light& light : scene.lights) light.type = type, light.position_ws = {2, 0, 0};
        scene.calibrated = false;
        const AutoSetup setup = set_up(scene, 200, 100);
        const double falloff = type == LightType::point ? 0.25 : 1.0;                     // at a distance of 2 from the centre
        const double luminance = falloff * (0.2126 * 350 + 0.7152 * 200 + 0.0722 * 100);  // Rec. 709
        CHECK(double{setup.settings.exposure} == Approx(1 / luminance).epsilon(1e-4));
        REQUIRE(scene.environment != nullptr);
        CHECK(environment_level(*scene.environment) * double{setup.settings.exposure} == Approx(whole).epsilon(1e-5));
        CHECK(same(scene.ambient, Ambient{}));
        REQUIRE(scene.lights.size() == 3);  // and the key light
        const double key = double{scene.lights[2].color_linear.y} * double{setup.settings.exposure};
        if (type == LightType::point)
            CHECK(key == Approx(dark.lights[0].color_linear.y).epsilon(1e-5));
        else
            CHECK(key < 0.6 * double{dark.lights[0].color_linear.y});  // suns that light what is seen take its place
        const std::shared_ptr<const Environment> studio = scene.environment;
        const AutoSetup again = set_up(scene, 200, 100);
        CHECK(scene.environment == studio);
        CHECK(again.settings == setup.settings);
    }
    // Weak lights keep their strength: a lamp that reaches nothing changes nothing.
    Scene faint = box_scene();
    faint.lights = {sun({0.5f, 0, 0})};
    faint.lights[0].type = LightType::point, faint.lights[0].position_ws = {100, 0, 0}, faint.lights[0].range = 1;
    faint.calibrated = false;
    CHECK(set_up(faint, 200, 100).settings.exposure == 1.0f);
    CHECK(faint.lights[1] == dark.lights[0]);
    // Ambient light that is there stays.
    Scene own = box_scene();
    own.lights = {sun({300, 200, 100})};
    own.calibrated = false;
    own.ambient = {{1, 2, 3}, {0, 0, 0}};
    static_cast<void>(set_up(own, 200, 100));
    CHECK(same(own.ambient, {{1, 2, 3}, {0, 0, 0}}));
    CHECK(own.environment == nullptr);
}

TEST_CASE("setup: lights whose unit is known get a share of the studio on request, and nothing otherwise", "[raster][setup]") {
    Scene dark = box_scene();
    static_cast<void>(set_up(dark, 200, 100));
    const double whole = environment_level(*dark.environment);
    for (const LightType type : {LightType::directional, LightType::point}) {
        Scene scene = box_scene(), plain = box_scene();
        scene.lights = {sun({0.5f, 0.5f, 0.5f})};
        scene.lights[0].type = type, scene.lights[0].position_ws = {2, 0, 0};
        plain.lights = scene.lights;
        const AutoSetup setup = set_up(scene, 200, 100, {.studio = StudioUse::under_lights});
        REQUIRE(scene.environment != nullptr);
        CHECK(environment_level(*scene.environment) == Approx(0.15 * whole).epsilon(1e-5));
        CHECK(setup.settings.exposure == 1.0f);
        CHECK(scene.lights.size() == 1);
        static_cast<void>(set_up(plain, 200, 100));
        CHECK(plain.environment == nullptr);
        // Ambient light that is there stays.
        plain.ambient = {{1, 2, 3}, {0, 0, 0}};
        static_cast<void>(set_up(plain, 200, 100, {.studio = StudioUse::under_lights}));
        CHECK(plain.environment == nullptr);
    }
    Scene none = box_scene();
    static_cast<void>(set_up(none, 200, 100, {.studio = StudioUse::under_lights}));
    REQUIRE(none.environment != nullptr);
    CHECK(environment_level(*none.environment) == Approx(whole).epsilon(1e-6));
}

TEST_CASE("setup: without the studio, lights of a file get soft ambient light", "[raster][setup]") {
    Scene scene = box_scene();
    scene.lights = {sun({300, 200, 100}), sun({50, 0, 0})};
    scene.calibrated = false;
    static_cast<void>(set_up(scene, 200, 100, {.studio = StudioUse::never}));
    CHECK(double{scene.ambient.sky_linear.x} == Approx(35.0));
    CHECK(double{scene.ambient.sky_linear.z} == Approx(10.0));
    CHECK(double{scene.ambient.ground_linear.y} == Approx(10.0));
    CHECK(scene.environment == nullptr);
}

TEST_CASE("setup: on request the studio lights a scene in full, whatever lights it has", "[raster][setup]") {
    Scene dark = box_scene();
    static_cast<void>(set_up(dark, 200, 100));
    const double whole = environment_level(*dark.environment);
    for (const bool calibrated : {true, false}) {
        Scene scene = box_scene();
        scene.lights = {sun({300, 200, 100})};
        scene.calibrated = calibrated;
        const AutoSetup setup = set_up(scene, 200, 100, {.studio = StudioUse::always});
        CHECK(scene.lights.size() == 1);
        CHECK((setup.settings.exposure == 1.0f) == calibrated);
        CHECK(environment_level(*scene.environment) * double{setup.settings.exposure} == Approx(whole).epsilon(1e-5));
    }
    Scene outdoors = box_scene();
    outdoors.environment = grey(5, false);
    CHECK(set_up(outdoors, 200, 100, {.studio = StudioUse::always}).settings.exposure == 1.0f);
    CHECK(environment_level(*outdoors.environment) == Approx(whole).epsilon(1e-5));
}

TEST_CASE("setup: calibrated lights stay as they are", "[raster][setup]") {
    Scene scene = box_scene();
    scene.lights = {sun({300, 200, 100})};
    const AutoSetup setup = set_up(scene, 200, 100);
    CHECK(setup.settings.exposure == 1.0f);
    CHECK(scene.lights.size() == 1);
    CHECK(same(scene.ambient, Ambient{}));
    Scene dim = box_scene();
    dim.ambient.sky_linear = {0.1f, 0.1f, 0.1f};  // is light too
    CHECK(set_up(dim, 200, 100).settings.exposure == 1.0f);
    CHECK(dim.lights.empty());
}

TEST_CASE("setup: an environment is exposed to 0.5, or to 1 where it is calibrated", "[raster][setup]") {
    for (const float radiance : {0.01f, 1.0f, 250.0f}) {
        Scene scene = box_scene();
        scene.environment = grey(radiance, false);
        CHECK(double{set_up(scene, 200, 100).settings.exposure} == Approx(0.5 / double{radiance}).epsilon(1e-6));
        CHECK(scene.lights.empty());
        CHECK(same(scene.ambient, Ambient{}));
        scene.environment = grey(radiance, true);
        CHECK(set_up(scene, 200, 100).settings.exposure == 1.0f);
    }
    Scene dark = box_scene();
    dark.environment = grey(0, false);
    CHECK(set_up(dark, 200, 100).settings.exposure == 1.0f);

    // The rule for pixels: a white surface under it is 0.5.
    Scene scene = box_scene();
    scene.materials.resize(1);
    scene.materials[0].metallic = 0;
    scene.meshes[0].material = 0;
    scene.environment = grey(3, false);
    AutoSetup setup = set_up(scene, 40, 40);
    setup.settings.shading.specular = SpecularModel::none;
    std::vector<float> linear(4 * 40 * 40);
    REQUIRE(render(scene, setup.camera, setup.settings, {.width = 40, .height = 40, .linear = linear.data()}));
    CHECK(double{linear[4 * (20 * 40 + 20)]} == Approx(0.5).epsilon(0.005));  // within half an 8-bit code, the tolerance of bands
}

TEST_CASE("setup: the camera of a long flat scene is used if the scene reaches over most of its picture", "[raster][setup]") {
    Scene strip;
    strip.meshes.push_back(make_box({50, 1, 1}));
    strip.instances.push_back({0, {}});
    Camera camera = seen_from({0, 0, 10}, {0, 0, 0});
    camera.orthographic = true;
    camera.near_z = 1, camera.far_z = 20;
    camera.half_height = 40;
    for (const auto& [half_width, wanted] : {std::pair{60.0f, true}, {70.0f, true}, {80.0f, false}}) {
        camera.half_width = half_width;  // the strip is 5 of 6, 5 of 7, 5 of 8 as wide, and a 40th as high
        CHECK(chosen(camera, strip) == wanted);
    }
}

TEST_CASE("setup: what the caller decides is not chosen", "[raster][setup]") {
    Scene scene = box_scene();
    scene.cameras = {seen_from({0, 0, 5}, {0, 0, 0})};
    scene.lights = {sun({300, 200, 100})};
    scene.calibrated = false;
    const Camera own = seen_from({50, 50, 50}, {90, 90, 90});
    AutoSetup setup = set_up(scene, 200, 100, {.camera = own, .frame = true, .ambient_linear = Vec3f{1, 2, 3}, .exposure = 0.25f});
    CHECK(setup.camera == own);
    CHECK(!setup.framed);
    CHECK(setup.settings.exposure == 0.25f);
    CHECK(same(scene.ambient, {{1, 2, 3}, {1, 2, 3}}));

    setup = set_up(scene, 200, 100);
    CHECK(setup.camera == scene.cameras[0]);
    CHECK(!setup.framed);
    const ViewSettings view{.azimuth_deg = 10, .elevation_deg = 70, .zoom = 2, .fov_y_deg = 20};
    setup = set_up(scene, 200, 100, {.frame = true, .view = view});
    CHECK(setup.framed);
    CHECK(setup.camera == frame_scene(scene, 2.0f, view));
    CHECK(setup.settings.shadows == usual_settings().shadows);
    setup = set_up(scene, 200, 100, {.frame = true, .view = {.orthographic = true}});
    CHECK(setup.settings.shadows == ShadowMode::off);  // of parallel rays that were asked for

    // Ambient light beside the default lights, instead of theirs, and alone.
    Scene bare = box_scene();
    static_cast<void>(set_up(bare, 200, 100, {.ambient_linear = Vec3f{1, 2, 3}}));
    CHECK(bare.lights.size() == 1);
    CHECK(same(bare.ambient, {{1, 2, 3}, {1, 2, 3}}));
    bare = box_scene();
    static_cast<void>(set_up(bare, 200, 100, {.ambient_linear = Vec3f{1, 2, 3}, .add_lights = false}));
    CHECK(bare.lights.empty());
    CHECK(same(bare.ambient, {{1, 2, 3}, {1, 2, 3}}));
    // Black is a decision too.
    bare = box_scene();
    bare.lights = {sun({9, 9, 9})};
    bare.calibrated = false;
    static_cast<void>(set_up(bare, 200, 100, {.ambient_linear = Vec3f{0, 0, 0}}));
    CHECK(same(bare.ambient, Ambient{}));
}

namespace {

/// The scene with surfaces that are drawn from both sides.
Scene seen_from_within(Scene scene) {
    Material walls;
    walls.double_sided = true;
    for (Mesh& mesh : scene.meshes) mesh.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(walls);
    return scene;
}

}  // namespace

TEST_CASE("setup: a scene's first camera is taken, unless it shows almost nothing", "[raster][setup]") {
    CHECK(chosen(seen_from({0, 0, 5}, {0, 0, 0})));
    const Scene room = seen_from_within(box_scene());
    CHECK(chosen(seen_from({0, 0, 0}, {1, 1, 1}), room));     // from within
    CHECK(chosen(seen_from({0, 0, 0.9f}, {0, 0, 3}), room));  // out through the nearest wall
    CHECK(!chosen(seen_from({0, 0, 0}, {1, 1, 1})));          // backs alone, which are not drawn
    CHECK(!chosen(seen_from({0, 0, 5}, {0, 0, 10})));         // away from it
    CHECK(!chosen(seen_from({0, 0, 5}, {9, 0, 5})));          // past it
    CHECK(!chosen(seen_from({0, 2, 0}, {0, 3, 0})));
    CHECK(!chosen(seen_from({100, 100, 100}, {0, 0, 0})));

    // The front of the box is a square of half size 1 at the distance d - 1: its share is (1 / ((d - 1) tan 22.5 deg))^2, which is 1/6 at
    // d = 6.914. The box behind it does not stand out.
    CHECK(chosen(seen_from({0, 0, 6.9f}, {0, 0, 0})));
    CHECK(!chosen(seen_from({0, 0, 6.95f}, {0, 0, 0})));

    // Nearer than the near plane, or beyond the far one.
    Camera camera = seen_from({0, 0, 5}, {0, 0, 0});
    camera.near_z = 7;
    CHECK(!chosen(camera));
    camera.near_z = 0.1f;
    camera.far_z = 3.9f;
    CHECK(!chosen(camera));
    camera.far_z = 5;
    CHECK(chosen(camera));

    camera = seen_from({0, 0, 5}, {0, 0, 0});
    camera.orthographic = true;
    camera.half_height = camera.half_width = 2.4f;  // (1 / 2.4)^2 = 17.4 %
    camera.far_z = 100;
    CHECK(chosen(camera));
    camera.half_height = camera.half_width = 2.5f;  // 16 %
    CHECK(!chosen(camera));
    camera = seen_from({0, 0, 5}, {0, 0, 10});
    camera.orthographic = true;
    camera.half_height = 2;
    camera.far_z = 100;
    CHECK(!chosen(camera));  // looks away

    // A camera without a place shows nothing.
    camera = seen_from({kNan, 0, 5}, {0, 0, 0});
    Scene scene = box_scene();
    scene.cameras = {camera};
    CHECK(choose_camera(scene, scene_bounds(scene)) == nullptr);
    CHECK(choose_camera(box_scene(), {}) == nullptr);
}

TEST_CASE("setup: a box that reaches behind the camera fills what lies before it", "[raster][setup]") {
    // A long corridor: the camera stands in it and looks along it, or stands beside it and looks away.
    Scene corridor;
    corridor.meshes.push_back(make_box({1, 1, 50}));
    corridor.instances.push_back({0, {}});
    CHECK(chosen(seen_from({0, 0, 10}, {0, 0, 0}), seen_from_within(corridor)));
    CHECK(chosen(seen_from({3, 0, 10}, {0, 0, 5}), corridor));
    CHECK(!chosen(seen_from({3, 0, 10}, {9, 0, 10}), corridor));
    CHECK(!chosen(seen_from({3, 0, 0}, {9, 0, 6}), corridor));
}

TEST_CASE("setup: scenes without anything to see are set up too", "[raster][setup]") {
    Scene empty;
    const AutoSetup setup = set_up(empty, 200, 100);
    CHECK(setup.framed);
    CHECK(setup.camera == frame_bounds({}, 2.0f, {}));
    std::vector<std::uint8_t> pixels(4 * 8);
    CHECK(render(empty, setup.camera, setup.settings, {.width = 4, .height = 2, .pixels = pixels.data()}));

    Scene with_camera;
    with_camera.cameras = {seen_from({0, 0, 5}, {0, 0, 0})};
    const AutoSetup kept = set_up(with_camera, 200, 100);
    CHECK(!kept.framed);
    CHECK(kept.camera == with_camera.cameras[0]);
}

TEST_CASE("auto setup: a scene that faces back is seen from there, unless a view is asked for", "[raster]") {
    Scene scene = box_scene();
    const float front = auto_setup(scene, 64, 64).view.azimuth_deg;
    scene.faces_back = true;
    CHECK(auto_setup(scene, 64, 64).view.azimuth_deg == front + 180.0f);
    AutoOptions options;
    options.view.azimuth_deg = 10;
    CHECK(auto_setup(scene, 64, 64, options).view.azimuth_deg == 10.0f);
}

TEST_CASE("setup: vertices and lights that are not finite leave a finite setup", "[raster][setup]") {
    for (const float bad : {kNan, kInf, -kInf, 3e38f}) {
        Scene scene = box_scene();
        for (Vec3f& p : scene.meshes[0].positions)
            if (p.x > 0) p = {bad, -bad, bad};
        scene.cameras = {seen_from({0, 0, 5}, {0, 0, 0})};
        Light lamp;
        lamp.type = LightType::point;
        lamp.position_ws = {bad, 0, 0};
        lamp.color_linear = {bad, 1, 1};
        scene.lights = {lamp};
        scene.calibrated = false;
        const AutoSetup setup = set_up(scene, 40, 30);
        CHECK(std::isfinite(setup.settings.exposure));
        CHECK(setup.settings.exposure > 0);
        for (const Vec4f& c : setup.camera.world_from_camera.c) CHECK(std::isfinite(c.x + c.y + c.z + c.w));
        CHECK(std::isfinite(scene.ambient.sky_linear.x));
        std::vector<std::uint8_t> pixels(4 * 40 * 30);
        CHECK(render(scene, setup.camera, setup.settings, {.width = 40, .height = 30, .pixels = pixels.data()}));
    }
    Scene scene = box_scene();
    for (const auto& [width, height] : {std::pair{0, 0}, {0, 5}, {-3, 2}, {1, 100000}})
        for (const Vec4f& c : set_up(scene, width, height).camera.world_from_camera.c) CHECK(std::isfinite(c.x + c.y + c.z + c.w));
}
