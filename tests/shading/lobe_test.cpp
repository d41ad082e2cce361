// The wrap family against its closed forms, through the shading kernel: one white material, one directional light of colour 1.
#include "floats.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/planner.hpp"
#include "shading/reference/reference.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/white_lobe.hpp"

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;

namespace {

/// Lobe f(x) at 64 values of x = N.L. The normals are (x, sqrt(1 - x^2), 0) and the light comes from +x, so that the dot product is x. It
/// is exact for x = -1, 0 and 1.
struct Curve {
    float x[kBlockSize], value[kBlockSize];
};

Curve curve_of(const Lobe& lobe) {
    const ShadingPlan plan = test::plan_of_white(lobe);
    FragmentBlock block{};
    Curve curve{};
    for (int i = 0; i < kBlockSize; ++i) {
        const double x = -1.0 + 2.0 * i / (kBlockSize - 1);
        block.lane[kNormalX][i] = static_cast<float>(x);
        block.lane[kNormalY][i] = static_cast<float>(std::sqrt(1.0 - x * x));
    }
    block.lane[kNormalX][31] = 0.0f, block.lane[kNormalY][31] = 1.0f;
    shade_kernels(Isa::scalar).shade(plan, plan.materials[0], all_lights(plan), block, kBlockSize);
    for (int i = 0; i < kBlockSize; ++i) {
        // x of the normalised normal, in double.
        const double nx = block.lane[kNormalX][i], ny = block.lane[kNormalY][i];
        curve.x[i] = static_cast<float>(nx / std::hypot(nx, ny));
        curve.value[i] = block.red[i];
    }
    return curve;
}

constexpr int kAtZero = 31;

const std::vector<Lobe>& many_lobes() {
    static const std::vector<Lobe> lobes = [] {
        std::vector<Lobe> all{Lobe::lambert(), Lobe::half_lambert(), Lobe::valve()};
        for (const float w : {0.0f, 0.1f, 0.25f, 1.0f / 3.0f, 0.5f, 0.7f, 0.9f, 1.0f}) {
            all.push_back(Lobe::green(w));
            all.push_back(Lobe::sloan(w));
            for (const float n : {0.5f, 1.0f, 1.5f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 20.0f, 100.0f}) all.push_back(Lobe::mcauley(w, n));
        }
        return all;
    }();
    return lobes;
}

}  // namespace

TEST_CASE("lobe: every path agrees with scale * max(0, (x + w) / (1 + w))^n", "[shading][lobe]") {
    for (const Lobe& lobe : many_lobes()) {
        const Curve curve = curve_of(lobe);
        for (int i = 0; i < kBlockSize; ++i) {
            INFO("w " << lobe.wrap << ", n " << lobe.power << ", x " << curve.x[i]);
            // x is accurate to 1e-7. The slope of the lobe, at most n / (1 + w), multiplies that error (n < 1: no bound at the edge).
            const double slope = std::max(1.0, static_cast<double>(lobe.power)) * lobe.scale();
            const double allowed = lobe.power < 1.0f ? 1e-3 : 5e-7 * slope;
            CHECK(std::fabs(curve.value[i] - reference::lobe_value(lobe, curve.x[i])) <= allowed);
        }
    }
}

TEST_CASE("lobe: f(1) is exactly the scale and f(-1) exactly 0, for every lobe", "[shading][lobe]") {
    for (const Lobe& lobe : many_lobes()) {
        const Curve curve = curve_of(lobe);
        INFO("w " << lobe.wrap << ", n " << lobe.power);
        CHECK(curve.value[kBlockSize - 1] == lobe.scale());
        CHECK(curve.value[0] == 0.0f);
    }
}

TEST_CASE("lobe: zero up to x = -w, positive beyond, and never falling", "[shading][lobe]") {
    for (const Lobe& lobe : many_lobes()) {
        const Curve curve = curve_of(lobe);
        float previous = 0.0f;
        for (int i = 0; i < kBlockSize; ++i) {
            INFO("w " << lobe.wrap << ", n " << lobe.power << ", x " << curve.x[i]);
            if (curve.x[i] < -lobe.wrap - 1e-6f) CHECK(curve.value[i] == 0.0f);
            // The general path rounds to zero below 2^-100.
            if (curve.x[i] > -lobe.wrap + 1e-3f && reference::lobe_value(lobe, curve.x[i]) > 1e-27) CHECK(curve.value[i] > 0.0f);
            CHECK(curve.value[i] >= previous);
            previous = curve.value[i];
        }
    }
}

TEST_CASE("lobe: the clamp is max(0, x + w), not max(0, x) + w", "[shading][lobe]") {
    // A light at 90 degrees to the normal gives (w / (1 + w))^n, and the back side of a half wrapped ball is dark.
    const Curve half = curve_of(Lobe::green(0.5f));
    CHECK(half.value[kAtZero] == Approx(1.0 / 3.0).epsilon(1e-6));
    CHECK(half.value[0] == 0.0f);
    for (int i = 0; i < kBlockSize; ++i)
        if (curve_of(Lobe::green(0.5f)).x[i] < -0.51f) CHECK(half.value[i] == 0.0f);
    CHECK(curve_of(Lobe::valve()).value[kAtZero] == 0.25f);
}

TEST_CASE("lobe: sloan with a = 0 is Lambert and with a = 1 is Valve's, bit for bit", "[shading][lobe]") {
    const Curve lambert = curve_of(Lobe::lambert()), sloan0 = curve_of(Lobe::sloan(0.0f));
    const Curve valve = curve_of(Lobe::valve()), sloan1 = curve_of(Lobe::sloan(1.0f));
    for (int i = 0; i < kBlockSize; ++i) {
        CHECK(same_bits(lambert.value[i], sloan0.value[i]));
        CHECK(same_bits(valve.value[i], sloan1.value[i]));
    }
}

TEST_CASE("lobe: Lambert is max(0, N.L)", "[shading][lobe]") {
    const Curve curve = curve_of(Lobe::lambert());
    for (int i = 0; i < kBlockSize; ++i) CHECK(std::fabs(curve.value[i] - std::max(0.0f, curve.x[i])) <= 2e-7f);
}

TEST_CASE("lobe: power 0 is a step that leaves the back side dark", "[shading][lobe]") {
    const Curve curve = curve_of({0.5f, 0.0f, false});
    for (int i = 0; i < kBlockSize; ++i) {
        if (std::fabs(curve.x[i] + 0.5f) < 1e-3f) continue;
        CHECK(curve.value[i] == (curve.x[i] > -0.5f ? 1.0f : 0.0f));
    }
}

TEST_CASE("lobe: the normalised family has Lambert's mean over all light directions", "[shading][lobe]") {
    // The integral of f over x in [-1, 1] is 1/2 for Lambert; with scale (n+1) / (2 (1+w)) it is for every lobe. Simpson's rule on the
    // reference.
    for (const Lobe& lobe : many_lobes()) {
        if (lobe.power < 1.0f) continue;
        Lobe normalized = lobe;
        normalized.normalize = true;
        constexpr int kSteps = 20000;
        const double low = -static_cast<double>(lobe.wrap), h = (1.0 - low) / kSteps;
        double sum = 0;
        for (int i = 0; i <= kSteps; ++i) {
            const double weight = i == 0 || i == kSteps ? 1 : (i % 2 == 1 ? 4 : 2);
            sum += weight * reference::lobe_value(normalized, low + h * i);
        }
        INFO("w " << lobe.wrap << ", n " << lobe.power);
        CHECK(sum * h / 3 == Approx(0.5).epsilon(1e-5));
    }
}

TEST_CASE("lobe: half-Lambert is Lambert under a sky of constant light, and its square under 2 cos^2", "[shading][lobe]") {
    // Irradiance / pi of a surface tilted by theta under a hemisphere of radiance 1, and of radiance 2 cos^2: midpoint quadrature over the
    // sky.
    constexpr int kSteps = 400;
    for (const double theta : {0.0, 0.4, 1.0, 1.5707963, 2.2, 3.0}) {
        double constant = 0, squared = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double z = (i + 0.5) / kSteps, s = std::sqrt(1 - z * z);
            for (int j = 0; j < 2 * kSteps; ++j) {
                const double phi = 3.14159265358979 * (j + 0.5) / kSteps;
                const double cosine = std::max(0.0, s * std::cos(phi) * std::sin(theta) + z * std::cos(theta));
                constant += cosine, squared += 2 * z * z * cosine;
            }
        }
        const double cell = (1.0 / kSteps) * (1.0 / kSteps);  // d(solid angle) / pi
        INFO("theta " << theta);
        CHECK(reference::lobe_value(Lobe::half_lambert(), std::cos(theta)) == Approx(constant * cell).margin(1e-4));
        CHECK(reference::lobe_value(Lobe::valve(), std::cos(theta)) == Approx(squared * cell).margin(1e-4));
    }
}
