// Error budgets are refused with settings that have no bound, and accepted with all others.
#include "halflit/renderer.hpp"
#include "halflit/shapes.hpp"
#include "raster/frame_plan.hpp"
#include "tests/support/cameras.hpp"

#include "tests/support/catch.hpp"

using namespace halflit;
using namespace halflit::raster;

namespace {

constexpr ShadingRate kRates[] = {ShadingRate::flat, ShadingRate::gouraud, ShadingRate::pixel};
constexpr TextureDetail kDetails[] = {TextureDetail::full, TextureDetail::bilinear, TextureDetail::nearest};
constexpr double kBudgets[] = {1e-9, 0.1, 0.5, 2.0, 255.0};

Scene lit_box() {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes.push_back(make_box({1, 1, 1}));
    scene.meshes[0].material = 0;
    scene.instances.push_back({0, {}});
    scene.lights.resize(2);
    scene.lights[1].type = LightType::point;
    scene.lights[1].position_ws = {2, 2, 2};
    return scene;
}

Result<RenderReport> drawn(ShadingRate rate, TextureDetail detail, double budget, Accuracy accuracy = Accuracy::exact) {
    const Scene scene = lit_box();
    Settings settings;
    settings.shadow_size = 64;
    settings.shading.rate = rate;
    settings.shading.texture_detail = detail;
    settings.shading.max_error_codes = budget;
    settings.shading.accuracy = accuracy;
    std::vector<std::uint8_t> pixels(4 * 20 * 15, 0xCD);
    const auto prepared = PreparedData::make(scene);
    REQUIRE(prepared);
    const Camera camera = halflit::test::camera_at({2, 3, 4}, {0, 0, 0});
    const auto report = render(scene, camera, settings, {20, 15, pixels.data(), nullptr});
    CHECK(plan_frame(*prepared, scene, camera, settings, 20, 15).has_value() == report.has_value());
    CHECK(check_settings(settings, 20, 15).has_value() == report.has_value());
    CHECK((report.has_value() || pixels == std::vector<std::uint8_t>(pixels.size(), 0xCD)));
    return report;
}

bool names(const Error& error, const char* word) { return error.message.find(word) != std::string::npos; }

}  // namespace

TEST_CASE("budget: refused with shading once a triangle or a vertex, and with coarse texture filters", "[raster][budget]") {
    for (const ShadingRate rate : kRates)
        for (const TextureDetail detail : kDetails)
            for (const double budget : kBudgets) {
                if (rate == ShadingRate::pixel && detail == TextureDetail::full) continue;
                INFO("rate " << static_cast<int>(rate) << ", filter " << static_cast<int>(detail) << ", budget " << budget);
                const auto report = drawn(rate, detail, budget);
                REQUIRE_FALSE(report);
                CHECK(report.error().code == ErrorCode::usage);
                CHECK(report.error().message.find('\n') == std::string::npos);
                CHECK(names(report.error(), "max-error"));
                if (rate == ShadingRate::pixel) CHECK(names(report.error(), "texture-filter full"));
                if (detail == TextureDetail::full) CHECK(names(report.error(), "shading pixel"));
            }
}

TEST_CASE("budget: accepted with shading at every pixel and the samplers' own texture filters", "[raster][budget]") {
    for (const double budget : kBudgets) {
        const auto report = drawn(ShadingRate::pixel, TextureDetail::full, budget);
        INFO("budget " << budget << (report ? "" : ": " + report.error().message));
        REQUIRE(report);
        CHECK(report->error.budget == budget);
        CHECK(report->error.codes <= budget);
    }
}

TEST_CASE("budget: refused with an accuracy other than exact, which would decide the same thing in another way", "[raster][budget]") {
    const auto report = drawn(ShadingRate::pixel, TextureDetail::full, 0.5, Accuracy::reference);
    REQUIRE_FALSE(report);
    CHECK(report.error().code == ErrorCode::usage);
    CHECK(names(report.error(), "max-error: cannot be combined with an accuracy other than exact"));
}

TEST_CASE("budget: without one, any rate and filter are accepted", "[raster][budget]") {
    for (const ShadingRate rate : kRates)
        for (const TextureDetail detail : kDetails) {
            const auto report = drawn(rate, detail, 0.0);
            REQUIRE(report);
            CHECK(report->error.budget == 0);
        }
}

TEST_CASE("budget: the reference shades every pixel whatever rate and filter are set", "[raster][budget]") {
    for (const ShadingRate rate : kRates)
        for (const TextureDetail detail : kDetails) CHECK(drawn(rate, detail, 0.0, Accuracy::reference));
}
