// Cost of many lights: it grows with the lights that reach a block of fragments, not with the number of lights.
#include "halflit/renderer.hpp"
#include "raster/built_in/hall_of_lamps.hpp"
#include "tests/support/setup.hpp"

#include "tests/support/catch.hpp"

#include <vector>

using namespace halflit;
using namespace halflit::raster;

namespace {

constexpr int kWidth = 480, kHeight = 270;

struct Outcome {
    double pairs = 0;  ///< pairs of light and fragment, divided by the number of fragments
    RenderReport report;
    std::vector<float> linear = std::vector<float>(std::size_t{4} * kWidth * kHeight);
};

Outcome draw(const Scene& scene, double codes, int tile_size = 64) {
    Outcome out;
    halflit::test::Setup settings;
    settings.shadows = ShadowMode::off;
    settings.execution.tile_size = tile_size;
    settings.shading.max_error_codes = codes;
    const auto report = render(scene, scene.cameras.at(0), settings, {kWidth, kHeight, nullptr, out.linear.data()}, settings.execution);
    REQUIRE(report);
    out.report = *report;
    std::uint64_t pairs = 0;
    for (const std::uint64_t lanes : report->work.light_lanes) pairs += lanes;
    out.pairs = static_cast<double>(pairs) / static_cast<double>(report->fragments_shaded);
    return out;
}

}  // namespace

TEST_CASE("many lights: with a range, pairs of light and fragment do not grow with lights beyond the picture", "[raster][lights]") {
    // On average, a point of the floor lies within the range of pi (3^2 - 0.8^2) / 2^2 = 6.6 lights.
    constexpr double kInRange = 6.6;
    const double few = draw(lights_scene(64, true), 0).pairs;
    INFO("64 lights: " << few << " pairs a fragment");
    CHECK(few > 0.8 * kInRange);
    CHECK(few < 2 * kInRange);
    for (const int lights : {256, 1024}) {
        const Scene scene = lights_scene(lights, true);
        const Outcome exact = draw(scene, 0), budget = draw(scene, 0.5);
        INFO(lights << " lights: " << exact.pairs << " pairs a fragment, " << budget.pairs << " within half a code");
        CHECK(exact.pairs >= few);
        CHECK(exact.pairs < 1.25 * few);  // with more lights, the outermost fragments get their full number too
        CHECK(budget.pairs <= exact.pairs);
    }
    CHECK(draw(lights_scene(256, true), 0).pairs == Approx(draw(lights_scene(1024, true), 0).pairs).epsilon(0.02));
}

TEST_CASE("many lights: lights beyond the picture add nothing and leaving them out changes no pixel", "[raster][lights]") {
    CHECK(draw(lights_scene(1024, true), 0).linear == draw(lights_scene(400, true), 0, 16).linear);
}
