// Shadow catchers: the ground's alpha against closed forms and the float64 reference, and what it must leave alone.
#include "halflit/auto_setup.hpp"
#include "halflit/renderer.hpp"
#include "halflit/scene.hpp"
#include "halflit/shapes.hpp"

#include "tests/raster/auto_light.hpp"
#include "tests/raster/test_scenes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/isas.hpp"

#include <cmath>

using namespace halflit;
using halflit::test::set_up;

namespace {

constexpr int kSize = 256;

struct Drawn {
    std::vector<std::uint8_t> codes = std::vector<std::uint8_t>(std::size_t{4} * kSize * kSize);
    std::vector<float> linear = std::vector<float>(codes.size());
};

Drawn drawn(const Scene& scene, const Camera& camera, const Settings& settings, const Execution& execution = {}) {
    Drawn out;
    REQUIRE(render(scene, camera, settings, {kSize, kSize, out.codes.data(), out.linear.data()}, execution));
    return out;
}

Settings transparent() {
    Settings settings;
    settings.background_linear = {0, 0, 0, 0};
    settings.shadow_size = 1024;
    return settings;
}

/// A box of half extents 0.5 whose lower side is `height` above y = 0.
Scene box_scene(float height) {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].metallic = 0;
    Mesh box = make_box({0.5f, 0.5f, 0.5f});
    box.material = 0;
    scene.meshes.push_back(std::move(box));
    scene.instances.push_back({0, translation({0, height + 0.5f, 0})});
    return scene;
}

/// Straight down on -4..4, the picture's top is towards -z.
Camera from_above() {
    Camera camera;
    camera.orthographic = true;
    camera.half_height = 4;
    camera.world_from_camera = {{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 10, 0, 1}}};
    camera.near_z = 1;
    camera.far_z = 30;
    return camera;
}

Light sun_from(Vec3f travels, Vec3f color) {
    Light sun;
    sun.type = LightType::directional;
    sun.direction_ws = travels;
    sun.color_linear = color;
    return sun;
}

}  // namespace

TEST_CASE("ground: the shadow of a box has the closed form's area, and its alpha is the share of the light that is hidden",
          "[raster][ground]") {
    // Light falls at 45 degrees along +x. A box that floats at the height h throws the shadow of x from h - 0.5 to h + 1.5, of which the
    // box hides -0.5 to 0.5 from above.
    struct Case {
        float height;
        double area;
        float sky;
    };
    for (const auto& [height, area, sky] : {Case{0, 1, 0}, {1, 2, 0}, {1, 2, 0.3f}, {2, 2, 1}}) {
        Scene scene = box_scene(height);
        scene.ambient = {{sky, sky, sky}, {sky, sky, sky}};
        const float sine = std::sqrt(0.5f);
        scene.lights.push_back(sun_from({sine, -sine, 0}, {1, 1, 1}));
        Bounds bounds = scene_bounds(scene);
        bounds.min.y = 0;
        add_ground(scene, bounds);
        const Drawn d = drawn(scene, from_above(), transparent());
        const double share = static_cast<double>(sine) / (static_cast<double>(sine) + static_cast<double>(sky));
        double sum = 0, most = 0;
        int colored = 0, lit = 0;
        for (std::size_t i = 0; i < d.linear.size(); i += 4) {
            const std::size_t x = i / 4 % kSize, y = i / 4 / kSize;
            const double px = (static_cast<double>(x) + 0.5) / kSize * 8 - 4, pz = (static_cast<double>(y) + 0.5) / kSize * 8 - 4;
            if (std::fabs(px) < 0.52 && std::fabs(pz) < 0.52) continue;  // the box
            const auto alpha = static_cast<double>(d.linear[i + 3]);
            sum += alpha;
            most = std::max(most, alpha);
            colored += d.linear[i] != 0 || d.linear[i + 1] != 0 || d.linear[i + 2] != 0;
            lit += alpha == 0;
            if (px < -0.6 || px > static_cast<double>(height) + 1.6 || std::fabs(pz) > 0.6) CHECK(alpha == 0.0);
        }
        INFO("height " << height << ", light of the sky " << sky);
        CHECK(most == Approx(share).epsilon(1e-5));
        CHECK(sum * 64 / (kSize * kSize) == Approx(area * share).epsilon(0.04));
        CHECK(colored == 0);
        CHECK(lit > kSize * kSize / 2);
    }
}

TEST_CASE("ground: every scene on it has the float64 reference's picture, and the same pixels on each instruction set, tile and region",
          "[raster][ground]") {
    int count = 0;
    for (const raster::test::NamedScene& named : raster::test::all_scenes())
        for (const int sky_shadows : {0, 16}) {
            if (sky_shadows > 0 && ++count % 3 != 1) continue;  // the reference takes its time
            Scene scene = named.scene;
            add_ground(scene, scene_bounds(scene));
            if (sky_shadows > 0) {
                scene.lights.clear();
                add_studio(scene, named.camera);
            }
            Settings settings = transparent();
            settings.shadow_size = 256;
            settings.sky_shadows = sky_shadows;
            settings.samples = 4;
            const Drawn first = drawn(scene, named.camera, settings, {.isa = Isa::scalar});
            INFO(named.name << ", sky shadows " << sky_shadows);
            for (const Isa isa : test::available_isas()) {
                const Drawn d = drawn(scene, named.camera, settings, {.tile_size = 32, .isa = isa});
                CHECK(d.codes == first.codes);
                CHECK(d.linear == first.linear);
            }
            Settings part = settings;
            part.region = {40, 100, 90, 77};
            std::vector<std::uint8_t> codes(std::size_t{4} * 90 * 77);
            REQUIRE(render(scene, named.camera, part, {.width = kSize, .height = kSize, .pixels = codes.data(), .region_alone = true}));
            bool same = true;
            for (std::size_t y = 0; y < 77; ++y)
                same &= std::equal(&codes[y * 360], &codes[y * 360] + 360, &first.codes[4 * ((y + 100) * kSize + 40)]);
            CHECK(same);
            settings.shading.accuracy = Accuracy::reference;
            const Drawn truth = drawn(scene, named.camera, settings);
            double worst = 0;
            for (std::size_t i = 3; i < truth.linear.size(); i += 4)
                worst = std::max(worst, std::fabs(static_cast<double>(truth.linear[i]) - static_cast<double>(first.linear[i])));
            CHECK(worst < 2e-3);
        }
}

TEST_CASE("ground: views, exposure and other objects are those without it", "[raster][ground]") {
    Scene bare = box_scene(1), scene = bare;
    add_ground(scene, scene_bounds(scene));
    const auto same_bounds = [](const Bounds& a, const Bounds& b) { return a.min == b.min && a.max == b.max && a.empty == b.empty; };
    CHECK(same_bounds(scene_bounds(scene), scene_bounds(bare)));
    const auto prepared = PreparedScene::make(scene);
    REQUIRE(prepared);
    CHECK(same_bounds(prepared->bounds(), scene_bounds(bare)));
    const AutoSetup with = set_up(scene, kSize, kSize), without = set_up(bare, kSize, kSize);
    CHECK(with.camera == without.camera);
    CHECK(with.settings.exposure == without.settings.exposure);
    Settings settings = with.settings;
    settings.background_linear = {0, 0, 0, 0};
    const Drawn a = drawn(scene, with.camera, settings), b = drawn(bare, with.camera, settings);
    int opaque = 0;
    for (std::size_t i = 0; i < a.codes.size(); i += 4) {
        if (b.linear[i + 3] != 1.0f) continue;
        ++opaque;
        CHECK(std::equal(&a.linear[i], &a.linear[i] + 4, &b.linear[i]));
    }
    CHECK(opaque > 1000);
}

TEST_CASE("ground: it is not seen from below, nor without light, and an empty scene may have one", "[raster][ground]") {
    Scene scene = box_scene(1);
    scene.lights.push_back(sun_from({0.6f, -0.8f, 0}, {1, 1, 1}));
    add_ground(scene, scene_bounds(scene));
    Camera below = from_above();
    below.world_from_camera = look_at({0, -5, 0.01f}, {0, 0, 0});
    Scene alone = scene;
    alone.instances.erase(alone.instances.begin());
    for (const float v : drawn(alone, below, transparent()).linear) CHECK_FALSE(v != 0.0f);
    scene.lights.clear();
    const Drawn dark = drawn(scene, from_above(), transparent());
    CHECK(dark.linear[3] == 0.0f);
    Scene empty;
    add_ground(empty, scene_bounds(empty));
    CHECK(scene_bounds(empty).empty);
    const AutoSetup setup = set_up(empty, kSize, kSize);
    for (const float v : drawn(empty, setup.camera, transparent()).linear) CHECK_FALSE(v != 0.0f);
}
