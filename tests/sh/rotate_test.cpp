#include "sh/rotate.hpp"

#include "sh/project.hpp"
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
