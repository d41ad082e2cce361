// Regions of pictures with every feature, chosen at random, against the crop of the whole picture.
#include "halflit/renderer.hpp"
#include "halflit/scene.hpp"
#include "tests/raster/test_scenes.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/isas.hpp"

#include <algorithm>
#include <cstring>
#include <random>

using namespace halflit;

namespace {

constexpr int kWidth = 120, kHeight = 90, kPictures = 50, kRegionsEach = 20;

struct Random {
    std::mt19937 engine{20};
    int below(int n) { return static_cast<int>(engine() % static_cast<unsigned>(n)); }
    bool one_in(int n) { return below(n) == 0; }
    template <class T, std::size_t N>
    T pick(const T (&from)[N]) {
        return from[below(static_cast<int>(N))];
    }
};

/// Every setting that decides pixels, at random.
Settings random_settings(Random& random) {
    Settings settings;
    settings.samples = random.pick({1, 4, 8, 16});
    if (random.one_in(2)) settings.background_linear = {0.1f, 0.2f, 0.3f, 1.0f};
    settings.tone_curve = random.pick({ToneCurve::none, ToneCurve::reinhard, ToneCurve::aces, ToneCurve::neutral});
    settings.shadows = random.pick({ShadowMode::off, ShadowMode::hard, ShadowMode::soft_split, ShadowMode::soft_split});
    settings.shadow_size = 128;
    settings.sky_shadows = random.one_in(3) ? 16 : random.one_in(2) ? kSkyShadowsAuto : 0;
    settings.soft_shadow_maps = 4 + random.below(5);
    settings.shadow_terminator_offset = random.one_in(6);
    ShadingSettings& shading = settings.shading;
    if (random.one_in(2)) shading.lobe = Lobe::sloan(0.4f);
    shading.specular = random.pick({SpecularModel::none, SpecularModel::phong, SpecularModel::blinn, SpecularModel::ggx});
    shading.anisotropy = random.pick({1, 4, 16});
    if (random.one_in(4))
        shading.max_error_codes = 3;
    else
        shading.rate = random.pick({ShadingRate::pixel, ShadingRate::pixel, ShadingRate::gouraud, ShadingRate::flat});
    return settings;
}

Scene random_scene(Random& random, const raster::test::NamedScene& named) {
    Scene scene = named.scene;
    if (random.one_in(2)) {
        scene.lights.clear();
        add_studio(scene, named.camera);
    }
    if (random.one_in(2)) add_ground(scene, scene_bounds(scene));
    for (std::size_t i = 0; i < scene.lights.size() && i < 2; ++i)
        if (random.one_in(2)) scene.lights[i].shadow_radius = 0.05f;
    return scene;
}

struct Pixels {
    std::vector<std::uint8_t> codes;
    std::vector<float> linear, depth;
};

Pixels drawn(const Scene& scene, const Camera& camera, const Settings& settings, const Execution& execution) {
    const bool whole = settings.region.width == 0;
    const int width = whole ? kWidth : settings.region.width, height = whole ? kHeight : settings.region.height;
    const auto count = static_cast<std::size_t>(width * height);
    Pixels out{std::vector<std::uint8_t>(4 * count), std::vector<float>(4 * count), std::vector<float>(count)};
    Target target{.width = kWidth, .height = kHeight, .pixels = out.codes.data(), .linear = out.linear.data(), .region_alone = true};
    target.depth = out.depth.data();
    REQUIRE(render(scene, camera, settings, target, execution));
    return out;
}

}  // namespace

TEST_CASE("regions: a thousand of them, in pictures with random features, have the bits of the whole picture", "[raster][regions]") {
    Random random;
    const auto scenes = raster::test::all_scenes();
    const auto isas = test::available_isas();
    for (int picture = 0; picture < kPictures; ++picture) {
        const auto& named = scenes[static_cast<std::size_t>(picture) % scenes.size()];
        const Scene scene = random_scene(random, named);
        Settings settings = random_settings(random);
        const Pixels whole = drawn(scene, named.camera, settings, {.threads = 1});
        for (int i = 0; i < kRegionsEach; ++i) {
            Region& r = settings.region;
            r.x = random.below(kWidth), r.y = random.below(kHeight);
            r.width = 1 + random.below(kWidth - r.x), r.height = 1 + random.below(kHeight - r.y);
            const Isa isa = isas[static_cast<std::size_t>(random.below(static_cast<int>(isas.size())))];
            const Pixels part =
                drawn(scene, named.camera, settings, {.threads = 1 + i % 2, .tile_size = random.pick({16, 32, 64}), .isa = isa});
            int wrong = 0;
            for (int y = 0; y < r.height; ++y)
                for (int x = 0; x < r.width; ++x) {
                    const auto there = static_cast<std::size_t>((r.y + y) * kWidth + r.x + x),
                               here = static_cast<std::size_t>(y * r.width + x);
                    wrong += !std::equal(&part.codes[4 * here], &part.codes[4 * here] + 4, &whole.codes[4 * there]) ||
                             std::memcmp(&part.linear[4 * here], &whole.linear[4 * there], 4 * sizeof(float)) != 0 ||
                             std::memcmp(&part.depth[here], &whole.depth[there], sizeof(float)) != 0;
                }
            INFO(named.name << ", picture " << picture << ", region " << r.x << "," << r.y << "," << r.width << "," << r.height << ", "
                            << isa_name(isa));
            CHECK(wrong == 0);
        }
        settings.region = {};
    }
}
