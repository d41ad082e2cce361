// Light that is divided in another way among lights gives the same picture.
#include "tests/raster/metamorphic_scene.hpp"

#include "tests/support/catch.hpp"

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;

namespace {

constexpr int kScenes = 100;

/// Largest difference of light relative to the light itself, over all pixels and colours.
double largest_relative_difference(const Pixels& a, const Pixels& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.linear.size(); ++i) {
        const double x = a.linear[i], y = b.linear[i], sum = std::max(std::abs(x), std::abs(y));
        if (sum > 1e-30) largest = std::max(largest, std::abs(x - y) / sum);
    }
    return largest;
}

int largest_code_difference(const Pixels& a, const Pixels& b) {
    int largest = 0;
    for (std::size_t i = 0; i < a.rgba8.size(); ++i) largest = std::max(largest, std::abs(a.rgba8[i] - b.rgba8[i]));
    return largest;
}

/// Light at vertices and in the middle of triangles is interpolated, which adds roundings of its own.
Shot lit_at_pixels(std::uint64_t seed) {
    Shot shot = separate_bodies(seed);
    shot.settings.shading.rate = ShadingRate::pixel;
    return shot;
}

}  // namespace

TEST_CASE("metamorphic: each light split in two halves gives the same light but for the rounding of sums", "[raster][metamorphic]") {
    // Halving is exact, so the terms are the same, each cut in two. They are at least 0: a sum of m of them is right to m 2^-24. So the
    // sums of n and of 2 n terms, and of ambient light, are at most (3 n + 2) 2^-24 apart; what is done with either sum later adds some
    // roundings.
    for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
        Shot shot = lit_at_pixels(seed);
        const Pixels whole = draw(shot);
        std::vector<Light> halves;
        for (Light light : shot.scene.lights) {
            light.color_linear = light.color_linear * 0.5f;
            halves.insert(halves.end(), 2, light);
        }
        const auto lights = static_cast<double>(shot.scene.lights.size());
        shot.scene.lights = halves;
        const Pixels split = draw(shot);
        INFO("seed " << seed << ", lights " << lights);
        CHECK(largest_relative_difference(whole, split) <= (3 * lights + 4) * 0x1p-24);  // measured: 3 n + 0.1
        CHECK(largest_code_difference(whole, split) <= 1);
    }
}

TEST_CASE("metamorphic: lights in another order give the same light but for the rounding of sums", "[raster][metamorphic]") {
    // Two sums of n terms, each right to n 2^-24.
    for (std::uint64_t seed = 101; seed <= 100 + kScenes; ++seed) {
        Shot shot = lit_at_pixels(seed);
        const Pixels before = draw(shot);
        std::reverse(shot.scene.lights.begin(), shot.scene.lights.end());
        const auto lights = static_cast<double>(shot.scene.lights.size());
        const Pixels after = draw(shot);
        INFO("seed " << seed << ", lights " << lights);
        CHECK(largest_relative_difference(before, after) <= (2 * lights + 4) * 0x1p-24);  // measured: 2 n + 0.3
        CHECK(largest_code_difference(before, after) <= 1);
    }
}

TEST_CASE("metamorphic: exposure 2^k and lights 2^k as bright give the same bits", "[raster][metamorphic]") {
    for (std::uint64_t seed = 201; seed <= 200 + kScenes; ++seed)
        for (const int k : {-4, 3}) {
            Shot shot = lit_at_pixels(seed);
            const float factor = std::ldexp(1.0f, k);
            Shot brighter = shot;
            shot.settings.exposure = factor;
            for (Light& light : brighter.scene.lights) light.color_linear = light.color_linear * factor;
            brighter.scene.ambient.sky_linear = shot.scene.ambient.sky_linear * factor;
            brighter.scene.ambient.ground_linear = shot.scene.ambient.ground_linear * factor;
            for (std::size_t i = 0; i < shot.scene.materials.size(); ++i) {
                // The colour of unlit materials is light of its own.
                shot.scene.materials[i].unlit = brighter.scene.materials[i].unlit = false;
                brighter.scene.materials[i].emissive = shot.scene.materials[i].emissive * factor;
            }
            INFO("seed " << seed << ", 2^" << k);
            CHECK(differing(draw(shot), draw(brighter)) == 0);
        }
}

TEST_CASE("metamorphic: a light without light, and one out of reach, change no bit", "[raster][metamorphic]") {
    for (std::uint64_t seed = 301; seed <= 300 + kScenes; ++seed) {
        Random random(seed);
        Shot shot = lit_at_pixels(seed);
        const Pixels before = draw(shot);
        Light black = random_light(random), far = random_light(random);
        black.color_linear = {0, 0, 0};
        far.type = LightType::point;
        far.position_ws = {0, 1000, 0};
        far.range = 900;
        std::vector<Light>& lights = shot.scene.lights;
        lights.insert(lights.begin() + random.index(static_cast<int>(lights.size()) + 1), {black, far});
        INFO("seed " << seed);
        CHECK(differing(before, draw(shot)) == 0);
    }
}
