// Highlights of lights by GGX: against the textbook's formulas in float64, the white furnace, and extremes.
#include "random_case.hpp"
#include "tests/shading/surface_bench.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;

namespace {

constexpr double kPiHere = 3.14159265358979323846;

struct Bench : SurfaceBench {
    Bench() { options.specular = SpecularModel::ggx; }
    [[nodiscard]] float seen_from(Vec3d to_eye, Isa isa = Isa::scalar) const {
        return static_cast<float>(SurfaceBench::seen_from(to_eye, isa).x);
    }
};

/// pi D V (N.L) [Walter07, Heitz14], without the Fresnel factor.
double single_bounce(Vec3d l, Vec3d v, double roughness) {
    const double a = roughness * roughness, n_dot_l = l.z, n_dot_v = v.z;
    const Vec3d h = unit(l + v);
    const double t = h.z * h.z * (a * a - 1) + 1;
    const double d = a * a / (kPiHere * t * t);
    const auto lambda = [&](double c) { return 0.5 * (std::sqrt(1 + a * a * (1 - c * c) / (c * c)) - 1); };
    const double g2 = 1 / (1 + lambda(n_dot_l) + lambda(n_dot_v));
    return kPiHere * d * g2 / (4 * n_dot_v);
}

}  // namespace

TEST_CASE("ggx: a black metal has no highlight but Fresnel's, which is Walter's formula times (1 - V.H)^5", "[shading][ggx]") {
    for (const double roughness : {0.1, 0.3, 0.6, 1.0})
        for (const double view : {0.1, 0.7, 1.3})
            for (const double light : {0.2, 0.8, 1.4})
                for (const double turn : {0.0, 2.0, 3.1}) {
                    const Vec3d v = at_angle(view), l = at_angle(light, turn);
                    Bench bench;
                    bench.material.base_color = {0, 0, 0, 1};
                    bench.material.roughness = static_cast<float>(roughness);
                    bench.add_light(l, 1);
                    const double want = single_bounce(l, v, roughness) * std::pow(1 - dot(v, unit(l + v)), 5);
                    INFO("roughness " << roughness << ", view " << view << ", light " << light << ", turn " << turn);
                    CHECK(double{bench.seen_from(v)} == Approx(want).epsilon(1e-3 * std::max(0.01, 0.1 - roughness * 0.1)).margin(1e-7));
                }
}

TEST_CASE("ggx: in a white furnace a white metal of any roughness reflects all light, within the table's error", "[shading][ggx]") {
    // Lights about half vectors that are spread as D; the solid angle of a light is 4 (V.H) that of its half vector.
    constexpr int kRings = 40, kAround = 96;
    for (const double roughness : {0.05, 0.07, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0})
        for (const double view : {0.0, 0.5, 0.9, 1.2, 1.4}) {
            const double a = std::pow(std::max(0.07, roughness), 2);
            const Vec3d v = at_angle(view);
            Bench bench;
            bench.material.roughness = static_cast<float>(roughness);
            for (int i = 0; i < kRings; ++i) {
                const double s = (i + 0.5) / kRings, u = s * s * (3 - 2 * s), share = 6 * s * (1 - s) / kRings / kAround;
                const double cosine = 1 / std::sqrt(1 + a * a * u / (1 - u));
                for (int j = 0; j < kAround; ++j) {
                    const Vec3d h = at_angle(std::acos(cosine), 2 * kPiHere * (j + 0.5) / kAround);
                    const Vec3d l = h * (2 * dot(v, h)) - v;
                    if (dot(v, h) <= 0 || l.z <= 0) continue;
                    const double t = cosine * cosine * (a * a - 1) + 1, d = a * a / (kPiHere * t * t);
                    bench.add_light(l, share / (d * cosine) * 4 * dot(v, h) / kPiHere);
                }
            }
            const double got = double{bench.seen_from(v)};
            INFO("roughness " << roughness << ", view " << view);
            CHECK(std::fabs(got - 1) < 0.01);  // measured: 0.0042; A + B of the table
        }
}

TEST_CASE("ggx: roughness below the least counts as the least, and the peak is 1 / (4 a^2) where all look along the normal",
          "[shading][ggx]") {
    for (const float roughness : {0.0f, 1e-30f, 0.05f, 0.07f, 0.2f, 1.0f}) {
        Bench bench;
        bench.material.metallic = 0, bench.material.base_color = {0, 0, 0, 1};
        bench.material.roughness = roughness;
        bench.add_light({0, 0, 1}, 1);
        const double a = std::pow(std::max(0.07, double{roughness}), 2);
        // F0 = 0.04; light that bounces adds up to 0.04 times 1 / (A + B) - 1.
        const double least = 0.04 / (4 * a * a);
        const double got = double{bench.seen_from({0, 0, 1})};
        INFO("roughness " << roughness);
        CHECK(got >= least * (1 - 1e-5));
        CHECK(got <= least * 1.1);
    }
}

TEST_CASE("ggx: light from behind, or opposite the viewer at a grazing view, makes no highlight and no NaN", "[shading][ggx]") {
    for (const float roughness : {0.0f, 0.3f, 1.0f})
        for (const double angle : {0.3, 1.0, 1.5, 1.5707, 1.570796}) {
            Bench bench;
            bench.material.roughness = roughness;
            bench.add_light(at_angle(angle, kPiHere) * -1.0, 1);  // below the surface
            CHECK(bench.seen_from(at_angle(angle)) == 0.0f);
            Bench opposite;
            opposite.material.roughness = roughness;
            opposite.add_light(at_angle(1.5707963, kPiHere), 1);
            const float got = opposite.seen_from(at_angle(1.5707963));
            CHECK(got == 0.0f);
        }
}

TEST_CASE("ggx: values are finite and positive for grazing, tiny and huge lights, and agree with float64", "[shading][ggx]") {
    FloatMaker make(71);
    int compared = 0;
    for (int round = 0; round < 3000; ++round) {
        Bench bench;
        bench.material.roughness = make.below(4) == 0 ? 0.0f : make.ordinary(0, 1);
        bench.material.base_color = {make.ordinary(0, 1), 0.5f, 0.5f, 1};
        bench.material.metallic = make.below(2) == 0 ? 1.0f : 0.0f;
        const float strengths[] = {1e-30f, 1e-6f, 1.0f, 1e6f, 1e30f};
        const double strength = double{strengths[make.below(5)]};
        const auto direction = [&] {
            const double height = make.below(3) == 0 ? double{make.ordinary(0, 0.01f)} : double{make.ordinary(0, 1)};
            return at_angle(std::acos(height), double{make.ordinary(0, 6.28f)});
        };
        const Vec3d v = direction();
        bench.add_light(direction(), strength);
        const double got = double{bench.seen_from(v)};
        REQUIRE(std::isfinite(got));
        REQUIRE(got >= 0.0);
        const Light& light = bench.lights[0];
        reference::FrameInputs frame{{}, bench.lights, {}, bench.options, {}, {}, true};
        frame.view_direction_ws = {static_cast<float>(-v.x), static_cast<float>(-v.y), static_cast<float>(-v.z)};
        FragmentBlock block{};
        block.lane[kNormalZ][0] = 1.0f;
        const double want = reference::shade(frame, bench.material, 3u, block, 0).r;
        // H is off by 2.5e-7 / |L + V|, and ln D changes by at most 2 / a per radian.
        const Vec3d l = unit(to_double(light.direction_ws) * -1.0), both = l + v;
        const double a = std::pow(std::max(0.07, double{bench.material.roughness}), 2), length = std::sqrt(dot(both, both));
        if (std::fabs(both.z - 1e-3) < 1e-6) continue;
        const double relative = 2 / a * (4e-7 + 2.5e-7 / length) + 1e-5 + 4e-7 / std::max(1e-7, l.z) + 4e-7 / length;
        INFO("round " << round << ", roughness " << bench.material.roughness << ", N.L " << l.z << ", N.V " << v.z);
        CHECK(std::fabs(got - want) <= relative * want + 1e-37);
        ++compared;
    }
    CHECK(compared > 2500);
}

TEST_CASE("ggx: seen straight on, a dielectric's highlight is F0 of Walter's formula, times the weight of KHR_materials_specular",
          "[shading][ggx]") {
    // V.H = cos 0.2 there: Schlick's fifth power is below 4e-9, and light that bounces adds at most F0 times 1.5.
    for (const float weight : {1.0f, 0.5f})
        for (const float color : {1.0f, 0.25f, 3.0f}) {
            const Vec3d v{0, 0, 1}, l = at_angle(0.4);
            Bench bench;
            bench.material.base_color = {0, 0, 0, 1};
            bench.material.metallic = 0, bench.material.roughness = 0.4f;
            bench.material.specular = weight, bench.material.specular_color = {color, 1, 1};
            bench.add_light(l, 1);
            const double f0 = 0.04 * double{color} * double{weight}, want = f0 * single_bounce(l, v, 0.4);
            const double got = double{bench.seen_from(v)};
            INFO("weight " << weight << ", colour " << color);
            CHECK(got >= want * (1 - 1e-4));
            CHECK(got <= want * (1 + 1.5 * f0));
        }
}

TEST_CASE("ggx: every set gives scalar's bits for 2,000 lights around", "[shading][ggx][kernels]") {
    FloatMaker make(72);
    Bench bench;
    bench.material.roughness = 0.25f, bench.material.metallic = 0.5f;
    for (int i = 0; i < 2000; ++i)
        bench.add_light(at_angle(double{make.ordinary(0, 3.1f)}, double{make.ordinary(0, 6.28f)}), double{make.ordinary(0, 1)});
    const float want = bench.seen_from(at_angle(0.8));
    CHECK(want > 0.0f);
    for (const Isa isa : halflit::test::available_isas()) CHECK(bench.seen_from(at_angle(0.8), isa) == want);
}
