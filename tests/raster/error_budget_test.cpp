// Errors that are promised before drawing, and measured afterwards against the exact picture.
#include "shading/reference/reference.hpp"
#include "tests/raster/random_trial.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;

namespace {

constexpr int kWidth = kTrialWidth, kHeight = kTrialHeight;

struct Picture {
    std::vector<float> linear = std::vector<float>(std::size_t{4} * kWidth * kHeight);
    RenderReport report;
};

Picture draw(const Trial& trial, Accuracy accuracy, double codes) {
    Picture picture;
    Settings settings = trial.settings;
    settings.shading.accuracy = accuracy;
    settings.shading.max_error_codes = codes;
    const auto report = render(trial.scene, trial.camera, settings, {kWidth, kHeight, nullptr, picture.linear.data()});
    INFO((report ? "" : report.error().message));
    REQUIRE(report);
    picture.report = *report;
    return picture;
}

double largest_codes(const Picture& a, const Picture& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.linear.size(); ++i) {
        if (i % 4 == 3) continue;
        const double error = shading::reference::srgb_code(static_cast<double>(a.linear[i])) -
                             shading::reference::srgb_code(static_cast<double>(b.linear[i]));
        most = std::max(most, std::fabs(error));
    }
    return most;
}

}  // namespace

namespace {

/// Draws `count` random scenes, from `first_seed` on, each with a budget and without one.
void check_budgets(std::uint32_t first_seed, std::uint32_t count) {
    const double budgets[] = {0.1, 0.25, 0.5, 1, 2, 4, 8};
    int spent = 0;
    double most_used = 0;
    std::vector<double> ratios;  // bound / measured
    for (std::uint32_t seed = first_seed; seed < first_seed + count; ++seed) {
        const Trial trial = random_trial(seed);
        const Picture exact = draw(trial, Accuracy::exact, 0);
        const double budget = budgets[seed % 7];
        const Picture picture = draw(trial, Accuracy::exact, budget);
        const double measured = largest_codes(picture, exact);
        const ErrorBound& error = picture.report.error;
        INFO("seed " << seed << ", budget " << budget << ", bound " << error.codes << " = rounding " << error.rounding << " + lobes "
                     << error.lobes << " + specular " << error.specular << " + environment " << error.environment << " + left out "
                     << error.left_out << ", measured " << measured << ", lights " << trial.scene.lights.size());
        CHECK(error.budget == budget);
        CHECK(error.codes <= budget);
        CHECK(measured <= error.codes);
        if (error.codes == 0) continue;
        ++spent;
        most_used = std::max(most_used, measured / error.codes);
        if (measured > 0) ratios.push_back(error.codes / measured);
    }
    REQUIRE(!ratios.empty());
    std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2), ratios.end());
    WARN("budgets spent: " << spent << ", the most of a bound that was used " << most_used << ", median of bound / measured "
                           << ratios[ratios.size() / 2]);
    CHECK(spent >= static_cast<int>(count) / 2);
    CHECK(most_used > 0.01);
}

}  // namespace

TEST_CASE("error budget: every one is kept, and no random scene exceeds the promised error", "[raster][budget]") { check_budgets(1, 84); }

TEST_CASE("error budget: none of many random scenes exceeds the promised error", "[raster][budget][deep]") { check_budgets(85, 500); }
