// The frame plan asks for what a material needs, and for nothing else.
#include "shading/planner.hpp"

#include "tests/support/catch.hpp"

#include <limits>

using namespace halflit;
using namespace halflit::shading;

namespace {

constexpr SlotMask kAll = 31u, kPlain = 3u;

Texture tiny(int side) {
    return Texture::from_rgba8(std::vector<std::uint8_t>(static_cast<std::size_t>(side * side * 4), 128), side, side, ColorSpace::srgb)
        .value();
}

struct Scene {
    std::vector<Material> materials{Material{}};
    std::vector<Texture> textures{tiny(4), tiny(1)};
    std::vector<Light> lights{Light{}};
    std::vector<SlotMask> available{kAll, kPlain};
    Ambient ambient;
    ShadingSettings options;
    [[nodiscard]] ShadingPlan plan() const { return plan_shading({materials, textures, available, plan_lights(lights), ambient, options}); }
    [[nodiscard]] MaterialPlan first() const { return plan().materials[0]; }
};

}  // namespace

TEST_CASE("plan: one entry a material, and the default material at the end", "[shading][plan]") {
    Scene scene;
    scene.materials = {Material{}, Material{}, Material{}};
    scene.available = {kAll, kAll, kAll, kPlain};
    const ShadingPlan plan = scene.plan();
    REQUIRE(plan.materials.size() == 4);
    CHECK(plan.materials[3].metallic == 1.0f);
    CHECK(plan.materials[3].roughness == 1.0f);
    CHECK(plan.materials[3].base_color[0] == 1.0f);
}

TEST_CASE("plan: an unlit material without texture needs no attribute at all", "[shading][plan]") {
    Scene scene;
    scene.materials[0].unlit = true;
    scene.available[0] = kPlain;
    CHECK(scene.first().slots == 0u);
    CHECK(scene.first().stages == kStageUnlit);
}

TEST_CASE("plan: a lit material needs position and normal, tangents only for a normal map", "[shading][plan]") {
    Scene scene;
    scene.available[0] = kPlain | 4u;
    CHECK(scene.first().slots == kPlain);
    scene.materials[0].textures[TextureSlot::normal].texture = 0;
    CHECK(scene.first().slots == (kPlain | 4u));
    CHECK((scene.first().stages & kStageNormalMap) != 0);
    scene.available[0] = kPlain;  // no primitive brings tangents
    CHECK((scene.first().stages & kStageNormalMap) == 0);
    CHECK(scene.first().slots == kPlain);
}

TEST_CASE("plan: vertex colours and the second coordinate set only where they exist and are used", "[shading][plan]") {
    Scene scene;
    scene.available[0] = kPlain;
    CHECK((scene.first().stages & kStageVertexColor) == 0);
    scene.available[0] = kPlain | 8u;
    CHECK((scene.first().stages & kStageVertexColor) != 0);
    CHECK(scene.first().slots == (kPlain | 8u));
    scene.materials[0].textures[TextureSlot::base_color].texture = 0;
    scene.materials[0].textures[TextureSlot::base_color].uv_set = 1;
    scene.available[0] = kPlain | 16u;
    CHECK(scene.first().slots == (kPlain | 16u));
    scene.available[0] = kPlain;  // the set is missing: read as (0, 0)
    CHECK(scene.first().slots == kPlain);
    CHECK(scene.first().textures[TextureSlot::base_color].uv_set == 0);
    CHECK(scene.first().textures[TextureSlot::base_color].row_u[0] == 0.0f);
}

TEST_CASE("plan: without light a material only emits", "[shading][plan]") {
    Scene scene;
    scene.lights.clear();
    scene.materials[0].emissive = {1, 0, 0};
    scene.materials[0].textures[TextureSlot::base_color].texture = 0;
    CHECK(scene.first().stages == 0u);
    scene.materials[0].textures[TextureSlot::emissive].texture = 1;  // one level, one filter: no gradients
    CHECK(scene.first().stages == kStageEmissiveTexture);
    CHECK(scene.first().slots == 2u);
    scene.materials[0].alpha_mode = AlphaMode::mask;  // alpha still decides what is drawn
    CHECK((scene.first().stages & kStageBaseColorTexture) != 0);
}

TEST_CASE("plan: a texture without effect is not fetched", "[shading][plan]") {
    Scene scene;
    scene.materials[0].textures[TextureSlot::emissive].texture = 0;   // emissive factor 0
    scene.materials[0].textures[TextureSlot::occlusion].texture = 0;  // no ambient light
    scene.materials[0].textures[TextureSlot::metallic_roughness].texture = 0;
    CHECK((scene.first().stages & (kStageEmissiveTexture | kStageOcclusionTexture)) == 0);
    CHECK((scene.first().stages & kStageMetallicRoughnessTexture) != 0);
    scene.options.specular = SpecularModel::none;
    CHECK((scene.first().stages & (kStageMetallicRoughnessTexture | kStageSpecular)) == 0);
    scene.ambient.sky_linear = {0.1f, 0.1f, 0.1f};
    CHECK((scene.first().stages & (kStageOcclusionTexture | kStageAmbient)) == (kStageOcclusionTexture | kStageAmbient));
    scene.materials[0].textures[TextureSlot::occlusion].texture = 7;  // there is no such texture
    CHECK((scene.first().stages & kStageOcclusionTexture) == 0);
}

TEST_CASE("plan: gradients only where a texture has levels or two filters", "[shading][plan]") {
    Scene scene;
    TextureUse& use = scene.materials[0].textures[TextureSlot::base_color];
    use.texture = 0;
    CHECK((scene.first().stages & kStageGradients) != 0);
    use.sampler.mip = MipFilter::none;
    CHECK((scene.first().stages & kStageGradients) == 0);
    use.sampler.mag = TextureFilter::nearest;
    CHECK((scene.first().stages & kStageGradients) != 0);
    use.sampler = {};
    use.texture = 1;  // 1 x 1: one level
    CHECK((scene.first().stages & kStageGradients) == 0);
}

TEST_CASE("plan: occlusion in the metallic-roughness texture is fetched once", "[shading][plan]") {
    Scene scene;
    scene.ambient.sky_linear = {1, 1, 1};
    scene.materials[0].textures[TextureSlot::metallic_roughness].texture = scene.materials[0].textures[TextureSlot::occlusion].texture = 0;
    CHECK(scene.first().occlusion_is_metallic_roughness);
    scene.materials[0].textures[TextureSlot::occlusion].sampler.wrap_u = TextureWrap::clamp;
    CHECK(!scene.first().occlusion_is_metallic_roughness);
}

TEST_CASE("plan: each power takes its cheapest lobe path", "[shading][plan]") {
    Scene scene;
    const auto path = [&](float power) {
        scene.materials[0].lobe.power = power;
        return scene.first().lobe.path;
    };
    CHECK(path(0.0f) == LobePath::step);
    CHECK(path(1.0f) == LobePath::linear);
    CHECK(path(1.5f) == LobePath::sqrt_product);
    CHECK(path(2.0f) == LobePath::square);
    CHECK(path(3.0f) == LobePath::integer);
    CHECK(path(5.0f) == LobePath::integer);
    CHECK(path(1.3f) == LobePath::general);
    CHECK(path(64.0f) == LobePath::general);
    CHECK(path(-1.0f) == LobePath::step);
    CHECK(path(std::numeric_limits<float>::quiet_NaN()) == LobePath::step);
}

TEST_CASE("plan: the lobe of the settings replaces all but those that the file chose", "[shading][plan]") {
    Scene scene;
    scene.options.lobe = Lobe::valve();
    CHECK(scene.first().lobe.path == LobePath::square);
    scene.materials[0].has_own_lobe = true;
    CHECK(scene.first().lobe.path == LobePath::linear);
}

TEST_CASE("plan: lights keep their order, black ones and those with NaN are left out", "[shading][plan]") {
    Scene scene;
    Light red, black, broken, blue;
    red.color_linear = {1, 0, 0};
    black.color_linear = {0, 0, 0};
    broken.type = LightType::point;
    broken.position_ws.x = std::numeric_limits<float>::quiet_NaN();
    blue.color_linear = {0, 0, 1};
    scene.lights = {red, black, broken, blue};
    const ShadingPlan plan = scene.plan();
    REQUIRE(plan.lights.size() == 2);
    CHECK(plan.lights[0].color[0] == 1.0f);
    CHECK(plan.lights[1].color[2] == 1.0f);
}

TEST_CASE("plan: a spot's cone is 1 - cos of its angles, also for cones of a fiftieth of a degree", "[shading][plan]") {
    Scene scene;
    scene.lights[0].type = LightType::spot;
    scene.lights[0].inner_cone_rad = 0.0f;
    for (const float degrees : {0.02f, 0.1f, 1.0f, 45.0f, 90.0f}) {
        const double angle = static_cast<double>(degrees) * 3.14159265358979323846 / 180.0;
        scene.lights[0].outer_cone_rad = static_cast<float>(angle);
        const LightPlan light = scene.plan().lights[0];
        // 1 - cos(a) = a^2/2 - a^4/24 + a^6/720 - ... for any a up to 90 degrees.
        double term = 1.0, want = 0.0;
        const auto a = static_cast<double>(scene.lights[0].outer_cone_rad);
        for (int k = 1; k < 20; ++k) {
            term *= -a * a / ((2 * k - 1) * (2 * k));
            want -= term;
        }
        CHECK(light.cone_cutoff == Approx(want).epsilon(1e-7));
        CHECK(light.cone_scale == Approx(1.0 / want).epsilon(1e-6));
    }
}
