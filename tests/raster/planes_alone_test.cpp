// Planes without colours: the same bytes as beside colours, without shading and without shadow maps.
#include "halflit/renderer.hpp"
#include "tests/raster/test_scenes.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cstring>

using namespace halflit;
using namespace halflit::raster::test;

namespace {

constexpr int kWidth = 96, kHeight = 72;

struct AllPlanes {
    static constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;
    std::vector<std::uint8_t> codes = std::vector<std::uint8_t>(4 * kPixels);
    std::vector<float> floats = std::vector<float>(14 * kPixels, 5.0f);
    std::vector<std::uint32_t> numbers = std::vector<std::uint32_t>(3 * kPixels, 5u);
    RenderReport report;

    AllPlanes(const Scene& scene, const Camera& camera, const Settings& settings, bool colors, bool surface = true) {
        Target target{kWidth, kHeight, colors ? codes.data() : nullptr};
        target.depth = &floats[0], target.coverage = &floats[kPixels];
        target.instance = &numbers[0], target.triangle = &numbers[kPixels];
        if (surface) {
            target.normal = &floats[2 * kPixels], target.shading_normal = &floats[5 * kPixels];
            target.albedo = &floats[8 * kPixels], target.position = &floats[11 * kPixels];
            target.lights = &numbers[2 * kPixels];
        }
        auto drawn = render(scene, camera, settings, target);
        INFO((drawn ? "" : drawn.error().message));
        REQUIRE(drawn);
        report = *drawn;
    }
    /// The bits are equal, NaN included.
    [[nodiscard]] bool same(const AllPlanes& other) const {
        return std::memcmp(floats.data(), other.floats.data(), floats.size() * sizeof(float)) == 0 && numbers == other.numbers;
    }
};

}  // namespace

TEST_CASE("planes: without colours they are the same, and nothing is shaded", "[raster][planes]") {
    for (const NamedScene& named : all_scenes())
        for (const int samples : {1, 4, 8})
            for (const int mode : {0, 1, 2, 3}) {
                Settings settings;
                settings.samples = samples;
                settings.shading.rate = mode == 1 ? ShadingRate::gouraud : mode == 2 ? ShadingRate::flat : ShadingRate::pixel;
                if (mode == 3) settings.shading.max_error_codes = 2;
                const AllPlanes with(named.scene, named.camera, settings, true), alone(named.scene, named.camera, settings, false);
                CAPTURE(named.name, samples, mode);
                CHECK(alone.same(with));
                CHECK(alone.report.fragments_shaded == 0);
                CHECK(alone.report.work.light_lanes == WorkCounts{}.light_lanes);
                CHECK(alone.report.work.shadow_lookup_lanes == 0);
                if (alone.report.work.alpha_test_lanes == 0) CHECK(alone.report.work == WorkCounts{});  // masks are read all the same
                CHECK(alone.report.nan_pixels == 0);
                CHECK(alone.report.pixels_visible == with.report.pixels_visible);
                const AllPlanes few(named.scene, named.camera, settings, false, false);
                CHECK(std::equal(few.floats.begin(), few.floats.begin() + 2 * AllPlanes::kPixels, with.floats.begin()));
                CHECK(std::equal(few.numbers.begin(), few.numbers.begin() + 2 * AllPlanes::kPixels, with.numbers.begin()));
            }
}

TEST_CASE("planes: without colours no shadow map is drawn", "[raster][planes]") {
    const NamedScene named = many_lights_scene();
    Settings settings;
    settings.shadow_size = 2048;
    const AllPlanes with(named.scene, named.camera, settings, true), alone(named.scene, named.camera, settings, false);
    CHECK(with.report.ms.shadows > 0);
    CHECK(alone.report.ms.shadows < 0.5);  // a lap of the clock
    CHECK(alone.report.ms.shadows < with.report.ms.shadows);
}
