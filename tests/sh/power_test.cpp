#include "sh/power.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

using namespace halflit;

TEST_CASE("power: log2, exp2 and powers agree with the C library to 2e-15", "[sh]") {
    double worst = 0;
    for (int i = -4000; i <= 4000; ++i) {
        const double y = i * 0.2371, x = std::exp2(y);
        worst = std::max(worst, std::fabs(log2_of(x) - y) / std::max(1.0, std::fabs(y)));
        worst = std::max(worst, std::fabs(exp2_of(y) / x - 1.0));
        const double t = std::fabs(std::sin(0.37 * i));
        // The rounding error of the exponent grows with the exponent's size.
        for (const double p : {0.3, 1.0, 1.3, 2.5})
            if (t > 0) worst = std::max(worst, std::fabs(power_of(t, p) / std::pow(t, p) - 1.0) / (1.0 + std::fabs(p * std::log2(t))));
    }
    CHECK(worst < 2e-15);
}

TEST_CASE("power: values at 0 and 1 are exact and exp2 underflows to 0", "[sh]") {
    CHECK(log2_of(1.0) == 0.0);
    CHECK(exp2_of(0.0) == 1.0);
    CHECK(power_of(0.0, 0.5) == 0.0);
    CHECK(power_of(1.0, 1e5) == 1.0);
    CHECK(exp2_of(-1e6) == 0.0);
}
