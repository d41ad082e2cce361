// The setting normal_scale: normal maps as strong as it says, by all ways to draw.
#include "halflit/renderer.hpp"
#include "tests/raster/test_scenes.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace halflit;
using namespace halflit::raster::test;

namespace {

constexpr int kWidth = 96, kHeight = 64;

std::vector<float> draw(const Scene& scene, const Camera& camera, const Settings& settings) {
    std::vector<float> linear(std::size_t{4} * kWidth * kHeight);
    REQUIRE(render(scene, camera, settings, {kWidth, kHeight, nullptr, linear.data()}));
    return linear;
}

}  // namespace

TEST_CASE("normal scale: it is a factor on the scales of all materials, and 0 is no normal map", "[raster][settings]") {
    const NamedScene named = GENERATE(materials_scene(), coats_scene());
    Settings settings;
    const std::vector<float> usual = draw(named.scene, named.camera, settings);
    settings.shading.normal_scale = 0.5f;
    const std::vector<float> half = draw(named.scene, named.camera, settings);
    Scene scaled = named.scene, without = named.scene;
    for (Material& material : scaled.materials) material.normal_scale *= 0.5f, material.clearcoat_normal_scale *= 0.5f;
    for (Material& material : without.materials)
        material.textures[TextureSlot::normal] = material.textures[TextureSlot::clearcoat_normal] = {};
    CHECK(half == draw(scaled, named.camera, Settings{}));
    CHECK(half != usual);
    settings.shading.normal_scale = 0;
    CHECK(draw(named.scene, named.camera, settings) == draw(without, named.camera, Settings{}));
    for (const float scale : {0.0f, 0.5f, 2.0f}) {
        settings.shading.normal_scale = scale;
        settings.shading.accuracy = Accuracy::exact;
        const std::vector<float> exact = draw(named.scene, named.camera, settings);
        settings.shading.accuracy = Accuracy::reference;
        const std::vector<float> reference = draw(named.scene, named.camera, settings);
        double most = 0;
        for (std::size_t i = 0; i < exact.size(); ++i) most = std::max(most, std::fabs(double{exact[i]} - double{reference[i]}));
        CHECK(most < 1e-3);
    }
}
