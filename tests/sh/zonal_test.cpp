// Bands of the wrap family, compared with the lists of the papers (with the correction that one of them needs) and with integrals.
#include "sh/zonal.hpp"

#include "sh/lobe_error.hpp"
#include "sh/quadrature.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace halflit;
using namespace halflit::sh;

namespace {

/// [SNY11], general lobe, order 6, with (a + 7) in the denominator of band 5.
std::array<double, 6> general_list(double a) {
    const double d2 = a + 2, d3 = d2 * (a + 3), d4 = d3 * (a + 4), d5 = d4 * (a + 5), d6 = d5 * (a + 6), d7 = d6 * (a + 7);
    return {2 * (a + 1) / d2,
            4 * (a + 1) / d3,
            2 * (a + 1) * (a * a - 2 * a + 3) / d4,
            -2 * (a - 1) * a * (a + 1) * (5 * a - 7) / d5,
            2 * (a - 1) * (a + 1) * (36 * a * a * a - 46 * a * a - 7 * a + 15) / d6,
            -2 * (a - 1) * a * (a + 1) * (329 * a * a * a - 401 * a * a - 151 * a + 219) / d7};
}

/// [SNY11], Green's lobe, order 6.
std::array<double, 6> green_list(double w) {
    return {w + 1,
            -(w - 2) * (w + 1) / 3,
            (w - 1) * (w - 1) * (w + 1) / 4,
            -(w - 1) * (w - 1) * w * (w + 1) / 4,
            (w - 1) * (w - 1) * (w + 1) * (7 * w * w - 1) / 24,
            -(w - 1) * (w - 1) * w * (w + 1) * (3 * w * w - 1) / 8};
}

/// 2 times the integral of f P_l dx, for powers n that are multiples of 1/4. P_l: Legendre polynomial. With x = -w + (1+w) u^4 the
/// integrand is a polynomial in u.
double integral(double w, double n, int l) {
    static const std::vector<GaussNode> rule = gauss_legendre(64);
    double sum = 0;
    for (const GaussNode& node : rule) {
        const double u = 0.5 * (node.x + 1), x = -w + (1 + w) * std::pow(u, 4);
        sum += node.weight * 0.5 * std::pow(u, 4 * n) * std::legendre(static_cast<unsigned>(l), std::clamp(x, -1.0, 1.0)) * (1 + w) * 4 *
               std::pow(u, 3);
    }
    return 2 * sum;
}

}  // namespace

TEST_CASE("zonal: Lambert is [1, 2/3, 1/4, 0, -1/24, 0, 1/64, 0, -1/128, 0]", "[sh][zonal]") {
    const BandFactors f = zonal_bands({0.0, 1.0, 1.0});
    const double expected[] = {1, 2.0 / 3, 0.25, 0, -1.0 / 24, 0, 1.0 / 64, 0, -1.0 / 128, 0};
    for (std::size_t l = 0; l < 10; ++l) CHECK(f[l] == Approx(expected[l]).margin(1e-15));
    for (const std::size_t l : {3u, 5u, 7u, 9u}) CHECK(f[l] == 0.0);
}

TEST_CASE("zonal: the general lobe's order-6 list, band 5 with the missing (a + 7)", "[sh][zonal]") {
    for (int i = 0; i <= 100; ++i) {
        const double a = i / 100.0;
        const BandFactors f = zonal_bands({a, 1.0 + a, 1.0});
        const auto expected = general_list(a);
        INFO("a " << a);
        for (std::size_t l = 0; l < 6; ++l) CHECK(f[l] == Approx(expected[l]).margin(1e-14));
    }
    CHECK(zonal_bands({0.5, 1.5, 1.0})[5] == Approx(0.005994005994).epsilon(1e-9));
    // The printed band 5 is 7.5 times as large at a = 1/2; the integral shows that (a + 7) is missing.
    CHECK(integral(0.5, 1.5, 5) == Approx(general_list(0.5)[5]).epsilon(1e-11));
}

TEST_CASE("zonal: Green's order-6 list", "[sh][zonal]") {
    for (int i = 0; i <= 100; ++i) {
        const double w = i / 100.0;
        const BandFactors f = zonal_bands({w, 1.0, 1.0});
        const auto expected = green_list(w);
        INFO("w " << w);
        for (std::size_t l = 0; l < 6; ++l) CHECK(f[l] == Approx(expected[l]).margin(1e-14));
    }
}

TEST_CASE("zonal: the order-3 listings, GeneralWrapSH normalised and GreenWrapSH not", "[sh][zonal]") {
    for (int i = 0; i <= 20; ++i) {
        const double a = i / 20.0;
        const BandFactors general = zonal_bands({a, 1.0 + a, normalizing_scale(a, 1.0 + a)});
        const double norm = 0.5 * (2 + a) / (1 + a), t0 = 2 * (a + 1), t1 = a + 2, t2 = a + 3, t3 = a + 4;
        CHECK(normalizing_scale(a, 1.0 + a) == Approx(norm).epsilon(1e-15));
        CHECK(general[0] == Approx(norm * t0 / t1).epsilon(1e-14));
        CHECK(general[1] == Approx(norm * 2 * t0 / (t1 * t2)).epsilon(1e-14));
        CHECK(general[2] == Approx(norm * t0 * (a * a - t0 + 5) / (t1 * t2 * t3)).epsilon(1e-14));
        const BandFactors green = zonal_bands({a, 1.0, 1.0});
        CHECK(green[0] == Approx(a + 1).epsilon(1e-14));
        CHECK(green[1] == Approx(-(a - 2) * (a + 1) / 3).epsilon(1e-14));
        CHECK(green[2] == Approx(0.25 * (a - 1) * (a - 1) * (a + 1)).margin(1e-14));
    }
}

TEST_CASE("zonal: every band of every (w, n) is the integral of f P_l", "[sh][zonal]") {
    for (const double w : {0.0, 0.1, 0.25, 0.5, 0.8, 1.0})
        for (const double n : {0.0, 0.25, 0.5, 1.0, 1.25, 1.5, 2.0, 3.0, 4.75, 8.0}) {
            const BandFactors f = zonal_bands({w, n, 1.0});
            for (int l = 0; l < kMaxBands; ++l) {
                INFO("w " << w << " n " << n << " l " << l);
                CHECK(f[static_cast<std::size_t>(l)] == Approx(integral(w, n, l)).margin(1e-14 * 2 * (1 + w)));
            }
        }
}

TEST_CASE("zonal: w = 1 with an integer power ends after that band, exactly", "[sh][zonal]") {
    for (int n = 0; n <= 8; ++n) {
        const LobeSpectrum spectrum = lobe_spectrum({1.0, static_cast<double>(n), 1.0});
        for (int l = 0; l < kSpectrumBands; ++l) {
            INFO("n " << n << " l " << l);
            CHECK((spectrum.f[static_cast<std::size_t>(l)] == 0.0) == (l > n));
        }
        CHECK(spectrum.tail_norm == 0.0);
        CHECK(spectrum.tail_sum == 0.0);
    }
    // [4/3, 2/3, 2/15] for Valve, [2, 2/3] for half-Lambert
    const BandFactors valve = zonal_bands({1.0, 2.0, 1.0});
    CHECK(valve[0] == Approx(4.0 / 3).epsilon(1e-15));
    CHECK(valve[1] == Approx(2.0 / 3).epsilon(1e-15));
    CHECK(valve[2] == Approx(2.0 / 15).epsilon(1e-14));
}

TEST_CASE("zonal: scaled by (n+1)/(2(1+w)), band 0 is 1", "[sh][zonal]") {
    for (const double w : {0.0, 0.3, 1.0})
        for (const double n : {0.5, 1.0, 2.0, 7.5, 100.0})
            CHECK(zonal_bands({w, n, normalizing_scale(w, n)})[0] == Approx(1.0).epsilon(1e-15));
}

TEST_CASE("zonal: the square of the claimed tail is at least that of the lobe beyond 64 bands, at most 1.3 times as much", "[sh][zonal]") {
    for (const double w : {0.0, 0.2, 0.5, 0.9, 0.99, 1.0})
        for (const double n : {0.0, 0.5, 1.0, 1.1, 1.5, 2.0, 3.0, 10.0, 300.0}) {
            const LobeSpectrum spectrum = lobe_spectrum({w, n, 1.0});
            double known = 0;
            for (int l = 0; l < kSpectrumBands; ++l)
                known += (2 * l + 1) / (4 * kPi) * spectrum.f[static_cast<std::size_t>(l)] * spectrum.f[static_cast<std::size_t>(l)];
            const double whole = 2 * (1 + w) / ((2 * n + 1) * kPi), tail = whole - known;  // |f|^2 / pi^2
            INFO("w " << w << " n " << n << " tail^2 " << tail << " claimed " << spectrum.tail_norm * spectrum.tail_norm);
            CHECK(spectrum.tail_norm * spectrum.tail_norm >= tail - 1e-14 * whole);
            CHECK(spectrum.tail_norm * spectrum.tail_norm <= 1.3 * tail + 1e-14 * whole);
        }
}

TEST_CASE("zonal: the claimed slope is at least the lobe's", "[sh][zonal]") {
    for (const double w : {0.0, 0.5, 1.0})
        for (const double n : {1.0, 1.5, 2.0, 4.0}) {
            const double slope = lobe_spectrum({w, n, 2.0}).slope;
            for (int i = 0; i < 1000; ++i) {
                const double a = kPi * i / 1000, b = kPi * (i + 1) / 1000;
                CHECK(std::abs(lobe_value({w, n, 2.0}, std::cos(a)) - lobe_value({w, n, 2.0}, std::cos(b))) <=
                      slope * (b - a) * (1 + 1e-9));
            }
        }
    CHECK(std::isinf(lobe_spectrum({0.5, 0.5, 1.0}).slope));
}

TEST_CASE("zonal: the claimed largest error of each order is at least the series', at most 1e-3 of the slope above it", "[sh][zonal]") {
    for (const double w : {0.0, 0.25, 0.5, 0.9, 1.0})
        for (const double n : {1.0, 1.3, 2.0, 4.0}) {
            const WrapLobe lobe{w, n, 1.5};
            const LobeSpectrum spectrum = lobe_spectrum(lobe);
            for (int order = 1; order <= kMaxBands; ++order) {
                const double sup = truncation_error(lobe, order).sup, claimed = spectrum.sup[static_cast<std::size_t>(order - 1)];
                INFO("w " << w << " n " << n << " order " << order << " error " << sup << " claimed " << claimed);
                CHECK(claimed >= sup);
                CHECK(claimed <= sup + 1e-3 * spectrum.slope);
            }
        }
    CHECK(std::isinf(lobe_spectrum({0.5, 0.5, 1.0}).sup[2]));
}

TEST_CASE("lobe error: the L2 errors of the general lobe at order 3 and 6", "[sh][zonal]") {
    const struct {
        double a, e3, e6;
    } rows[] = {{0.00, 0.12791584, 0.063957919},
                {0.25, 0.07691997, 0.025567312},
                {0.50, 0.043856859, 0.010734196},
                {0.75, 0.018381243, 0.0038905943},
                {1.00, 0.0, 0.0}};
    for (const auto& row : rows) {
        INFO("a " << row.a);
        CHECK(truncation_error({row.a, 1 + row.a, 1.0}, 3).l2 == Approx(row.e3).margin(6e-9));
        CHECK(truncation_error({row.a, 1 + row.a, 1.0}, 6).l2 == Approx(row.e6).margin(6e-9));
    }
    CHECK(truncation_error({0.0, 1.0, 1.0}, 3).l2 == Approx(std::sqrt(kPi / 192)).epsilon(1e-12));
}

TEST_CASE("lobe error: Lambert at order 3 is off by 3/32 at most and reaches -.0396", "[sh][zonal]") {
    const TruncationError error = truncation_error({0.0, 1.0, 1.0}, 3);
    CHECK(error.sup == Approx(3.0 / 32).epsilon(1e-12));     // at x = 0: 1/4 - 5/32
    CHECK(error.min == Approx(-19.0 / 480).epsilon(1e-12));  // minimum of 3/32 + x/2 + 15/32 x^2, at x = -8/15
    const struct {
        double a, sup, min;
    } rows[] = {{0.1, .0708, -.0308}, {0.25, .0483, -.0212}, {0.4, .0364, -.0153}, {0.5, .0286, -.0129},
                {0.6, .0212, -.0111}, {0.75, .0115, -.0084}, {0.9, .0043, -.0043}};
    for (const auto& row : rows) {
        const TruncationError general = truncation_error({row.a, 1 + row.a, 1.0}, 3);
        INFO("a " << row.a);
        CHECK(general.sup == Approx(row.sup).margin(6e-5));
        CHECK(general.min == Approx(row.min).margin(6e-5));
    }
    CHECK(truncation_error({1.0, 2.0, 1.0}, 3).sup < 1e-15);
}

TEST_CASE("lobe error: the slope where light ends", "[sh][zonal]") {
    CHECK(slope_at_boundary({0.0, 1.0, 1.0}) == 1.0);
    CHECK(slope_at_boundary({0.5, 1.0, 1.0}) == Approx(1 / 1.5));
    CHECK(slope_at_boundary({0.5, 1.5, 1.0}) == 0.0);
    CHECK(std::isinf(slope_at_boundary({0.5, 0.5, 1.0})));
    CHECK(lobe_value({0.5, 0.0, 1.0}, -0.5) == 0.0);
    CHECK(lobe_value({0.5, 0.0, 1.0}, -0.49) == 1.0);
}
