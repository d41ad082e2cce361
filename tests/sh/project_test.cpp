#include "sh/project.hpp"

#include "tests/sh/sky_images.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

using namespace halflit;
using namespace halflit::sh;
using namespace halflit::test;

namespace {

double worst_difference(const RadianceSh& a, const RadianceSh& b) {
    double worst = 0;
    for (std::size_t i = 0; i < kMaxCoefficients; ++i) worst = std::max(worst, largest_difference(a.c[i], b.c[i]));
    return worst;
}

/// Coefficients of the image from Gauss points in each pixel: 40 x 40 in images less than 10 pixels wide, else 14 x 14.
RadianceSh by_samples(const EquirectView& image) {
    RadianceSh out{kMaxBands, {}};
    const auto rule = gauss_legendre(image.width < 10 ? 40 : 14);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (const GaussNode& v : rule)
                for (const GaussNode& u : rule) {
                    const double theta = (y + 0.5 + 0.5 * v.x) * kPi / image.height;
                    const Vec3d d = equirect_direction((x + 0.5 + 0.5 * u.x) / image.width, (y + 0.5 + 0.5 * v.x) / image.height);
                    const double weight = 0.25 * u.weight * v.weight * (kPi / image.height) * (2 * kPi / image.width) * std::sin(theta);
                    double b[kMaxCoefficients];
                    evaluate_basis<kMaxBands>(d, b);
                    for (std::size_t i = 0; i < kMaxCoefficients; ++i) out.c[i] = out.c[i] + image.at(x, y) * (weight * b[i]);
                }
    return out;
}

const WrapLobe kTenLobes[] = {{0, 1, 1},       {0.5, 1, 1},     {1, 1, 1},   {1, 2, 1}, {0.5, 1.5, 1},
                              {0.25, 1.25, 1}, {0.75, 1.75, 1}, {0.3, 4, 1}, {0, 0, 1}, {0.9, 2.5, 1.4}};

}  // namespace

TEST_CASE("equirect: the middle looks along -z, a quarter further along +x, the top up", "[sh][equirect]") {
    CHECK(largest_difference(equirect_direction(0.5, 0.5), {0, 0, -1}) < 1e-15);
    CHECK(largest_difference(equirect_direction(0.75, 0.5), {1, 0, 0}) < 1e-15);
    CHECK(largest_difference(equirect_direction(0.25, 0.5), {-1, 0, 0}) < 1e-15);
    CHECK(largest_difference(equirect_direction(0.0, 0.5), {0, 0, 1}) < 1e-15);
    CHECK(largest_difference(equirect_direction(0.3, 0.0), {0, 1, 0}) < 1e-15);
    CHECK(largest_difference(equirect_direction(0.3, 1.0), {0, -1, 0}) < 1e-15);
}

TEST_CASE("equirect: pixels' solid angles are 2 pi/W (cos theta_0 - cos theta_1), 4 pi in all", "[sh][equirect]") {
    for (const int height : {1, 2, 7, 512}) {
        double sum = 0;
        for (int row = 0; row < height; ++row) {
            const double exact = 2 * kPi / 10 * (std::cos(kPi * row / height) - std::cos(kPi * (row + 1) / height));
            CHECK(pixel_solid_angle(10, height, row) == Approx(exact).epsilon(1e-11));
            sum += 10 * pixel_solid_angle(10, height, row);
        }
        CHECK(sum == Approx(4 * kPi).epsilon(1e-14));
    }
}

TEST_CASE("project: coefficients are the exact integrals over patches, for every width and down to one pixel", "[sh][project]") {
    for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {3, 2}, {6, 3}, {8, 4}, {15, 9}, {22, 10}, {32, 16}}) {
        const Sky sky = random_sky(width, height, 11);
        INFO(width << " x " << height);
        CHECK(worst_difference(Projection(sky.view()).radiance(), by_samples(sky.view())) < 1e-11);
    }
}

TEST_CASE("project: a sky of one colour has band 0 alone, its norm is sqrt(4 pi) times the colour", "[sh][project]") {
    for (const auto& [width, height] : {std::pair{1, 1}, {5, 3}, {64, 32}}) {
        const Projection p(painted_sky(width, height, [](Vec3d) { return Vec3d{1, 0.5, 2}; }).view());
        const RadianceSh sh = p.radiance();
        CHECK(largest_difference(p.mean(), {1, 0.5, 2}) < 1e-14);
        CHECK(largest_difference(sh.c[0], Vec3d{1, 0.5, 2} * std::sqrt(4 * kPi)) < 1e-13);
        for (std::size_t i = 1; i < kMaxCoefficients; ++i) CHECK(largest_difference(sh.c[i], {}) < 1e-13);
        CHECK(p.spectrum().tail_norm.z < 1e-5);
        CHECK(p.spectrum().absolute.y == Approx(2 * kPi).epsilon(1e-14));
    }
}

TEST_CASE("project: mean radiance equals the sum over pixels, and band 0 that times sqrt(4 pi)", "[sh][project]") {
    const Sky sky = random_sky(40, 20, 12);
    Vec3d sum{};
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 40; ++x) sum = sum + sky.view().at(x, y) * (pixel_solid_angle(40, 20, y) / (4 * kPi));
    const Projection p(sky.view());
    CHECK(largest_difference(p.mean(), sum) < 1e-13);
    CHECK(largest_difference(p.radiance(1).c[0], sum * std::sqrt(4 * kPi)) < 1e-12);
}

TEST_CASE("project: the norms are those of the coefficients, and with the tail they give the norm of the image", "[sh][project]") {
    const Sky sky = random_sky(48, 24, 13);
    const Projection p(sky.view());
    const Spectrum spectrum = p.spectrum();
    const RadianceSh sh = p.radiance();
    for (int l = 0; l < kMaxBands; ++l) {
        double square = 0;
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) square += sh.c[static_cast<std::size_t>(i)].y * sh.c[static_cast<std::size_t>(i)].y;
        CHECK(spectrum.norm[static_cast<std::size_t>(l)].y == Approx(std::sqrt(square)).epsilon(1e-12));
    }
    double all = spectrum.tail_norm.y * spectrum.tail_norm.y, exact = 0;
    for (const Vec3d& norm : spectrum.norm) all += norm.y * norm.y;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 48; ++x) exact += sky.view().at(x, y).y * sky.view().at(x, y).y * pixel_solid_angle(48, 24, y);
    CHECK(all == Approx(exact).epsilon(1e-12));
}

TEST_CASE("project: the value of a band in a direction is the sum of its terms there", "[sh][project]") {
    const Projection p(random_sky(30, 15, 14).view());
    const RadianceSh sh = p.radiance();
    for (const Vec3d& d : random_normals(20, 5)) {
        const auto bands = p.bands_at(d);
        double b[kMaxCoefficients];
        evaluate_basis<kMaxBands>(d, b);
        for (int l = 0; l < kMaxBands; ++l) {
            Vec3d sum{};
            for (int i = l * l; i < (l + 1) * (l + 1); ++i) sum = sum + sh.c[static_cast<std::size_t>(i)] * b[i];
            CHECK(largest_difference(bands[static_cast<std::size_t>(l)], sum) < 1e-12);
        }
    }
}

TEST_CASE("project: rows replaced one by one give the other image's projection", "[sh][project]") {
    const Sky a = random_sky(24, 12, 15), b = random_sky(24, 12, 16);
    Projection p(a.view());
    for (int row = 0; row < 12; ++row) {
        p.add_rows(a.view(), row, row + 1, -1.0);
        p.add_rows(b.view(), row, row + 1, 1.0);
    }
    CHECK(worst_difference(p.radiance(), Projection(b.view()).radiance()) < 1e-12);
    CHECK(largest_difference(p.squares(), Projection(b.view()).squares()) < 1e-10);
}

TEST_CASE("project: a function that is a harmonic has one coefficient", "[sh][project]") {
    for (const int k : {0, 3, 17, 50, 99}) {
        const RadianceSh sh = project_function(kMaxBands, 18, [&](Vec3d d) {
            double b[kMaxCoefficients];
            evaluate_basis<kMaxBands>(d, b);
            return Vec3d{b[k], 2 * b[k], 0};
        });
        for (int i = 0; i < kMaxCoefficients; ++i)
            CHECK(largest_difference(sh.c[static_cast<std::size_t>(i)], i == k ? Vec3d{1, 2, 0} : Vec3d{}) < 1e-13);
    }
}

TEST_CASE("convolve: white furnace, a constant sky of 1 gives scale * f_0 for every normal and lobe", "[sh][project]") {
    const RadianceSh sky = Projection(painted_sky(64, 32, [](Vec3d) { return Vec3d{1, 1, 1}; }).view()).radiance();
    for (const WrapLobe& lobe : kTenLobes)
        for (const int bands : {1, 3, 10}) {
            const PreconvolvedSh sh = convolve(sky, zonal_bands(lobe), bands);
            const double expected = lobe.scale * 2 * (1 + lobe.wrap) / (lobe.power + 1);
            for (const Vec3d& n : random_normals(50, 6)) CHECK(largest_difference(evaluate(sh, n), {expected, expected, expected}) < 1e-6);
        }
}

TEST_CASE("convolve: equals brute force if the lobe has no bands above the order", "[sh][project]") {
    const Sky sky = random_sky(32, 16, 17);
    const auto samples = light_samples(sky.view());
    const RadianceSh radiance = Projection(sky.view()).radiance();
    for (const WrapLobe& lobe : {WrapLobe{1, 1, 1}, WrapLobe{1, 2, 1}, WrapLobe{1, 3, 0.7}})
        for (const Vec3d& n : random_normals(50, 7)) {
            const PreconvolvedSh sh = convolve(radiance, zonal_bands(lobe), static_cast<int>(lobe.power) + 1);
            CHECK(largest_difference(evaluate(sh, n), reflected(samples, lobe, n)) < 2e-6);  // float coefficients
        }
}

TEST_CASE("convolve: half-Lambert is Lambert under a hemisphere of 1, its square under 2 cos^2", "[sh][project]") {
    // The skies are symmetric about an axis at an angle theta to the normal. The light that Lambert reflects, as a function of theta, is
    // the lobe: rotating the sky by theta is the same as rotating the normal. Gauss quadrature over the hemisphere, Lambert clamped.
    const auto rule = gauss_legendre(48);
    for (int step = 0; step <= 16; ++step) {
        const double angle = kPi * step / 16, x = std::cos(angle), across = std::sin(angle);
        double uniform = 0, square = 0;
        for (const GaussNode& node : rule) {
            const double z = 0.5 * (node.x + 1), ring = std::sqrt(1 - z * z), weight = 0.5 * node.weight;
            // Integral over phi, around the axis, of max(0, x z + across ring cos phi), in closed form.
            const double level = x * z, swing = across * ring;
            double around = level > 0 ? 2 * kPi * level : 0.0;
            if (swing > std::abs(level)) {
                const double edge = std::acos(-level / swing);
                around = 2 * (level * edge + swing * std::sin(edge));
            }
            uniform += weight * around / kPi;
            square += weight * around / kPi * 2 * z * z;
        }
        CHECK(uniform == Approx((1 + x) / 2).margin(2e-5));  // the kink of the closed form limits the quadrature's accuracy
        CHECK(square == Approx((1 + x) * (1 + x) / 4).margin(2e-5));
    }
}
