#include "sh/rotate.hpp"

#include "sh/product.hpp"
#include "sh/project.hpp"
#include "sh/window.hpp"
#include "tests/sh/sky_images.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

using namespace halflit;
using namespace halflit::sh;
using namespace halflit::test;

namespace {

RadianceSh random_expansion(int bands, Random& random) {
    RadianceSh sh{bands, {}};
    for (std::size_t i = 0; i < static_cast<std::size_t>(coefficient_count(bands)); ++i)
        sh.c[i] = {random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
    return sh;
}

Rotation random_rotation(Random& random) {
    const auto normals = random_normals(2, static_cast<std::uint64_t>(random.index(1 << 30)));
    const Vec3d x = normals[0];
    Vec3d y = normals[1] - x * dot(x, normals[1]);
    y = y * (1 / length(y));
    return {{x, y, cross(x, y)}};
}

double worst_difference(const RadianceSh& a, const RadianceSh& b) {
    double worst = 0;
    for (std::size_t i = 0; i < kMaxCoefficients; ++i) worst = std::max(worst, largest_difference(a.c[i], b.c[i]));
    return worst;
}

double smallest_value(const RadianceSh& sh) {
    double smallest = 1e30;
    for (const Vec3d& d : random_normals(4000, 9)) {
        const Vec3d v = evaluate(sh, d);
        smallest = std::min({smallest, v.x, v.y, v.z});
    }
    return smallest;
}

}  // namespace

TEST_CASE("rotate: the value in direction d moves to direction r d", "[sh][rotate]") {
    Random random(21);
    for (int i = 0; i < 20; ++i) {
        const RadianceSh sh = random_expansion(1 + i % kMaxBands, random);
        const Rotation r = random_rotation(random);
        const RadianceSh turned = rotated(sh, r);
        for (const Vec3d& d : random_normals(10, 22)) CHECK(largest_difference(evaluate(turned, r * d), evaluate(sh, d)) < 1e-13 * 30);
    }
}

TEST_CASE("rotate: a rotation and its inverse, two rotations as their product, and the identity agree to 1e-13", "[sh][rotate]") {
    Random random(23);
    for (int i = 0; i < 20; ++i) {
        const RadianceSh sh = random_expansion(kMaxBands, random);
        const Rotation a = random_rotation(random), b = random_rotation(random);
        CHECK(worst_difference(rotated(rotated(sh, a), inverse(a)), sh) < 1e-13);
        CHECK(worst_difference(rotated(rotated(sh, a), b), rotated(sh, b * a)) < 1e-13);
        CHECK(worst_difference(rotated(sh, Rotation{}), sh) < 1e-13);
    }
}

TEST_CASE("rotate: equals the projection of the rotated function, to 1e-13", "[sh][rotate]") {
    Random random(24);
    for (int bands = 1; bands <= kMaxBands; ++bands) {
        const RadianceSh sh = random_expansion(bands, random);
        const Rotation r = random_rotation(random);
        const RadianceSh direct = project_function(kMaxBands, 18, [&](Vec3d d) { return evaluate(sh, inverse(r) * d); });
        CHECK(worst_difference(rotated(sh, r), direct) < 2e-13);
    }
}

TEST_CASE("rotate: bands keep their norms and do not mix", "[sh][rotate]") {
    Random random(25);
    const RadianceSh sh = random_expansion(kMaxBands, random);
    for (int l = 0; l < kMaxBands; ++l) {
        RadianceSh one{kMaxBands, {}};
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) one.c[static_cast<std::size_t>(i)] = sh.c[static_cast<std::size_t>(i)];
        const RadianceSh turned = rotated(one, random_rotation(random));
        Vec3d before{}, after{};
        for (std::size_t i = 0; i < kMaxCoefficients; ++i) {
            before = before + one.c[i] * one.c[i];
            after = after + turned.c[i] * turned.c[i];
            if (band_of(static_cast<int>(i)) != l) CHECK(turned.c[i] == Vec3d{});
        }
        CHECK(largest_difference(before, after) < 1e-13 * 10);
    }
}

TEST_CASE("rotate: a quarter turn about y carries +z to +x, and an image's columns with it", "[sh][rotate]") {
    CHECK(largest_difference(rotation_about_y(kPi / 2) * Vec3d{0, 0, 1}, {1, 0, 0}) < 1e-15);
    const Sky sky = random_sky(32, 16, 26);
    Sky turned = sky;
    // +z is the image's left edge and +x is at three quarters of its width: a quarter turn moves columns to the left by a quarter.
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x)
            for (int k = 0; k < 3; ++k)
                turned.rgb[static_cast<std::size_t>((y * 32 + (x + 24) % 32) * 3 + k)] =
                    sky.rgb[static_cast<std::size_t>((y * 32 + x) * 3 + k)];
    CHECK(worst_difference(rotated(Projection(sky.view()).radiance(), rotation_about_y(kPi / 2)), Projection(turned.view()).radiance()) <
          1e-12);
}

TEST_CASE("product: equals the product of the values, projected by an independent rule", "[sh][product]") {
    Random random(27);
    for (const auto& [m, n] : {std::pair{1, 1}, {3, 3}, {2, 5}, {6, 5}, {10, 10}}) {
        const RadianceSh a = random_expansion(m, random), b = random_expansion(n, random);
        // A quadrature of degree 41 has other nodes than any that product() uses.
        const RadianceSh direct = project_function(kMaxBands, 41, [&](Vec3d d) { return evaluate(a, d) * evaluate(b, d); });
        const RadianceSh sh = product(a, b, kMaxBands);
        INFO(m << " times " << n << " bands");
        CHECK(sh.bands == std::min(m + n - 1, kMaxBands));
        CHECK(worst_difference(sh, direct) < 1e-12);
        if (m + n - 1 <= kMaxBands)
            for (const Vec3d& d : random_normals(10, 28))
                CHECK(largest_difference(evaluate(sh, d), evaluate(a, d) * evaluate(b, d)) < 1e-12);
    }
}

TEST_CASE("product: agrees with the Gaunt integrals that have closed forms", "[sh][product]") {
    // Y_10^2 = (Y_00 + 2/sqrt(5) Y_20) / sqrt(4 pi); times Y_00 only scales.
    RadianceSh y10{2, {}}, y00{1, {}};
    y10.c[2] = {1, 1, 1};
    y00.c[0] = {1, 1, 1};
    const RadianceSh square = product(y10, y10, 3);
    CHECK(square.c[0].x == Approx(1 / std::sqrt(4 * kPi)).epsilon(1e-14));
    CHECK(square.c[6].x == Approx(2 / std::sqrt(5.0) / std::sqrt(4 * kPi)).epsilon(1e-14));
    CHECK(product(y10, y00, 2).c[2].x == Approx(1 / std::sqrt(4 * kPi)).epsilon(1e-14));
    CHECK(product(y10, RadianceSh{}, 3).bands == 0);
}

TEST_CASE("window: Hann's and Lanczos' factors", "[sh][window]") {
    const BandFactors hann = hann_window(3), lanczos = lanczos_window(3);
    const double expected_hann[] = {1, 0.75, 0.25, 0, 0},
                 expected_lanczos[] = {1, 3 * std::sqrt(3.0) / (2 * kPi), 3 * std::sqrt(3.0) / (4 * kPi), 0, 0};
    for (std::size_t l = 0; l < 5; ++l) {
        CHECK(hann[l] == Approx(expected_hann[l]).margin(1e-15));
        CHECK(lanczos[l] == Approx(expected_lanczos[l]).margin(1e-15));
    }
    CHECK(laplacian_window(0.25)[2] == Approx(1.0 / 10));
}

TEST_CASE("window: dering lifts the lowest value to 0 with the weakest window, and leaves a series without negative values alone",
          "[sh][window]") {
    // Lambert under a directional light of irradiance pi at order 3: its lowest value is -19/480.
    RadianceSh ringing{3, {}};
    const BandFactors lambert[] = {{1, 2.0 / 3, 0.25}};
    double b[9];
    evaluate_basis<3>(Vec3d{0.48, 0.6, 0.64}, b);
    for (int i = 0; i < 9; ++i) {
        const double c = kPi * b[i] * lambert[0][static_cast<std::size_t>(band_of(i))];
        ringing.c[static_cast<std::size_t>(i)] = {c, 0.5 * c, 2 * c};
    }
    CHECK(smallest_value(ringing) == Approx(-2 * 19.0 / 480).epsilon(1e-3));
    const Deringed deringed = dering(ringing);
    CHECK(deringed.lambda > 0);
    CHECK(smallest_value(deringed.sh) > -1e-4);
    CHECK(smallest_value(scaled_by_band(ringing, laplacian_window(0.98 * deringed.lambda))) < 0);
    CHECK(largest_difference(deringed.sh.c[0], ringing.c[0]) == 0.0);

    RadianceSh calm = ringing;
    calm.c[0] = calm.c[0] * 2.0;
    CHECK(dering(calm).lambda == 0.0);
    CHECK(worst_difference(dering(calm).sh, calm) == 0.0);
}
