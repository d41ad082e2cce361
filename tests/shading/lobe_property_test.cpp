// Properties that every member of the wrap family has at every x = N.L, on every instruction set.
#include "floats.hpp"
#include "lobe_curve/lobe_curve.hpp"
#include "shading/planner.hpp"
#include "shading/reference/reference.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;

namespace {

LobePlan plan_of(const Lobe& lobe) {
    Material material;
    material.lobe = lobe;
    const Light light;
    const std::vector<SlotMask> available{3u, 3u};
    return plan_shading({std::span(&material, 1), {}, available, plan_lights(std::span(&light, 1)), {}, {}}).materials[0].lobe;
}

std::vector<Lobe> many_lobes() {
    std::vector<Lobe> all{Lobe::lambert(), Lobe::half_lambert(), Lobe::valve()};
    for (const float w : {0.0f, 0.1f, 0.25f, 1.0f / 3.0f, 0.5f, 0.7f, 0.9f, 0.99999994f, 1.0f}) {
        all.push_back(Lobe::green(w));
        all.push_back(Lobe::sloan(w));
        for (const float n : {0.0f, 0.5f, 1.0f, 1.5f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 20.0f, 100.0f, 10000.0f})
            all.push_back(Lobe::mcauley(w, n));
    }
    return all;
}

/// Values of x in ascending order: a grid over [-1, 1], and 256 neighbouring floats on each side of the lobe's beginning, of 0 and of 1.
/// They go up to 4 ulp above 1, because the dot product of two unit vectors may lie there.
std::vector<float> cosines(float wrap) {
    std::vector<float> all;
    for (int i = -2048; i <= 2048; ++i) all.push_back(static_cast<float>(i) / 2048.0f);
    for (const float around : {-wrap, 0.0f, 1.0f - 0x1p-12f, 1.0f}) {
        float below = around, above = around;
        for (int i = 0; i < 256; ++i) {
            all.push_back(below = std::nextafter(below, -2.0f));
            all.push_back(above = std::nextafter(above, 2.0f));
        }
        all.push_back(around);
    }
    all.erase(std::remove_if(all.begin(), all.end(), [](float x) { return x > 1.0f + 4 * 0x1p-23f || x < -1.0f; }), all.end());
    std::sort(all.begin(), all.end());
    while (all.size() % 16 != 0) all.push_back(all.back());
    return all;
}

std::vector<float> curve(Isa isa, const Lobe& lobe, const std::vector<float>& x) {
    std::vector<float> out(x.size());
    lobe_curve(isa)(plan_of(lobe), x.data(), out.data(), static_cast<int>(x.size()));
    return out;
}

}  // namespace

TEST_CASE("lobe: on every set 0 up to x = -w, the scale from 1 on, and between the two elsewhere", "[shading][lobe]") {
    for (const Isa isa : test::available_isas())
        for (const Lobe& lobe : many_lobes()) {
            const std::vector<float> x = cosines(lobe.wrap), f = curve(isa, lobe, x);
            int wrong = 0;
            for (std::size_t i = 0; i < x.size(); ++i) {
                bool ok = f[i] >= 0.0f && f[i] <= lobe.scale();
                if (x[i] <= -lobe.wrap) ok &= same_bits(f[i], 0.0f);
                if (x[i] >= 1.0f) ok &= f[i] == lobe.scale();
                wrong += !ok;
            }
            INFO(isa_name(isa) << ", w " << lobe.wrap << ", n " << lobe.power);
            CHECK(wrong == 0);
        }
}

TEST_CASE("lobe: on every set it never falls by more than 4 ulp, and not at all where n is 1, 3/2, 2, .. 5", "[shading][lobe]") {
    // Sums, products and square roots round monotonically. The two polynomials of the general path do not, if neighbours are as close as
    // their error. That error grows with n as that of t^n does: n ulp from the rounding of t alone.
    for (const Isa isa : test::available_isas())
        for (const Lobe& lobe : many_lobes()) {
            const std::vector<float> x = cosines(lobe.wrap), f = curve(isa, lobe, x);
            const bool general = plan_of(lobe).path == LobePath::general;
            double worst = 0;
            float highest = 0;
            for (const float value : f) {
                if (value < highest) worst = std::max(worst, (static_cast<double>(highest) - value) / highest * 0x1p23);
                highest = std::max(highest, value);
            }
            INFO(isa_name(isa) << ", w " << lobe.wrap << ", n " << lobe.power << ", falls by " << worst << " ulp");
            CHECK(worst <= (general ? 4.0 : 0.0));
        }
}

TEST_CASE("lobe: NaN is dark, on every set", "[shading][lobe]") {
    const std::vector<float> x(16, kNan);
    for (const Isa isa : test::available_isas())
        for (const Lobe& lobe : many_lobes())
            for (const float f : curve(isa, lobe, x)) CHECK(f == 0.0f);
}

TEST_CASE("lobe: every set has scalar's bits", "[shading][lobe]") {
    for (const Lobe& lobe : many_lobes()) {
        const std::vector<float> x = cosines(lobe.wrap), expected = curve(Isa::scalar, lobe, x);
        for (const Isa isa : other_isas()) {
            const std::vector<float> f = curve(isa, lobe, x);
            INFO(isa_name(isa) << ", w " << lobe.wrap << ", n " << lobe.power);
            CHECK(std::equal(f.begin(), f.end(), expected.begin(), same_bits));
        }
    }
}

TEST_CASE("lobe: sloan(0) is Lambert, sloan(1) is Valve, and mcauley(a, 1 + a) is normalised sloan, bit for bit on every set",
          "[shading][lobe]") {
    const auto same = [](Isa isa, const Lobe& one, const Lobe& other) {
        const std::vector<float> x = cosines(one.wrap), f = curve(isa, one, x), g = curve(isa, other, x);
        return std::equal(f.begin(), f.end(), g.begin(), same_bits);
    };
    for (const Isa isa : test::available_isas()) {
        INFO(isa_name(isa));
        CHECK(same(isa, Lobe::sloan(0.0f), Lobe::lambert()));
        CHECK(same(isa, Lobe::sloan(1.0f), Lobe::valve()));
        CHECK(same(isa, Lobe::green(0.0f), Lobe::lambert()));
        CHECK(same(isa, Lobe::green(1.0f), Lobe::half_lambert()));
        for (int i = 0; i <= 64; ++i) {
            const float a = static_cast<float>(i) / 64.0f;
            Lobe normalized = Lobe::sloan(a);
            normalized.normalize = true;
            CHECK(same(isa, Lobe::mcauley(a, 1.0f + a), normalized));
            // The normalised lobe is the plain one times (2 + a) / (2 (1 + a)), rounded once.
            const std::vector<float> x = cosines(a), plain = curve(isa, Lobe::sloan(a), x), scaled = curve(isa, normalized, x);
            const float scale = (2.0f + a) / (2.0f * (1.0f + a));
            int wrong = 0;
            for (std::size_t k = 0; k < x.size(); ++k) wrong += !same_bits(scaled[k], plain[k] * scale);
            CHECK(wrong == 0);
        }
    }
}

TEST_CASE("lobe: derivatives in the angle at 0 are 1, 0, -1 for sloan at every a, and -n / (1 + w) in general", "[shading][lobe]") {
    // [SNY11]: "matches the first two derivatives" is true of d/d(theta). The fourth, (4a + 1) / (a + 1), differs from the cosine's 1. With
    // respect to x = cos theta only the first matches: d2f/dx2 = a / (1 + a), and 0 for the cosine.
    const auto at = [](const Lobe& lobe, double theta) { return reference::lobe_value(lobe, std::cos(theta)); };
    const auto second = [&](const Lobe& lobe, double h) { return (at(lobe, h) - 2 * at(lobe, 0) + at(lobe, -h)) / (h * h); };
    for (int i = 0; i <= 100; ++i) {
        const float a = static_cast<float>(i) / 100.0f;
        const Lobe lobe = Lobe::sloan(a);
        INFO("a " << a);
        CHECK(at(lobe, 0) == 1.0);
        CHECK((at(lobe, 1e-4) - at(lobe, -1e-4)) / 2e-4 == Approx(0.0).margin(1e-10));
        // Richardson extrapolation removes the h^2 term of the error; h^4 and the rounding of 1 + a to float remain.
        const double d2 = (4 * second(lobe, 1e-3) - second(lobe, 2e-3)) / 3;
        CHECK(d2 == Approx(-1.0).margin(2e-7));
        const double h = 0.03,
                     d4 = (at(lobe, 2 * h) - 4 * at(lobe, h) + 6 * at(lobe, 0) - 4 * at(lobe, h) + at(lobe, 2 * h)) / (h * h * h * h);
        CHECK(d4 == Approx((4.0 * a + 1.0) / (a + 1.0)).epsilon(0.02));
        const double dx = 1e-3, f0 = 1.0, f1 = reference::lobe_value(lobe, 1 - dx), f2 = reference::lobe_value(lobe, 1 - 2 * dx);
        CHECK((f0 - 2 * f1 + f2) / (dx * dx) == Approx(a / (1.0 + a)).margin(1e-3));
        CHECK((f0 - f1) / dx == Approx(1.0).margin(1e-3));
    }
    for (const float w : {0.0f, 0.25f, 0.5f, 1.0f})
        for (const float n : {1.0f, 1.25f, 1.5f, 2.0f, 4.0f}) {
            INFO("w " << w << ", n " << n);
            const double d2 = (4 * second({w, n, false}, 1e-3) - second({w, n, false}, 2e-3)) / 3;
            CHECK(d2 == Approx(-n / (1.0 + w)).margin(1e-6));
            CHECK((std::fabs(d2 + 1.0) < 1e-6) == (n == 1.0f + w));  // Green's is -1 / (1 + w): only Lambert's matches
        }
}

TEST_CASE("lobe: normalised, its peak exceeds 1 if n > 1 + 2w, and past the terminator it is brighter than Lambert", "[shading][lobe]") {
    // [McA13] is normalised, not energy-conserving: its mean over light directions is Lambert's, but single directions may be brighter.
    CHECK(Lobe::mcauley(0.5f, 4.0f).scale() == Approx(5.0 / 3));
    for (const float w : {0.0f, 0.25f, 0.5f, 1.0f})
        for (const float n : {1.0f, 1.5f, 2.0f, 3.5f, 8.0f}) {
            INFO("w " << w << ", n " << n);
            CHECK((reference::lobe_value(Lobe::mcauley(w, n), 1.0) > 1.0) == (n > 1.0f + 2.0f * w));
            if (w > 0.0f) CHECK(reference::lobe_value(Lobe::mcauley(w, n), 0.0) > 0.0);
        }
}

TEST_CASE("lobe: ((1 + x) / 2)^2 is the cubic with the values and slopes of max(0, x) at both ends, and not its best fit",
          "[shading][lobe]") {
    // [Lis]. The values 0 and 1 and the slopes 0 and 1 at x = -1 and 1 determine a cubic; this one has them. Its largest difference from
    // max(0, x) is 1/4, at 0; that of the order-3 series is 3/32. Its integral is 4/3 of that of max(0, x).
    const auto f = [](double x) { return reference::lobe_value(Lobe::valve(), x); };
    const double h = 1e-6;
    CHECK(f(-1) == 0.0);
    CHECK(f(1) == 1.0);
    CHECK((f(-1 + h) - f(-1)) / h == Approx(0.0).margin(1e-5));
    CHECK((f(1) - f(1 - h)) / h == Approx(1.0).margin(1e-5));
    double worst = 0, sum = 0;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
        const double x = -1 + (i + 0.5) * 2.0 / kSteps;
        worst = std::max(worst, std::fabs(f(x) - std::max(0.0, x)));
        sum += f(x) * 2.0 / kSteps;
    }
    CHECK(worst == Approx(0.25).margin(2e-3));
    CHECK(sum / 0.5 == Approx(4.0 / 3).epsilon(1e-5));
}

TEST_CASE("lobe: wraps and powers out of range are refused with the reason, powers below 1 give a warning", "[shading][lobe]") {
    CHECK(check_lobe(Lobe::sloan(0.0f)));
    CHECK(check_lobe({1.0f, kMaxLobePower, true}));
    CHECK(check_lobe({0.5f, 0.0f, false}));
    const std::pair<Lobe, std::string> refused[] = {
        {{-0.5f, 1.0f, false}, "wrap: expected a number from 0 to 1, found -0.5"},
        {{1.0000001f, 1.0f, false},
         "wrap: expected a number from 0 to 1, found 1.0000001: above 1 every normal is lit, and the norm has another formula"},
        {{kNan, 1.0f, false}, "wrap: expected a number from 0 to 1, found nan"},
        {{0.5f, -0.5f, false},
         "power: expected a number from 0 to 10000, found -0.5: below 0 the lobe grows without bound at its boundary"},
        {{0.5f, kNan, false}, "power: expected a number from 0 to 10000, found nan"},
        {{0.5f, 10001.0f, false}, "power: expected a number from 0 to 10000, found 10001"},
        {{0.5f, kInf, false}, "power: expected a number from 0 to 10000, found inf"}};
    for (const auto& [lobe, message] : refused) {
        const auto checked = check_lobe(lobe);
        REQUIRE(!checked);
        CHECK(checked.error().message == message);
        CHECK(checked.error().code == ErrorCode::bad_input);
    }
    CHECK(lobe_warning({0.5f, 1.0f, true}).empty());
    CHECK(lobe_warning({0.5f, 0.25f, true}) == "power 0.25: below 1 the curve has an infinite slope at its boundary");
    CHECK(lobe_warning({0.5f, 0.0f, false}) == "power 0: below 1 the curve jumps at its boundary");
}
