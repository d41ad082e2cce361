// Powers by curves that are fitted to one exponent: the errors stay within those that the fits state, on every instruction set.
#include "shading/budget/power_fit.hpp"

#include "floats.hpp"
#include "lobe_curve/lobe_curve.hpp"
#include "shading/reference/reference.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <vector>

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;

namespace {

constexpr int kPoints = 4096;

/// Values of t, closer together near 0.
std::vector<float> spread() {
    std::vector<float> t(kPoints);
    for (int i = 0; i < kPoints; ++i) {
        const double at = static_cast<double>(i) / (kPoints - 1);
        t[static_cast<std::size_t>(i)] = static_cast<float>(at * at * at);
    }
    return t;
}

LobePlan curve_plan(const LobeFit& fit) {
    LobePlan plan;
    plan.path = LobePath::curve;
    std::copy_n(fit.c, kLobeCurveTerms, plan.curve);
    return plan;
}

double code(double linear) { return reference::srgb_code(std::min(linear, 1.0)); }

}  // namespace

TEST_CASE("curves: no lobe is off by more codes than its fit states, under one light or under several", "[shading][pow][curve]") {
    const std::vector<float> t = spread();
    FloatMaker make(77);
    for (const double n : {1.0001, 1.02, 1.1, 1.3, 1.4999, 1.7, 2.2, 2.5, 3.2, 4.4, 6.3})
        for (const double amplitude : {0.01, 0.3, 1.0, 5.0, 40.0}) {
            const LobeFit fit = fit_lobe(n, amplitude);
            for (const Isa isa : built_isas()) {
                if (!isa_available(isa)) continue;
                std::vector<float> f(t.size());
                lobe_curve(isa)(curve_plan(fit), t.data(), f.data(), kPoints);
                double worst = 0;
                for (std::size_t i = 0; i < t.size(); ++i) {
                    if (!(f[i] >= 0.0f)) FAIL("n = " << n << ", t = " << t[i] << ": " << f[i]);
                    const double want = amplitude * std::pow(static_cast<double>(t[i]), n);
                    worst = std::max(worst, std::fabs(code(amplitude * static_cast<double>(f[i])) - code(want)));
                }
                // Eight lights that share the amplitude, at any angles.
                for (int round = 0; round < 2000; ++round) {
                    double got = 0, want = 0;
                    for (int light = 0; light < 8; ++light) {
                        const std::size_t at = round % 2 == 0 ? make.below(kPoints) : make.below(kPoints / 4);
                        got += amplitude / 8 * static_cast<double>(f[at]);
                        want += amplitude / 8 * std::pow(static_cast<double>(t[at]), n);
                    }
                    worst = std::max(worst, std::fabs(code(got) - code(want)));
                }
                INFO(isa_name(isa) << ", n = " << n << ", amplitude " << amplitude << ": off by " << worst << ", said " << fit.codes);
                CHECK(worst <= fit.codes);
                // The bound is not far above the error.
                if (fit.codes > 0.01 && fit.codes < 50.0) CHECK(worst > 0.1 * fit.codes);
            }
        }
}

TEST_CASE("curves: the excess over the core, drawn alone, is off by no more codes than a fit made for it states", "[shading][pow][curve]") {
    const std::vector<float> t = spread();
    FloatMaker make(78);
    struct Shape {
        double w, n;
    };
    for (const Shape shape : {Shape{0.05, 1.05}, {0.2, 1.2}, {0.8, 1.8}, {1, 1.1}, {0.1, 1.7}, {0.5, 4.4}})
        for (const double amplitude : {0.05, 1.0, 8.0}) {
            const LobeFit fit = fit_lobe(shape.n, amplitude, shape.w);
            std::vector<float> f(t.size());
            lobe_curve(Isa::scalar)(curve_plan(fit), t.data(), f.data(), kPoints);
            double worst = 0;
            for (int round = 0; round < 100000; ++round) {
                // Four lights, each with a core and an excess of which shadows leave some: never less of the excess.
                double got = 0, want = 0;
                const int lights = round % 3 == 0 ? 4 : 1;
                for (int light = 0; light < lights; ++light) {
                    const std::size_t at = make.below(kPoints);
                    const double core = std::max(0.0, (1 + shape.w) * static_cast<double>(t[at]) - shape.w);
                    const double kept = make.below(3) / 2.0, kept_core = kept * make.below(3) / 2.0;
                    const auto drawn = [&](double value) {
                        return amplitude / lights * (kept_core * std::min(value, core) + kept * std::max(0.0, value - core));
                    };
                    got += drawn(static_cast<double>(f[at]));
                    want += drawn(std::pow(static_cast<double>(t[at]), shape.n));
                }
                worst = std::max(worst, std::fabs(code(got) - code(want)));
            }
            INFO("w = " << shape.w << ", n = " << shape.n << ", amplitude " << amplitude << ": off by " << worst << ", said " << fit.codes);
            CHECK(worst <= fit.codes);
            CHECK((fit.codes > 5.0 || worst > 0.1 * fit.codes));
        }
}

TEST_CASE("curves: a lobe of half-integer power is a polynomial, and other fits are accurate where budgets use them",
          "[shading][pow][curve]") {
    for (const double n : {1.5, 2.5, 3.5}) CHECK(fit_lobe(n, 1.0).codes < 0.005);
    for (const double n : {1.1, 1.3, 1.7}) CHECK(fit_lobe(n, 2.0).codes < 0.2);
    // A power or an amplitude without a bound gives 255 codes.
    CHECK(fit_lobe(0.9, 1.0).codes == 255.0);
    CHECK(fit_lobe(70.0, 1.0).codes == 255.0);
    CHECK(fit_lobe(1.3, 0.0).codes == 255.0);
    CHECK(fit_lobe(1.3, 1e30).codes == 255.0);
    CHECK(fit_lobe(std::nan(""), 1.0).codes == 255.0);
}

TEST_CASE("curves: a highlight whose range is empty or reaches 0 has no bound", "[shading][pow][curve]") {
    CHECK(fit_specular(16.0, 1.0).codes(1.0, 1) == 255.0);
    CHECK(fit_specular(16.0, 0.0).codes(1.0, 1) == 255.0);
    CHECK(fit_specular(0.0, 0.0).codes(1.0, 1) == 255.0);
    CHECK(fit_specular(0.0, 0.5).codes(1.0, 1) < 0.01);  // x^0 is 1
}

TEST_CASE("curves: highlights are off by no more than their fits state", "[shading][pow][curve]") {
    for (const double half_exponent : {0.7, 1.0, 3.3, 8.0, 16.0, 24.5, 65.3, 131.0, 700.0, 5000.0})
        for (const auto& cut_and_terms : {std::pair{0.3, 4}, {1e-2, 4}, {1e-4, 4}, {1e-6, 4}, {1e-2, 8}, {1e-7, 8}, {1e-9, 8}}) {
            const double cut = cut_and_terms.first, least = std::pow(cut, 1.0 / half_exponent);
            const int terms = cut_and_terms.second;
            const SpecularFit fit = fit_specular(half_exponent, least, terms);
            double worst = -255.0;
            for (int i = 0; i <= 2000; ++i) {
                const auto x = static_cast<float>(least + (1.0 - least) * i / 2000.0);
                float power = fit.curve.c[terms - 1];
                for (int k = terms - 2; k >= 0; --k) power = power * x + fit.curve.c[k];
                for (int k = 0; k < fit.curve.squarings; ++k) power *= power;
                const double want = std::pow(static_cast<double>(x), half_exponent);
                const double error = std::fabs(static_cast<double>(power) / want - 1.0), said = fit.relative_error(want);
                INFO("half exponent " << half_exponent << ", cut " << cut << ", x " << x << ": off by " << error << ", said " << said);
                if (said < 1e30 && !(error <= said)) CHECK(error <= said);  // 1e30: nothing is known
                // Three lights in a pixel, in codes.
                for (const double peak : {0.05, 0.4, 3.0}) {
                    const double got = peak * (static_cast<double>(power) + 2.0 * 0.1), true_sum = peak * (want + 2.0 * 0.1);
                    worst = std::max(worst, std::fabs(code(got) - code(true_sum)) - fit.codes(peak, 3));
                }
            }
            CHECK(worst <= 0.0);
            if (half_exponent >= 3.0 && half_exponent <= 131.0 && cut >= 1e-4) CHECK(fit.codes(0.5, 1) < 2.5);
        }
}
