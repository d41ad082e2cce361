// Coats, sheen and films in whole frames: against the float64 reference, within promised errors, and the same bits in any way to draw.
#include "halflit/renderer.hpp"
#include "shading/reference/reference.hpp"
#include "tests/raster/random_trial.hpp"
#include "tests/raster/test_scenes.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace halflit;
using namespace halflit::raster::test;

namespace {

constexpr int kWidth = 96, kHeight = 64;

struct Picture {
    std::vector<float> linear;
    ErrorBound error;
};

Picture draw(const Scene& scene, const Camera& camera, const Settings& settings, const Execution& execution = {}) {
    Picture picture{std::vector<float>(std::size_t{4} * kWidth * kHeight), {}};
    const auto report = render(scene, camera, settings, {kWidth, kHeight, nullptr, picture.linear.data()}, execution);
    REQUIRE(report);
    picture.error = report->error;
    return picture;
}

/// Largest difference of two pictures, in codes.
double largest_codes(const Picture& a, const Picture& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.linear.size(); ++i)
        most = std::max(most,
                        std::fabs(shading::reference::srgb_code(double{a.linear[i]}) - shading::reference::srgb_code(double{b.linear[i]})));
    return most;
}

/// Gives the materials of a trial layers above their base.
void add_layers(Trial& trial, std::uint32_t seed) {
    Numbers make(seed + 9000);
    for (Material& material : trial.scene.materials) {
        if (make.below(4) != 0)
            material.clearcoat = make.below(2) == 0 ? 1.0f : make.in(0, 1), material.clearcoat_roughness = make.in(0.15f, 1);
        if (make.below(2) == 0) material.sheen_color = make.color(1), material.sheen_roughness = make.in(0.2f, 1);
        if (make.below(3) == 0) material.iridescence = make.in(0, 1), material.iridescence_thickness_max_nm = make.in(10, 700);
        if (make.below(3) == 0) material.anisotropy_strength = make.in(0, 1), material.anisotropy_rotation_rad = make.in(-4, 4);
        if (make.below(4) == 0) material.emissive = make.color(0.5f);
        if (trial.scene.textures.empty() || make.below(2) == 0) continue;
        material.textures[TextureSlot::clearcoat_normal].texture = material.textures[TextureSlot::normal].used() ? 0 : -1;
    }
}

}  // namespace

TEST_CASE("layers: coats and sheen are as accuracy reference computes them, with lights, shadows, skies and normal maps",
          "[raster][layers]") {
    double worst = 0;
    for (std::uint32_t seed = 1; seed <= 16; ++seed) {
        Trial trial = random_trial(seed);
        add_layers(trial, seed);
        trial.settings.shading.specular = static_cast<SpecularModel>(1 + seed % 3);
        if (trial.settings.shading.specular == SpecularModel::ggx)
            for (Material& m : trial.scene.materials)
                m.roughness = std::max(m.roughness, 0.3f), m.clearcoat_roughness = std::max(m.clearcoat_roughness, 0.3f);
        if (seed % 8 == 0) trial.settings.sky_shadows = 32;
        if (seed % 8 == 4) trial.settings.sky_shadows = kSkyShadowsAuto;
        const Picture exact = draw(trial.scene, trial.camera, trial.settings);
        trial.settings.shading.accuracy = Accuracy::reference;
        const double apart = largest_codes(exact, draw(trial.scene, trial.camera, trial.settings));
        INFO("seed " << seed);
        CHECK(apart < 0.1);
        worst = std::max(worst, apart);
    }
    INFO("worst " << worst);
    CHECK(worst > 0);
}

TEST_CASE("layers: no random scene with coats and sheen exceeds the promised error", "[raster][layers][budget]") {
    const double budgets[] = {0.25, 0.5, 1, 2};
    int within = 0;
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        Trial trial = random_trial(seed);
        add_layers(trial, seed);
        const Settings exact = trial.settings;
        trial.settings.shading.max_error_codes = budgets[seed % 4];
        const Picture picture = draw(trial.scene, trial.camera, trial.settings);
        const double measured = largest_codes(picture, draw(trial.scene, trial.camera, exact));
        INFO("seed " << seed << ", bound " << picture.error.codes << ", budget " << picture.error.budget << ", measured " << measured);
        CHECK(measured <= picture.error.codes);
        within += picture.error.codes > 0;
    }
    CHECK(within >= 5);
}

TEST_CASE("layers: with light at vertices or triangles, layers are lit as with light at pixels where nothing changes", "[raster][layers]") {
    // A plane under a directional light, seen from far away: light is the same at every vertex and pixel.
    Scene scene;
    Material material;
    material.metallic = 0, material.base_color = {0.25f, 0.5f, 0.75f, 1};
    material.clearcoat = 0.75f, material.clearcoat_roughness = 0.6f;
    material.sheen_color = {0.5f, 0.4f, 0.3f}, material.sheen_roughness = 0.5f;
    scene.materials.push_back(material);
    scene.meshes.push_back(make_plane(4, 2));
    scene.meshes[0].material = 0;
    scene.instances.push_back({0, {}});
    scene.lights.push_back({.direction_ws = {-0.2f, -1, -0.3f}});
    scene.ambient = {{0.4f, 0.5f, 0.6f}, {0.1f, 0.1f, 0.1f}};
    Camera camera;
    camera.world_from_camera = {{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 10, 0, 1}}};
    camera.orthographic = true, camera.half_height = 1, camera.near_z = 0, camera.far_z = 20;
    Settings settings;
    settings.shadows = ShadowMode::off;
    const Picture want = draw(scene, camera, settings);
    for (const ShadingRate rate : {ShadingRate::flat, ShadingRate::gouraud}) {
        settings.shading.rate = rate;
        CHECK(largest_codes(draw(scene, camera, settings), want) < 1e-3);
    }
    CHECK(want.linear[0] > 0.1f);
}

TEST_CASE("layers: instruction sets, threads and tiles do not show in coats and sheen", "[raster][layers]") {
    const NamedScene named = GENERATE(coats_scene(), fabrics_scene(), films_scene(), brushed_scene());
    Settings settings;
    settings.samples = 4, settings.shadow_size = 128;
    const Picture first = draw(named.scene, named.camera, settings);
    for (const Isa isa : halflit::test::available_isas()) {
        Execution execution;
        execution.isa = isa, execution.tile_size = 16 << (static_cast<int>(isa) % 3), execution.threads = 1 + static_cast<int>(isa) % 2;
        INFO(isa_name(isa));
        CHECK(draw(named.scene, named.camera, settings, execution).linear == first.linear);
    }
}
