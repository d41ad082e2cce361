#include "sh/trig.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace halflit;

TEST_CASE("trig: sine and cosine are within 1e-15 of the true values up to 1000 radians", "[sh][trig]") {
    double worst = 0;
    for (int i = -200000; i <= 200000; ++i) {
        const double x = i * 0.005 + 1e-7 * i;
        const SinCos got = sin_cos(x);
        const auto exact = static_cast<long double>(x);
        worst = std::max({worst, static_cast<double>(std::fabs(static_cast<long double>(got.sin) - std::sin(exact))),
                          static_cast<double>(std::fabs(static_cast<long double>(got.cos) - std::cos(exact)))});
    }
    INFO("worst " << worst);
    CHECK(worst < 1e-15);
    CHECK(worst > 0);
}

TEST_CASE("trig: small angles keep their relative precision", "[sh][trig]") {
    for (double x = 1.0; x > 1e-300; x *= 0.37) {
        const auto exact = std::sin(static_cast<long double>(x));
        CHECK(std::fabs(static_cast<double>((static_cast<long double>(sin_cos(x).sin) - exact) / exact)) < 3e-16);
    }
}

TEST_CASE("trig: exact at 0, odd sine, even cosine", "[sh][trig]") {
    CHECK(sin_cos(0.0).sin == 0.0);
    CHECK(sin_cos(0.0).cos == 1.0);
    for (const double x : {0.1, 0.8, 1.6, 3.1, 4.7, 100.0}) {
        CHECK(sin_cos(-x).sin == -sin_cos(x).sin);
        CHECK(sin_cos(-x).cos == sin_cos(x).cos);
    }
}

TEST_CASE("trig: arguments that are not numbers, or too large, give (0, 1)", "[sh][trig]") {
    for (const double x : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e7, -1e300}) {
        CHECK(sin_cos(x).sin == 0.0);
        CHECK(sin_cos(x).cos == 1.0);
    }
}

TEST_CASE("trig: sin_cos runs at compile time", "[sh][trig]") {
    constexpr SinCos right_angle = sin_cos(kPi / 2);
    static_assert(right_angle.sin == 1.0);
    CHECK(std::fabs(right_angle.cos) < 1e-16);
}
