// KHR_materials_sheen: against Charlie's distribution integrated in float64, the white furnace, extremes, and every instruction set.
#include "random_case.hpp"
#include "shading/model/sheen_table.hpp"
#include "tests/shading/surface_bench.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;
using halflit::test::painted_sky;
using halflit::test::Random;
using halflit::test::Sky;

namespace {

/// D V2 of the extension's text, for the normal n.
double charlie(Vec3d n, Vec3d l, Vec3d v, double roughness) {
    const double a = std::pow(std::max(0.07, roughness), 2), n_dot_l = dot(n, l), n_dot_v = dot(n, v), n_dot_h = dot(n, unit(l + v));
    const double d = (2 + 1 / a) * std::pow(std::max(0.0, 1 - n_dot_h * n_dot_h), 0.5 / a) / (2 * kPi);
    return d / (4 * (n_dot_l + n_dot_v - n_dot_l * n_dot_v));
}

/// Sum over the hemisphere about n: fn(direction, solid angle times D V2 N.L). Directions are dense at the horizon and opposite the view.
template <class Fn>
void for_each_direction(Vec3d n, Vec3d v, double roughness, int rings, const Fn& fn) {
    const Vec3d across = v - n * dot(n, v);
    const Vec3d x = dot(across, across) > 1e-12 ? unit(across) : unit(cross(std::fabs(n.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}, n));
    const Vec3d y = cross(n, x);
    for (int i = 0; i < rings; ++i) {
        const double t = (i + 0.5) / rings, z = t * t * t, sine = std::sqrt(1 - z * z), height = 3 * t * t / rings;
        for (int j = 0; j < 2 * rings; ++j) {
            const double s = (j + 0.5) / rings - 1, turn = kPi * (s < 0 ? -1 : 1) * (1 - std::pow(1 - std::fabs(s), 2));
            const double width = 2 * kPi * (1 - std::fabs(s)) / rings;
            const Vec3d l = x * (sine * std::cos(turn)) + y * (sine * std::sin(turn)) + n * z;
            fn(l, height * width * charlie(n, l, v, roughness) * z);
        }
    }
}

double albedo(double roughness, double n_dot_v, int rings = 200) {
    double sum = 0;
    for_each_direction({0, 0, 1}, {std::sqrt(1 - n_dot_v * n_dot_v), 0, n_dot_v}, roughness, rings, [&](Vec3d, double w) { sum += w; });
    return sum;
}

double table_albedo(double roughness, double n_dot_v) {
    const double x = std::max(0.07, roughness) * 15, y = 1.2 * n_dot_v / (n_dot_v + 0.2) * 15;
    const int row = std::min(14, static_cast<int>(x)), column = std::min(14, static_cast<int>(y));
    const auto at = [&](int r, int c) { return double{kSheenShapes[(row + r) * 16 + column + c].albedo}; };
    const double u = x - row, w = y - column;
    return (at(0, 0) * (1 - u) + at(1, 0) * u) * (1 - w) + (at(0, 1) * (1 - u) + at(1, 1) * u) * w;
}

struct Bench : SurfaceBench {
    Bench() {
        material.metallic = 0, material.base_color = {0, 0, 0, 1}, material.specular = 0;
        material.sheen_color = {1, 1, 1};
    }
};

}  // namespace

TEST_CASE("sheen: the albedo's table is the integral of Charlie's distribution", "[shading][sheen]") {
    double worst = 0, worst_rough = 0, sum = 0;
    int compared = 0;
    for (int i = 0; i <= 31; ++i)
        for (int j = 1; j <= 30; j += 2) {
            const double roughness = 0.07 + 0.03 * i, n_dot_v = std::pow(j / 30.0, 2);
            const double error = std::fabs(std::min(table_albedo(roughness, n_dot_v), 1.0) - std::min(albedo(roughness, n_dot_v), 1.0));
            worst = std::max(worst, error), sum += error, ++compared;
            if (roughness >= 0.2) worst_rough = std::max(worst_rough, error);
        }
    INFO("worst " << worst << ", from roughness 0.2 on " << worst_rough << ", mean " << sum / compared);
    CHECK(worst < 0.06);         // measured: 0.057 at roughness 0.1
    CHECK(worst_rough < 0.012);  // 0.010
    CHECK(sum / compared < 0.003);
}

TEST_CASE("sheen: a light gives D V2 N.L, divided by the albedo where that is above 1, and the base keeps the rest", "[shading][sheen]") {
    for (const float roughness : {0.2f, 0.5f, 1.0f})
        for (const double view : {0.1, 0.8, 1.3, 1.5})
            for (const double light : {0.2, 0.9, 1.45})
                for (const double turn : {0.0, 1.5, 3.1}) {
                    const Vec3d v = at_angle(view), l = at_angle(light, turn);
                    Bench bench;
                    bench.material.sheen_color = {0.8f, 0.4f, 0};
                    bench.material.sheen_roughness = roughness;
                    bench.material.base_color = {0, 0, 0.5f, 1};
                    bench.add_light(l);
                    const Vec3d got = bench.seen_from(v);
                    const double e = table_albedo(double{roughness}, v.z);
                    const double sheen = kPi * charlie({0, 0, 1}, l, v, double{roughness}) * l.z / std::max(1.0, e);
                    INFO("roughness " << roughness << ", view " << view << ", light " << light << ", turn " << turn);
                    CHECK(got.x == Approx(0.8 * sheen).epsilon(1e-4).margin(1e-7));
                    CHECK(got.y == Approx(0.4 * sheen).epsilon(1e-4).margin(1e-7));
                    CHECK(got.z == Approx(0.5 * l.z * (1 - 0.8 * std::min(e, 1.0))).epsilon(1e-5).margin(1e-7));
                }
}

TEST_CASE("sheen: lights all around reflect the table's albedo, and at most all light", "[shading][sheen]") {
    for (const double roughness : {0.25, 0.5, 1.0})
        for (const double view : {0.3, 1.0, 1.4}) {
            const Vec3d v = at_angle(view);
            Bench bench;
            bench.material.sheen_roughness = static_cast<float>(roughness);
            // The weights of a uniform sky: lights of the cosine's solid angle, without D V2.
            constexpr int kRings = 60;
            for (int i = 0; i < kRings; ++i)
                for (int j = 0; j < 2 * kRings; ++j) {
                    const double t = (i + 0.5) / kRings, z = t * t;
                    const double turn = kPi * (j + 0.5) / kRings, angle = 2 * t / kRings * kPi / kRings;
                    bench.add_light({std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z},
                                    static_cast<float>(angle / kPi));
                }
            const double got = bench.seen_from(v).x;
            INFO("roughness " << roughness << ", view " << view);
            CHECK(got == Approx(std::min(1.0, table_albedo(roughness, v.z))).margin(0.015));  // measured: 0.0103, the table's error
        }
}

TEST_CASE("sheen: in a white furnace a white surface with white sheen reflects all light, and black sheen changes nothing",
          "[shading][sheen][environment]") {
    double worst = 0;
    for (int i = 0; i <= 10; ++i) {
        Bench bench;
        bench.material = Material{};
        bench.material.metallic = 0;
        bench.material.sheen_color = {1, 1, 1}, bench.material.sheen_roughness = static_cast<float>(i / 10.0);
        bench.set_sky(0.75);
        for (int j = 1; j <= 20; ++j)
            worst = std::max(worst, std::fabs(bench.seen_from(at_angle(std::acos(j / 20.0), 0.4 * j)).x / 0.75 - 1));
    }
    INFO("off by " << worst);
    CHECK(worst < 1e-5);
    Bench black;
    black.add_light({0, 0, 1});
    black.material.sheen_color = {0, 0, 0};
    CHECK((black.plan().materials[0].stages & kStageSheen) == 0);
}

TEST_CASE("sheen: light of an environment is near the integral, and nearer than light through Lambert's lobe",
          "[shading][sheen][environment]") {
    const std::array<Sky, 3> skies = three_skies(64);
    Random random(5);
    std::string table;
    // Measured: 0.108, 0.059, 0.033, 0.033 and 0.034, and 0.231, 0.184, 0.164, 0.088 and 0.053 with Lambert's lobe.
    for (const auto& row : {std::pair{0.15, 0.12}, {0.3, 0.065}, {0.5, 0.036}, {0.7, 0.036}, {1.0, 0.037}}) {
        const double roughness = row.first, most = row.second;
        double squares = 0, lambert_squares = 0, worst = 0;
        int compared = 0;
        for (const Sky& sky : skies) {
            double mean = 0, weights = 0;
            for (int y = 0; y < sky.height; ++y)
                for (int x = 0; x < sky.width; ++x) {
                    const double weight = std::sin(kPi * (y + 0.5) / sky.height);
                    mean += weight * double{sky.rgb[static_cast<std::size_t>(3 * (y * sky.width + x))]}, weights += weight;
                }
            mean /= weights;
            Bench bench;
            bench.material.sheen_roughness = static_cast<float>(roughness);
            bench.set_sky(sky);
            for (int i = 0; i < 24; ++i) {
                const double n_dot_v = 0.04 * (i + 1);
                Vec3d n, side;
                do {
                    n = {random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
                    side = {random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
                } while (dot(n, n) > 1 || dot(n, n) < 0.01 || dot(cross(n, side), cross(n, side)) < 0.01);
                n = unit(n), side = unit(cross(n, side));
                const Vec3d v = n * n_dot_v + side * std::sqrt(1 - n_dot_v * n_dot_v);
                double sum = 0, total = 0, lambert = 0, cosines = 0;
                for_each_direction(n, v, roughness, 64, [&](Vec3d l, double w) {
                    const double radiance = radiance_at(sky, l);
                    const double cosine = w / charlie(n, l, v, roughness);
                    sum += w * radiance, total += w;
                    lambert += cosine * radiance, cosines += cosine;
                });
                const double scale = 1 / std::max(1.0, total);
                bench.normal = n;
                const double got = bench.seen_from(v).x, want = sum * scale, other = total * scale * lambert / cosines;
                squares += std::pow((got - want) / mean, 2), lambert_squares += std::pow((other - want) / mean, 2);
                worst = std::max(worst, std::fabs(got - want) / mean);
                ++compared;
            }
        }
        const double rms = std::sqrt(squares / compared), lambert = std::sqrt(lambert_squares / compared);
        table += std::to_string(roughness) + ": " + std::to_string(rms) + ", lambert " + std::to_string(lambert) + ", worst " +
                 std::to_string(worst) + "\n";
        INFO(table);
        CHECK(rms < 0.75 * lambert);
        CHECK(rms < most);
    }
}

TEST_CASE("sheen: extremes of colour, roughness and angle are finite, and the same bits on every set", "[shading][sheen][kernels]") {
    for (const bool sky : {false, true})
        for (const float color : {1e-30f, 0.5f, 1.0f, 7.0f})
            for (const float roughness : {-1.0f, 0.0f, 1e-30f, 0.5f, 1.0f, 1e30f}) {
                Bench bench;
                bench.material.sheen_color = {color, color, color}, bench.material.sheen_roughness = roughness;
                bench.material.base_color = {1, 1, 1, 1};
                bench.material.clearcoat = roughness == 0.5f ? 0.5f : 0.0f;
                for (const double angle : {0.0, 0.7, 1.5707, 1.570797, 3.0}) bench.add_light(at_angle(angle, 2.0));
                if (sky)
                    bench.set_sky(painted_sky(16, 8, [](Vec3d d) { return Vec3d{1 + d.y, 1, 1}; }));
                else
                    bench.ambient = {{0.5f, 0.6f, 0.7f}, {0.1f, 0.1f, 0.1f}};
                for (const double view : {0.0, 1e-4, 0.7, 1.5707, 1.570796, 1.6, 3.1}) {
                    const Vec3d want = bench.seen_from(at_angle(view));
                    INFO("colour " << color << ", roughness " << roughness << ", view " << view);
                    REQUIRE((std::isfinite(want.x) && want.x >= 0));
                    for (const Isa isa : halflit::test::available_isas()) CHECK(bench.seen_from(at_angle(view), isa).x == want.x);
                }
            }
}

TEST_CASE("sheen: colour and roughness follow their textures, and emission is not dimmed", "[shading][sheen]") {
    Bench plain, textured;
    plain.material.sheen_color = {0.4f, 0.1f, 0}, plain.material.sheen_roughness = 0.4f;
    textured.material.sheen_color = {0.8f, 0.5f, 0.7f}, textured.material.sheen_roughness = 0.8f;
    textured.material.textures[TextureSlot::sheen_color].texture = textured.add_texel(0.5, 0.2, 0);
    textured.material.textures[TextureSlot::sheen_roughness].texture = textured.add_texel(1, 1, 1, 0.5);
    for (Bench* bench : {&plain, &textured}) bench->add_light(at_angle(1.0)), bench->material.emissive = {0, 0, 0.5f};
    const Vec3d want = plain.seen_from(at_angle(1.2)), got = textured.seen_from(at_angle(1.2));
    CHECK(got.x == Approx(want.x).epsilon(1e-4));
    CHECK(got.y == Approx(want.y).epsilon(1e-4));
    CHECK(got.z == 0.5);
    CHECK(want.z == 0.5);
}

TEST_CASE("sheen: unlit materials and frames without highlights have no stage for it", "[shading][sheen]") {
    Bench bench;
    bench.add_light({0, 0, 1});
    CHECK((bench.plan().materials[0].stages & kStageSheen) != 0);
    bench.options.specular = SpecularModel::none;
    CHECK((bench.plan().materials[0].stages & kStageSheen) == 0);
    bench.options.specular = SpecularModel::blinn, bench.material.unlit = true;
    CHECK((bench.plan().materials[0].stages & kStageSheen) == 0);
}
