// Tiers on whole pictures: differences of display and fast from exact.
#include "halflit/renderer.hpp"
#include "shading/reference/reference.hpp"
#include "tests/raster/random_trial.hpp"
#include "tests/raster/test_scenes.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;
using shading::PowTier;

namespace {

constexpr int kWidth = 320, kHeight = 240;

struct Picture {
    std::vector<std::uint8_t> codes = std::vector<std::uint8_t>(std::size_t{4} * kWidth * kHeight);
    std::vector<float> linear = std::vector<float>(std::size_t{4} * kWidth * kHeight);
};

Picture draw(const Scene& scene, const Camera& camera, Settings settings, Accuracy accuracy) {
    Picture picture;
    settings.shading.accuracy = accuracy;
    const auto report = render(scene, camera, settings, {kWidth, kHeight, picture.codes.data(), picture.linear.data()});
    INFO((report ? "" : report.error().message));
    REQUIRE(report);
    return picture;
}

struct Difference {
    std::int64_t channels = 0, other_codes = 0;
    int codes = 0;         ///< largest, of the 8-bit picture
    double unrounded = 0;  ///< largest, before rounding to codes

    void add(const Picture& a, const Picture& b) {
        for (std::size_t i = 0; i < a.codes.size(); ++i) {
            if (i % 4 == 3) continue;
            const int apart = std::abs(a.codes[i] - b.codes[i]);
            ++channels;
            other_codes += apart != 0;
            codes = std::max(codes, apart);
            const double x = a.linear[i], y = b.linear[i];
            if (x == y || (std::isnan(x) && std::isnan(y))) continue;
            unrounded = std::max(unrounded, std::fabs(shading::reference::srgb_code(x) - shading::reference::srgb_code(y)));
        }
    }
    [[nodiscard]] double share() const { return static_cast<double>(other_codes) / static_cast<double>(channels); }
};

/// Codes by which the tier's polynomials alone can move any colour. A part of the light with a relative error r moves the code of the sum
/// by at most 112 ln(1 + r). For t^n, r follows from the power. For a highlight K e^-z, r is the error of 2^x plus z times that of log2; z
/// = ln(K / v), where v is white.
double bound_codes(const Scene& scene, PowTier tier, double peak) {
    double power = 1.0;
    for (const Material& material : scene.materials) power = std::max(power, static_cast<double>(material.lobe.power));
    const shading::PowErrors errors = shading::pow_errors(tier);
    const double lobe = 0.35 * (power - 1.0) * errors.log2 + errors.exp2, highlight = errors.exp2 + errors.log2 * std::log(peak);
    return 112.2 * (std::log1p(lobe) + std::log1p(highlight) + 1e-5);
}

Settings usual_settings() {
    Settings settings;
    settings.shadow_size = 256;
    settings.background_linear = {0.02f, 0.05f, 0.1f, 1};
    return settings;
}

}  // namespace

TEST_CASE("tiers: display is at most one code from exact, in few places, and fast is within its polynomials' bound", "[raster][accuracy]") {
    Difference display_all, fast_all;
    for (const NamedScene& s : all_scenes()) {
        const Picture exact = draw(s.scene, s.camera, usual_settings(), Accuracy::exact);
        // Peak of the brightest highlight, in units of display white: 1e4 by normalisation at roughness 0.07, times the light of a lamp 0.1
        // away. The colours of the rough scene go up to the largest float.
        const double peak = s.name == "rough" ? 1e40 : 1e6;
        Difference display, fast;
        display.add(draw(s.scene, s.camera, usual_settings(), Accuracy::display), exact);
        fast.add(draw(s.scene, s.camera, usual_settings(), Accuracy::fast), exact);
        INFO(s.name << ": display " << display.codes << " codes, " << display.unrounded << " unrounded, " << 100 * display.share()
                    << " % of the channels; fast " << fast.codes << ", " << fast.unrounded << ", " << 100 * fast.share() << " %");
        CHECK(display.codes <= 1);
        CHECK(display.unrounded <= bound_codes(s.scene, PowTier::display, peak));
        CHECK(fast.unrounded <= bound_codes(s.scene, PowTier::fast, peak));
        for (auto& [all, one] : {std::pair{&display_all, &display}, std::pair{&fast_all, &fast}}) {
            all->channels += one->channels;
            all->other_codes += one->other_codes;
            all->codes = std::max(all->codes, one->codes);
            all->unrounded = std::max(all->unrounded, one->unrounded);
        }
    }
    WARN("display: " << display_all.codes << " codes, " << display_all.unrounded << " unrounded, in " << 100 * display_all.share()
                     << " % of the channels; fast: " << fast_all.codes << ", " << fast_all.unrounded << ", " << 100 * fast_all.share()
                     << " %");
    CHECK(display_all.share() < 1e-4);
    CHECK(display_all.other_codes < fast_all.other_codes);
    CHECK(fast_all.other_codes > 0);
}

TEST_CASE("tiers: display is at most one code from exact, and fast within its bound, in random scenes", "[raster][accuracy]") {
    Difference display_all, fast_all;
    for (std::uint32_t seed = 1001; seed <= 1040; ++seed) {
        const Trial trial = random_trial(seed);
        const Picture exact = draw(trial.scene, trial.camera, trial.settings, Accuracy::exact);
        Difference display, fast;
        display.add(draw(trial.scene, trial.camera, trial.settings, Accuracy::display), exact);
        fast.add(draw(trial.scene, trial.camera, trial.settings, Accuracy::fast), exact);
        INFO("seed " << seed << ": display " << display.codes << " codes, " << display.unrounded << " unrounded; fast " << fast.codes
                     << ", " << fast.unrounded);
        CHECK(display.codes <= 1);
        // Light is up to 1e5 times white, and highlights multiply it by up to 5e2.
        CHECK(display.unrounded <= bound_codes(trial.scene, PowTier::display, 1e8));
        CHECK(fast.unrounded <= bound_codes(trial.scene, PowTier::fast, 1e8));
        display_all.unrounded = std::max(display_all.unrounded, display.unrounded);
        fast_all.unrounded = std::max(fast_all.unrounded, fast.unrounded);
        display_all.other_codes += display.other_codes;
        display_all.channels += display.channels;
        fast_all.other_codes += fast.other_codes;
        fast_all.channels += fast.channels;
    }
    WARN("display: " << display_all.unrounded << " codes before rounding, other codes in " << 100 * display_all.share()
                     << " % of the channels; fast: " << fast_all.unrounded << ", " << 100 * fast_all.share() << " %");
    CHECK(fast_all.unrounded > display_all.unrounded);
}
