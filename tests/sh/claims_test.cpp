// Claims of the papers about errors, energies and norms: the ranges where they hold, and those where they do not.
#include "sh/lobe_error.hpp"
#include "sh/quadrature.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace halflit;
using namespace halflit::sh;

namespace {

WrapLobe general(double a) { return {a, 1 + a, 1.0}; }

/// Share of band l in the lobe's energy, in percent.
double share(const WrapLobe& lobe, std::size_t l) {
    const double f = zonal_bands(lobe)[l], norm2 = 2 * kPi * (1 + lobe.wrap) / (2 * lobe.power + 1);
    return 100 * static_cast<double>(2 * l + 1) * (kPi / 4) * f * f / norm2;
}

}  // namespace

TEST_CASE("claims: the order-3 error is largest at a = 0 for the general lobe, but at w = 1/3 for Green's", "[sh][zonal]") {
    // [SNY11] figure 5.
    double previous = 1;
    for (int i = 0; i <= 100; ++i) {
        const double l2 = truncation_error(general(i / 100.0), 3).l2;
        CHECK(l2 < previous);
        previous = l2;
    }
    CHECK(previous < 1e-7);
    const auto green = [](double w) { return truncation_error({w, 1.0, 1.0}, 3).l2; };
    CHECK(green(0.0) == Approx(0.12791584).epsilon(1e-7));
    CHECK(green(1.0 / 3) == Approx(0.13129).margin(5e-6));
    for (int i = 0; i <= 60; ++i) CHECK(green(i / 60.0) <= green(1.0 / 3) + 1e-12);
}

TEST_CASE("claims: energy moves to lower bands in sum, not band by band", "[sh][zonal]") {
    // [SNY11] figure 6.
    double tail_before = 100;
    for (int i = 0; i <= 100; ++i) {
        double low = 0;
        for (std::size_t l = 0; l < 3; ++l) low += share(general(i / 100.0), l);
        CHECK(100 - low <= tail_before + 1e-9);
        tail_before = 100 - low;
    }
    CHECK(share(general(0), 3) < 1e-12);
    CHECK(share(general(0.339), 3) == Approx(0.0744).margin(1e-4));
    CHECK(share(general(1), 3) < 1e-12);
    CHECK(share(general(0.254), 5) == Approx(0.0403).margin(1e-4));
    CHECK(share(general(0), 1) == Approx(50));
    CHECK(share(general(1), 1) == Approx(41.666667));  // a low band whose share falls
    CHECK(share(general(0), 0) == Approx(37.5));
    CHECK(share(general(1), 0) == Approx(55.555556));
}

TEST_CASE("claims: a fourth band makes the largest error worse from a = .18 to .43", "[sh][zonal]") {
    // [SNY11] calls order 3 a reasonable choice: its largest error is 9.4 % at a = 0. A higher order does not always have a smaller error.
    CHECK(truncation_error(general(0), 3).sup == Approx(0.09375).epsilon(1e-9));
    for (const double a : {0.18, 0.25, 0.3, 0.4, 0.43}) CHECK(truncation_error(general(a), 4).sup > truncation_error(general(a), 3).sup);
    for (const double a : {0.1, 0.16, 0.46, 0.6}) CHECK(truncation_error(general(a), 4).sup <= truncation_error(general(a), 3).sup);
}

TEST_CASE("claims: no sky turns Lambert into the general lobe for 0 < a < 1 because that lobe has a third band", "[sh][zonal]") {
    // [Lis]. A sky multiplies Lambert's bands, and Lambert's band 3 is 0. Half-Lambert and Valve's lobe have no band 3 either.
    CHECK(zonal_bands({0.0, 1.0, 1.0})[3] == 0.0);
    CHECK(zonal_bands({1.0, 1.0, 1.0})[3] == 0.0);
    CHECK(zonal_bands({1.0, 2.0, 1.0})[3] == 0.0);
    for (int i = 1; i < 100; ++i) CHECK(std::fabs(zonal_bands(general(i / 100.0))[3]) > 1e-5);
}

TEST_CASE("claims: for w above 1 the norm differs because the part below x = -1 is left out", "[sh][zonal]") {
    // [McA13] gives (n + 1) / (2 (1 + w)) for w in [0, 1]. The mean over all directions must be Lambert's: the integral over [-1, 1] is
    // 1/2.
    const auto integral = [](double w, double n) {
        double sum = 0;
        const double low = std::max(-1.0, -w);
        for (const GaussNode& node : gauss_legendre(64))
            sum += 0.5 * (1 - low) * node.weight * std::pow((low + 0.5 * (node.x + 1) * (1 - low) + w) / (1 + w), n);
        return sum;
    };
    for (const double n : {1.0, 2.0, 3.5}) {
        for (const double w : {0.25, 1.0}) CHECK(normalizing_scale(w, n) * integral(w, n) == Approx(0.5).epsilon(1e-6));
        for (const double w : {1.25, 2.0}) {
            const double norm = (n + 1) * std::pow(1 + w, n) / (2 * (std::pow(1 + w, n + 1) - std::pow(w - 1, n + 1)));
            CHECK(norm * integral(w, n) == Approx(0.5).epsilon(1e-9));
            CHECK(normalizing_scale(w, n) * integral(w, n) < 0.5 - 1e-5);
        }
    }
}
