// The light of a sphere of light (apps/lab/sphere_light.hpp) against its integral, the fitted lobes against their neighbours, and the
// figure and the table made from them.
#include "apps/lab/sphere_light.hpp"
#include "halflit/math.hpp"
#include "tests/cli/program.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

using namespace halflit;
using namespace halflit::cli;
using namespace halflit::test;

namespace {

constexpr double kDegree = kPi / 180;

/// The sphere's light by summing max(0, N.d) over directions d that fill it: rings around the centre, each of `kSteps` directions.
/// Divided by the same sum where the normal faces the sphere.
double by_summing(double x, double radius_rad) {
    constexpr int kRings = 400, kSteps = 400;
    const double sine = std::sqrt(1 - x * x);
    double sum = 0, facing = 0;
    for (int i = 0; i < kRings; ++i) {
        const double away = radius_rad * (i + 0.5) / kRings, area = std::sin(away);
        facing += area * std::cos(away) * kSteps;
        for (int j = 0; j < kSteps; ++j)
            sum += area * std::max(0.0, x * std::cos(away) + sine * std::sin(away) * std::cos(2 * kPi * (j + 0.5) / kSteps));
    }
    return sum / facing;
}

double lobe(double w, double n, double x) { return x > -w ? std::pow((x + w) / (1 + w), n) : 0.0; }

/// Root of the mean square difference over x, by the midpoint rule.
double rms_of(double w, double n, const std::vector<double>& light) {
    double sum = 0;
    const auto count = static_cast<double>(light.size());
    for (std::size_t i = 0; i < light.size(); ++i) {
        const double difference = lobe(w, n, (2 * static_cast<double>(i) + 1) / count - 1) - light[i];
        sum += difference * difference;
    }
    return std::sqrt(sum / count);
}

std::vector<double> light_over_x(double radius_rad) {
    std::vector<double> light(4000);
    for (std::size_t i = 0; i < light.size(); ++i)
        light[i] = sphere_light((2 * static_cast<double>(i) + 1) / static_cast<double>(light.size()) - 1, radius_rad);
    return light;
}

}  // namespace

TEST_CASE("sphere light: the closed form is the sum over the sphere, with what is below the horizon left out", "[cli][figures]") {
    for (const double degrees : {1.0, 10.0, 30.0, 45.0, 60.0, 80.0, 89.0, 90.0})
        for (int i = 0; i <= 40; ++i) {
            const double x = -1 + 0.05 * i;
            INFO("s " << degrees << " degrees, x " << x);
            // The midpoint rule's error, largest where the horizon cuts the sphere.
            CHECK(sphere_light(x, degrees * kDegree) == Approx(by_summing(x, degrees * kDegree)).margin(2e-5));
        }
}

TEST_CASE("sphere light: it is Lambert's cosine above the horizon, 0 below, and half-Lambert at 90 degrees", "[cli][figures]") {
    for (const double degrees : {5.0, 30.0, 60.0}) {
        const double reach = std::sin(degrees * kDegree);
        for (const double t : {0.0, 0.3, 0.9, 1.0}) {
            const double x = std::min(1.0, reach + t * (1 - reach));
            CHECK(sphere_light(x, degrees * kDegree) == Approx(x).epsilon(1e-14));
            CHECK(sphere_light(-x, degrees * kDegree) == 0.0);
        }
        // Continuous at both ends.
        CHECK(sphere_light(reach - 1e-9, degrees * kDegree) == Approx(reach).margin(2e-9));
        CHECK(sphere_light(-reach + 1e-9, degrees * kDegree) == Approx(0).margin(1e-8));
    }
    // Lambert's lobe differs most where the horizon halves the sphere: there the sphere's light is (s / sin^2 s - cot s) / pi.
    for (const double s : {0.2, 0.8, 1.5})
        CHECK(lobe_against_sphere({}, s).worst == Approx((s / std::pow(std::sin(s), 2) - 1 / std::tan(s)) / kPi).epsilon(1e-12));
    for (int i = -10; i <= 10; ++i) CHECK(sphere_light(i / 10.0, kPi / 2) == Approx((1 + i / 10.0) / 2).margin(1e-15));
}

TEST_CASE("sphere light: the total over all normals is 2 / (1 + cos s), that of Sloan's a = 1 / cos s - 1 and Green's w = tan^2 (s / 2)",
          "[cli][figures]") {
    for (const double degrees : {10.0, 30.0, 50.0, 60.0, 80.0}) {
        const double s = degrees * kDegree, expected = 2 / (1 + std::cos(s)), a = 1 / std::cos(s) - 1, w = std::pow(std::tan(s / 2), 2);
        const std::vector<double> light = light_over_x(s);
        double total = 0;
        for (const double value : light) total += value * 4 / static_cast<double>(light.size());
        INFO("s " << degrees << " degrees");
        CHECK(total == Approx(expected).epsilon(1e-6));
        CHECK(sh::zonal_bands({w, 1, 1})[0] == Approx(expected).epsilon(1e-12));
        if (a <= 1) CHECK(sh::zonal_bands({a, 1 + a, 1})[0] == Approx(expected).epsilon(1e-12));
    }
}

TEST_CASE("sphere light: no lobe of a grid is nearer than the fitted one", "[cli][figures]") {
    for (const double degrees : {10.0, 30.0, 45.0, 60.0, 75.0, 90.0}) {
        const std::vector<double> light = light_over_x(degrees * kDegree);
        const LobeFit any = fit_sphere_light(LobeFamily::any, degrees * kDegree),
                      green = fit_sphere_light(LobeFamily::green, degrees * kDegree),
                      sloan = fit_sphere_light(LobeFamily::sloan, degrees * kDegree);
        INFO("s " << degrees << " degrees");
        CHECK(any.rms <= sloan.rms + 1e-9);
        CHECK(any.rms <= green.rms + 1e-9);
        CHECK(any.rms == Approx(rms_of(any.lobe.wrap, any.lobe.power, light)).epsilon(1e-3).margin(1e-7));
        CHECK(green.lobe.power == 1.0);
        CHECK(sloan.lobe.power == 1 + sloan.lobe.wrap);
        // The midpoint rule's own error is far below the differences between the grid's lobes.
        for (int i = 0; i <= 50; ++i) {
            const double w = i / 50.0;
            CHECK(rms_of(w, 1, light) >= green.rms - 1e-6);
            CHECK(rms_of(w, 1 + w, light) >= sloan.rms - 1e-6);
            for (double n = 0.8; n < 2.6; n += 0.1) CHECK(rms_of(w, n, light) >= any.rms - 1e-6);
        }
    }
}

TEST_CASE("figures: the sphere of light's curves and fits are those of the library, and the README's table", "[cli][figures]") {
    const std::string text = contents(HALFLIT_SOURCE_DIR "/apps/README.md");
    std::istringstream lines(text);
    int rows = 0;
    for (std::string line; std::getline(lines, line);) {
        double degrees = 0, w = 0, n = 0, any = 0, a = 0, sloan = 0, green_w = 0, green = 0, lambert = 0;
        if (std::sscanf(line.c_str(), "| %lf° | %lf, %lf | %lf | %lf | %lf | %lf | %lf | %lf |", &degrees, &w, &n, &any, &a, &sloan,
                        &green_w, &green, &lambert) != 9)
            continue;
        ++rows;
        const double s = degrees * kDegree;
        const LobeFit fit = fit_sphere_light(LobeFamily::any, s), of_sloan = fit_sphere_light(LobeFamily::sloan, s),
                      of_green = fit_sphere_light(LobeFamily::green, s);
        INFO(line);
        CHECK(w == Approx(fit.lobe.wrap).margin(0.0051));
        CHECK(n == Approx(fit.lobe.power).margin(0.0051));
        CHECK(any == Approx(fit.worst).margin(0.00051));
        CHECK(a == Approx(of_sloan.lobe.wrap).margin(0.0051));
        CHECK(sloan == Approx(of_sloan.worst).margin(0.00051));
        CHECK(green_w == Approx(of_green.lobe.wrap).margin(0.0051));
        CHECK(green == Approx(of_green.worst).margin(0.00051));
        CHECK(lambert == Approx(lobe_against_sphere({}, s).worst).margin(0.00051));
    }
    CHECK(rows == 9);
}
