#include "sh/basis.hpp"

#include "sh/coefficients.hpp"
#include "sh/quadrature.hpp"
#include "tests/support/random.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace halflit;
using namespace halflit::sh;

namespace {

Vec3d random_direction(test::Random& random) {
    for (;;) {
        const Vec3d v{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
        const double size = length(v);
        if (size > 0.1 && size < 1) return v * (1.0 / size);
    }
}

/// std::sph_legendre has the normalisation and the sign (-1)^m of the convention already.
double from_library(int l, int m, Vec3d d) {
    const int order = std::abs(m);
    const double theta = std::acos(std::clamp(d.z, -1.0, 1.0)), phi = std::atan2(d.y, d.x);
    const double value = std::sph_legendre(static_cast<unsigned>(l), static_cast<unsigned>(order), theta);
    return m == 0 ? value : value * std::sqrt(2.0) * (m > 0 ? std::cos(order * phi) : std::sin(order * phi));
}

}  // namespace

TEST_CASE("basis: bands 0 to 2 are the polynomials of the literature, sign included", "[sh][basis]") {
    test::Random random(1);
    for (int i = 0; i < 100; ++i) {
        const Vec3d d = random_direction(random);
        const double x = d.x, y = d.y, z = d.z;
        double b[9];
        evaluate_basis<3>(d, b);
        const double expected[9] = {std::sqrt(1 / (4 * kPi)),
                                    -std::sqrt(3 / (4 * kPi)) * y,
                                    std::sqrt(3 / (4 * kPi)) * z,
                                    -std::sqrt(3 / (4 * kPi)) * x,
                                    std::sqrt(15 / (4 * kPi)) * x * y,
                                    -std::sqrt(15 / (4 * kPi)) * y * z,
                                    std::sqrt(5 / (16 * kPi)) * (3 * z * z - 1),
                                    -std::sqrt(15 / (4 * kPi)) * x * z,
                                    std::sqrt(15 / (16 * kPi)) * (x * x - y * y)};
        for (int k = 0; k < 9; ++k) CHECK(b[k] == Approx(expected[k]).margin(1e-15));
    }
}

TEST_CASE("basis: all 100 functions are the library's associated Legendre functions", "[sh][basis]") {
    test::Random random(2);
    for (int i = 0; i < 200; ++i) {
        const Vec3d d = random_direction(random);
        double b[kMaxCoefficients];
        evaluate_basis<kMaxBands>(d, b);
        for (int l = 0; l < kMaxBands; ++l)
            for (int m = -l; m <= l; ++m) {
                INFO("l " << l << " m " << m << " z " << d.z);
                // acos loses digits near the poles: 1e-12.
                CHECK(b[coefficient_index(l, m)] == Approx(from_library(l, m, d)).margin(1e-12));
            }
    }
}

TEST_CASE("basis: 100 functions are orthonormal", "[sh][basis]") {
    std::vector<double> gram(kMaxCoefficients * kMaxCoefficients);
    for (const SphereNode& node : sphere_quadrature(2 * (kMaxBands - 1))) {
        double b[kMaxCoefficients];
        evaluate_basis<kMaxBands>(node.direction, b);
        for (std::size_t i = 0; i < kMaxCoefficients; ++i)
            for (std::size_t j = 0; j < kMaxCoefficients; ++j) gram[i * kMaxCoefficients + j] += node.weight * b[i] * b[j];
    }
    double worst = 0;
    for (std::size_t i = 0; i < kMaxCoefficients; ++i)
        for (std::size_t j = 0; j < kMaxCoefficients; ++j)
            worst = std::max(worst, std::abs(gram[i * kMaxCoefficients + j] - (i == j ? 1.0 : 0.0)));
    CHECK(worst < 1e-13);  // measured 2e-14
}

TEST_CASE("basis: at the poles only m = 0 is left, and equals sqrt((2l+1)/4pi) with the sign of z^l", "[sh][basis]") {
    for (const double z : {1.0, -1.0}) {
        double b[kMaxCoefficients];
        evaluate_basis<kMaxBands>(Vec3d{0, 0, z}, b);
        for (int l = 0; l < kMaxBands; ++l)
            for (int m = -l; m <= l; ++m) {
                const double expected = m != 0 ? 0.0 : std::sqrt((2 * l + 1) / (4 * kPi)) * (l % 2 != 0 ? z : 1.0);
                CHECK(b[coefficient_index(l, m)] == Approx(expected).margin(1e-15));
            }
    }
}

TEST_CASE("basis: near a pole, m = 1 keeps its relative accuracy", "[sh][basis]") {
    for (const double e : {1e-3, 1e-8, 1e-15}) {
        double b[kMaxCoefficients];
        evaluate_basis<kMaxBands>(Vec3d{e, 0, std::sqrt(1 - e * e)}, b);
        // The function of order 1 divided by e, the sine of the polar angle, tends to -sqrt((2l+1)/4pi) sqrt(l(l+1)/2) at the pole; the
        // error is of order e^2.
        for (int l = 1; l < kMaxBands; ++l)
            CHECK(b[coefficient_index(l, 1)] ==
                  Approx(-e * std::sqrt((2 * l + 1) / (4 * kPi)) * std::sqrt(l * (l + 1) / 2.0)).epsilon(50 * e * e + 1e-14));
    }
}

TEST_CASE("basis: the sum of squares of a band is (2l+1)/4pi everywhere, float is within 1.5e-6 of it", "[sh][basis]") {
    test::Random random(3);
    for (int i = 0; i < 300; ++i) {
        const Vec3d d = random_direction(random);
        double b[kMaxCoefficients];
        float bf[kMaxCoefficients];
        evaluate_basis<kMaxBands>(d, b);
        const Vec3f df{static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
        evaluate_basis<kMaxBands>(df, bf);
        double exact_at_float[kMaxCoefficients];
        evaluate_basis<kMaxBands>(Vec3d{df.x, df.y, df.z}, exact_at_float);
        for (int l = 0; l < kMaxBands; ++l) {
            double sum = 0;
            for (int k = l * l; k < (l + 1) * (l + 1); ++k) {
                sum += b[k] * b[k];
                // 25 eps times the largest value of the band, sqrt((2l+1)/4pi); band 9 sets the figure.
                CHECK(std::abs(bf[k] - exact_at_float[k]) < 25 * 0x1p-24 * std::sqrt((2 * l + 1) / (4 * kPi)));
            }
            CHECK(sum == Approx((2 * l + 1) / (4 * kPi)).epsilon(2e-14));
        }
    }
}

TEST_CASE("basis: fewer bands are the first functions of more, bit for bit", "[sh][basis]") {
    test::Random random(4);
    const Vec3d d = random_direction(random);
    double all[kMaxCoefficients], three[9], one[1];
    evaluate_basis<kMaxBands>(d, all);
    evaluate_basis<3>(d, three);
    evaluate_basis<1>(d, one);
    for (int i = 0; i < 9; ++i) CHECK(three[i] == all[i]);
    CHECK(one[0] == all[0]);
}

TEST_CASE("quadrature: Gauss-Legendre is exact up to degree 2n - 1", "[sh][quadrature]") {
    for (const int count : {1, 2, 3, 5, 8, 20, 64, 256})
        for (int degree = 0; degree <= 2 * count - 1; degree += count > 20 ? 37 : 1) {
            double sum = 0;
            for (const GaussNode& node : gauss_legendre(count)) sum += node.weight * std::pow(node.x, degree);
            INFO("nodes " << count << " degree " << degree);
            CHECK(sum == Approx(degree % 2 != 0 ? 0.0 : 2.0 / (degree + 1)).margin(2e-14));
        }
}
