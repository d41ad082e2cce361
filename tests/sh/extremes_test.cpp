// Cases where float32 fails for spherical harmonics: the formula by angles at the poles, and a sun within the series. The measured figures
// are in sh/README.md ("Extremes"); run with -s to see them.
#include "sh/lobe_error.hpp"
#include "sh/sun.hpp"
#include "tests/sh/sky_images.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

using namespace halflit;
using namespace halflit::sh;
using namespace halflit::test;

namespace {

/// Usual formula by angles, in float: cosine and sine of the azimuth are x / sin theta and y / sin theta.
float by_angles(int l, int m, Vec3f d) {
    const int order = std::abs(m);
    const float theta = std::acos(d.z), sine = std::sqrt(1.0f - d.z * d.z);
    const float legendre = std::sph_legendre(static_cast<unsigned>(l), static_cast<unsigned>(order), theta);
    if (m == 0) return legendre;
    const float cosine_phi = d.x / sine, sine_phi = d.y / sine;
    float c = 1, s = 0;
    for (int i = 0; i < order; ++i) {
        const float turned = c * cosine_phi - s * sine_phi;
        s = s * cosine_phi + c * sine_phi, c = turned;
    }
    return legendre * std::sqrt(2.0f) * (m > 0 ? c : s);
}

struct Errors {
    double worst = 0;
    int samples = 0, not_finite = 0;
};

/// Adds an error in units of sqrt((2l+1)/4pi), the largest value that a function of band l has.
void add(Errors& errors, float got, double want, int l) {
    ++errors.samples;
    if (std::isfinite(got))
        errors.worst = std::max(errors.worst, std::fabs(got - want) / std::sqrt((2 * l + 1) / (4 * kPi)));
    else
        ++errors.not_finite;
}

}  // namespace

TEST_CASE("extremes: the basis by recurrence is as good at the poles as elsewhere, by angles it is not a number there", "[sh][extremes]") {
    Random random(5);
    Errors before_pole, after_pole, before_far, after_far;
    for (int i = 0; i < 1000; ++i) {
        const bool pole = i % 2 == 0;
        const double off = pole ? std::pow(10.0, random.real(-12, -2)) : random.real(0.1, 1.0), turn = random.real(0, 2 * kPi);
        const double z = std::sqrt(1 - off * off) * (i % 4 < 2 ? 1 : -1);
        const Vec3f d{static_cast<float>(off * std::cos(turn)), static_cast<float>(off * std::sin(turn)), static_cast<float>(z)};
        float y[kMaxCoefficients];
        double exact[kMaxCoefficients];
        evaluate_basis<kMaxBands>(d, y);
        const Vec3d wide{d.x, d.y, d.z};
        evaluate_basis<kMaxBands>(wide * (1.0 / length(wide)), exact);
        for (int l = 0; l < kMaxBands; ++l)
            for (int m = -l; m <= l; ++m) {
                const auto k = static_cast<std::size_t>(coefficient_index(l, m));
                add(pole ? before_pole : before_far, by_angles(l, m, d), exact[k], l);
                add(pole ? after_pole : after_far, y[k], exact[k], l);
            }
    }
    INFO("poles: before " << before_pole.worst << ", " << 100.0 * before_pole.not_finite / before_pole.samples << " % not finite; after "
                          << after_pole.worst << ". elsewhere: before " << before_far.worst << ", after " << after_far.worst);
    CHECK(before_pole.not_finite > 0);
    CHECK(after_pole.not_finite + after_far.not_finite == 0);
    // 25 eps from the recurrence in band 9, plus 45 times the error in |d| from rounding to float, which is at most sqrt(3) 2^-25.
    CHECK(after_pole.worst <= (25 + 45) * 0x1p-24);
    CHECK(after_far.worst <= (25 + 45) * 0x1p-24);
}

TEST_CASE("extremes: a sun of 100000 times the sky gives light of -3960 inside the series and none below the sky's as a light of its own",
          "[sh][extremes]") {
    // Sky of 1, and a sun from one direction whose light on a surface that faces it is 1e5. Its band l in the series is f_l (2l+1)/4 P_l:
    // f_l the lobe's factor, P_l the Legendre polynomial.
    constexpr double kSun = 1e5;
    for (const double a : {0.0, 0.9}) {
        const WrapLobe lobe{a, 1 + a, 1.0};
        const BandFactors f = zonal_bands(lobe);
        const double sky = f[0];
        double lowest_before = 1e30, lowest_after = 1e30;
        int negative = 0;
        constexpr int kSteps = 20000;
        for (int i = 0; i <= kSteps; ++i) {
            const double x = -1 + 2.0 * i / kSteps;
            float in_series = static_cast<float>(sky), legendre[3] = {1.0f, static_cast<float>(x), static_cast<float>(1.5 * x * x - 0.5)};
            for (int l = 0; l < 3; ++l)
                in_series += static_cast<float>(kSun) * static_cast<float>(f[static_cast<std::size_t>(l)] * (2 * l + 1) / 4) * legendre[l];
            negative += in_series < 0;
            lowest_before = std::min<double>(lowest_before, in_series);
            lowest_after = std::min(lowest_after, kSun * lobe_value(lobe, x) + sky);
        }
        INFO("a " << a << ": before lowest " << lowest_before << ", " << 100.0 * negative / kSteps << " % below 0; after lowest "
                  << lowest_after);
        CHECK(lowest_before == Approx(kSun * truncation_error(lobe, 3).min + sky).epsilon(0.01));
        if (a == 0.0) CHECK(lowest_before == Approx(-19.0 / 480 * kSun + 1).epsilon(1e-3));
        CHECK(lowest_after == sky);
    }
}

TEST_CASE("extremes: a sun of 100000 times the sky taken out of an image leaves the sky alone", "[sh][extremes]") {
    // Same case through the functions that a frame uses: an image with a sun of 1e5 times the sky's light.
    const double radius = 1.2, edge = std::cos(radius * kPi / 180), solid = 2 * kPi * (1 - edge);
    const Vec3d towards{0.36, 0.48, 0.8};
    const Sky image = painted_sky(512, 256, [&](Vec3d d) {
        const double light = dot(d, towards) > edge ? 1.0 + 1e5 * kPi / solid : 1.0;
        return Vec3d{light, light, light};
    });
    const Projection whole(image.view());
    const SunExtraction parts = extract_suns(image.view(), whole);
    REQUIRE(parts.suns.size() == 1);
    const WrapLobe lambert{0.0, 1.0, 1.0};
    const PreconvolvedSh with_sun = convolve(whole.radiance(), zonal_bands(lambert), 3);
    const PreconvolvedSh sky = convolve(parts.residual.radiance(), zonal_bands(lambert), 3);
    double lowest_before = 1e30, lowest_after = 1e30, worst = 0;
    int negative = 0, count = 0;
    for (const Vec3d& n : random_normals(4000, 9)) {
        const double before = evaluate(with_sun, n).x, residual = evaluate(sky, n).x;
        lowest_before = std::min(lowest_before, before);
        lowest_after = std::min(lowest_after, residual);
        worst = std::max(worst, std::fabs(residual - 1.0));
        negative += before < 0, ++count;
    }
    const double sun = parts.suns[0].irradiance.x / kPi;
    INFO("sun " << sun << ": before lowest " << lowest_before << ", " << 100.0 * negative / count << " % below 0; after lowest "
                << lowest_after << ", off by at most " << worst);
    CHECK(sun == Approx(1e5).epsilon(0.05));
    CHECK(lowest_before < -0.035 * sun);
    // Pixels of the sun that stay in the sky, at up to eight times the sky's radiance: 0.0013 sr of them.
    CHECK(lowest_after > 0.999);
    CHECK(worst < 0.003);
    const double energy = parts.residual.mean().x * 4 * kPi + parts.suns[0].irradiance.x;
    CHECK(energy == Approx(whole.mean().x * 4 * kPi).epsilon(1e-12));
}
