// Energy of highlights: a surface that reflects all light, F0 = 1, under light of one direction.
#include "sh/trig.hpp"
#include "shading/model/scalar.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

using namespace halflit;

namespace {

/// Share of the light from `angle` off the normal that is reflected in all directions: the integral of N.V times the highlight over N.L,
/// by the midpoint rule. The highlight is norm (N.H)^s N.L / pi or norm (R.V)^(s/4) N.L / pi.
double reflected_share(double s, double norm, bool phong, double angle) {
    constexpr int kRings = 400, kSectors = 400;
    const double lx = std::sin(angle), lz = std::cos(angle);
    double sum = 0.0;
    for (int i = 0; i < kRings; ++i) {
        // Rings of equal projected solid angle: sin^2 of the angle off the normal is uniform, which takes N.V and the Jacobian along.
        const double sine_squared = (i + 0.5) / kRings, vz = std::sqrt(1 - sine_squared), across = std::sqrt(sine_squared);
        for (int j = 0; j < kSectors; ++j) {
            const double turn = 2 * kPi * (j + 0.5) / kSectors, vx = across * std::cos(turn), vy = across * std::sin(turn);
            const double hx = vx + lx, hz = vz + lz;
            const double cosine = phong ? -lx * vx + lz * vz : hz / std::sqrt(hx * hx + vy * vy + hz * hz);
            if (cosine > 0) sum += std::pow(cosine, phong ? s / 4 : s);
        }
    }
    return norm * sum / (kRings * kSectors);
}

}  // namespace

TEST_CASE("energy: a highlight reflects no more light than it receives, and nearly all of it straight back", "[shading]") {
    for (const bool phong : {false, true})
        for (const double s : {0.0, 1.0, 2.0, 4.0, 8.0, 16.0, 60.0, 200.0, 1000.0}) {
            const double norm = specular_normalization(0.5 * s, phong);
            INFO((phong ? "phong" : "blinn") << ", s = " << s);
            const double facing = reflected_share(s, norm, phong, 0.0);
            CHECK(facing <= 1.0005);
            CHECK(facing >= 0.97);
            for (const double angle : {0.3, 0.7, 1.0, 1.3, 1.5}) CHECK(reflected_share(s, norm, phong, angle) <= 1.0005);
        }
}
