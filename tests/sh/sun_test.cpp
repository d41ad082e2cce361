#include "sh/sun.hpp"

#include "tests/sh/bound_check.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

using namespace halflit;
using namespace halflit::sh;
using namespace halflit::test;

namespace {

/// Disc of this radiance over a soft sky.
Sky sky_with_sun(Vec3d towards, double radius_deg, Vec3d radiance, int width = 256) {
    const double edge = std::cos(radius_deg * kPi / 180);
    return painted_sky(width, width / 2, [&](Vec3d d) {
        const Vec3d soft{0.6 + 0.3 * d.y, 0.7 + 0.2 * d.x, 0.9 + 0.2 * d.z};
        return dot(d, towards) > edge ? soft + radiance : soft;
    });
}

Vec3d total(const EquirectView& image) {
    Vec3d sum{};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) sum = sum + image.at(x, y) * pixel_solid_angle(image.width, image.height, y);
    return sum;
}

double degrees_between(Vec3d a, Vec3d b) { return std::acos(std::min(1.0, dot(a, b))) * 180 / kPi; }

}  // namespace

TEST_CASE("sun: a disc is found where it stands, with its irradiance, colour and size", "[sh][sun]") {
    // Positions: across the image's seam (+z), next to a pole, at a pole, and away from both.
    for (const Vec3d towards : {Vec3d{0, 0.6, 0.8}, Vec3d{0.0199986667, 0.9998, 0}, Vec3d{0, -1, 0}, Vec3d{-0.48, 0.64, -0.6}}) {
        const Vec3d radiance{900, 800, 600};
        const Sky sky = sky_with_sun(towards, 2.5, radiance);
        const Projection full(sky.view());
        const SunExtraction found = extract_suns(sky.view(), full);
        INFO("towards " << towards.x << " " << towards.y << " " << towards.z);
        REQUIRE(found.suns.size() == 1);
        const Sun& sun = found.suns[0];
        CHECK(degrees_between(sun.direction, towards) < 0.2);  // pixels of 1.4 degrees
        const Vec3d soft = total(sky_with_sun(towards, 2.5, {}).view());
        const Vec3d irradiance = total(sky.view()) - soft;
        CHECK(sun.irradiance.x == Approx(irradiance.x).epsilon(0.02));
        CHECK(sun.irradiance.z == Approx(irradiance.z).epsilon(0.02));
        CHECK(sun.solid_angle == Approx(irradiance.x / 900).epsilon(0.01));
        CHECK(sun.spread_rad < 2.5 * kPi / 180);
    }
}

TEST_CASE("sun: one pixel may be brighter than all others by any factor that float32 holds", "[sh][sun]") {
    // In such an image the mean without the sun is a difference that rounds to anything, below zero too.
    for (const int exponent : {10, 40, 54, 62, 90, 126}) {
        INFO("2^" << exponent);
        Sky sky = painted_sky(64, 32, [](Vec3d) { return Vec3d{0x1p-9, 0x1p-9, 0x1p-9}; });
        const double peak = std::ldexp(1.0, exponent);
        for (std::size_t c = 0; c < 3; ++c) sky.rgb[3 * (13 * 64 + 21) + c] = static_cast<float>(peak);
        const SunExtraction found = extract_suns(sky.view(), Projection(sky.view()));
        REQUIRE(found.suns.size() == 1);
        CHECK(degrees_between(found.suns[0].direction, equirect_direction(21.5 / 64, 13.5 / 32)) < 1e-3);
        const double share = found.suns[0].irradiance.x / (peak * pixel_solid_angle(64, 32, 13));
        CHECK(share > 0.9);
        CHECK(share < 1.000001);
    }
}

TEST_CASE("sun: energy is kept, and the returned projection is that of the residual image", "[sh][sun]") {
    const Sky sky = sky_with_sun({0.36, 0.48, 0.8}, 1.5, {3000, 2500, 1500});
    const Projection full(sky.view());
    const SunExtraction found = extract_suns(sky.view(), full);
    REQUIRE(found.suns.size() == 1);
    const EquirectView residual{sky.width, sky.height, found.residual_rgb};
    const Vec3d before = total(sky.view()), after = total(residual) + found.suns[0].irradiance;
    CHECK(after.x == Approx(before.x).epsilon(1e-9));
    CHECK(after.y == Approx(before.y).epsilon(1e-9));
    CHECK(after.z == Approx(before.z).epsilon(1e-9));
    for (const float v : found.residual_rgb) CHECK_FALSE(v < 0);
    const RadianceSh a = found.residual.radiance(), b = Projection(residual).radiance();
    for (std::size_t i = 0; i < kMaxCoefficients; ++i) CHECK(largest_difference(a.c[i], b.c[i]) < 1e-10);
}

TEST_CASE("sun: the bound falls wherever a sun is taken out", "[sh][sun]") {
    const LobeSpectrum lambert = lobe_spectrum({0.0, 1.0, 1.0});
    for (const double radius : {0.5, 1.0, 2.0, 4.0, 8.0, 16.0})
        for (const double radiance : {3.0, 30.0, 300.0, 3000.0}) {
            const Sky sky = sky_with_sun({-0.6, 0.64, 0.48}, radius, {radiance, radiance, radiance});
            const Projection full(sky.view());
            const SunExtraction found = extract_suns(sky.view(), full);
            const double before = largest(order_bounds(full.spectrum(), lambert).by_order[4]);
            const double after = largest(order_bounds(found.residual.spectrum(), lambert).by_order[4] + sun_bound(found.suns, lambert));
            INFO("radius " << radius << " radiance " << radiance << " suns " << found.suns.size());
            if (found.suns.empty())
                CHECK(after == before);
            else
                CHECK(after <= 0.9 * before);
            if (radius > 10) CHECK(found.suns.empty());
        }
}

TEST_CASE("sun: a soft sky has no sun, two lights are two suns", "[sh][sun]") {
    const Sky soft = sky_with_sun({0, 1, 0}, 2, {});
    const SunExtraction none = extract_suns(soft.view(), Projection(soft.view()));
    CHECK(none.suns.empty());
    CHECK(none.residual_rgb == std::vector<float>(soft.view().rgb.begin(), soft.view().rgb.end()));
    CHECK(largest_difference(none.residual.mean(), Projection(soft.view()).mean()) == 0.0);

    Sky two = sky_with_sun({0.6, 0.8, 0}, 2, {900, 900, 900});
    const Sky other = sky_with_sun({-0.8, 0, 0.6}, 2, {700, 100, 100});
    for (std::size_t i = 0; i < two.rgb.size(); ++i) two.rgb[i] = std::max(two.rgb[i], other.rgb[i]);
    const SunExtraction found = extract_suns(two.view(), Projection(two.view()));
    REQUIRE(found.suns.size() == 2);
    CHECK(degrees_between(found.suns[0].direction, {0.6, 0.8, 0}) < 0.5);
    CHECK(degrees_between(found.suns[1].direction, {-0.8, 0, 0.6}) < 0.5);
    CHECK(found.suns[1].irradiance.x > 6 * found.suns[1].irradiance.y);
    CHECK(extract_suns(two.view(), Projection(two.view()), {.max_suns = 1}).suns.size() == 1);
    CHECK(extract_suns(two.view(), Projection(two.view()), {.max_suns = 0}).suns.empty());
}

TEST_CASE("sun: directional light plus residual is within the bound of brute force over the whole image", "[sh][sun]") {
    const Sky sky = sky_with_sun({0.36, 0.48, 0.8}, 3, {500, 400, 300}, 128);
    const auto samples = light_samples(sky.view());
    const SunExtraction found = extract_suns(sky.view(), Projection(sky.view()));
    REQUIRE(found.suns.size() == 1);
    const BandGrid grid(found.residual);
    const RadianceSh radiance = found.residual.radiance();
    for (const WrapLobe& lobe : kTenLobes) {
        const LobeSpectrum spectrum = lobe_spectrum(lobe);
        const OrderBounds bounds = grid.order_bounds(spectrum);
        for (const int order : {1, 3, 5, 10}) {
            const PreconvolvedSh sh = convolve(radiance, zonal_bands(lobe), order);
            const double bound = largest(bounds.by_order[static_cast<std::size_t>(order - 1)] + sun_bound(found.suns, spectrum));
            double worst = 0;
            for (const Vec3d& n : random_normals(100, 51)) {
                const Vec3d direct = found.suns[0].irradiance * (lobe_value(lobe, dot(n, found.suns[0].direction)) / kPi);
                worst = std::max(worst, largest_difference(evaluate(sh, n) + direct, reflected(samples, lobe, n)));
            }
            INFO("w " << lobe.wrap << " n " << lobe.power << " order " << order << " error " << worst << " bound " << bound);
            CHECK(worst <= bound + 1e-3);
        }
    }
}
