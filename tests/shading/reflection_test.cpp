// Reflections of environments against direct integration of GGX in float64, and against the usual split sum.
#include "shading/kernels/shade_kernels.hpp"
#include "shading/model/reflection_tables.hpp"
#include "shading/planner.hpp"
#include "tests/sh/sky_images.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

using namespace halflit;
using namespace halflit::shading;
using halflit::test::painted_sky;
using halflit::test::Random;
using halflit::test::Sky;

namespace {

double step(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}
Vec3d grey(double v) { return {v, v, v}; }
Vec3d unit(Vec3d v) { return v * (1 / std::sqrt(dot(v, v))); }

/// Bright panels in a dark room; a sky with a horizon and a glow; smooth noise.
std::array<Sky, 3> skies() {
    const auto panel = [](Vec3d d, Vec3d at, double size) { return step(std::cos(size * 1.1), std::cos(size), dot(d, unit(at))); };
    return {
        painted_sky(
            512, 256,
            [&](Vec3d d) {
                return grey(0.1 + 12 * panel(d, {1, 1, 1}, 0.35) + 6 * panel(d, {-1, 0.5, 0.4}, 0.25) + 4 * panel(d, {0, 1, -0.3}, 0.5));
            }),
        painted_sky(512, 256,
                    [](Vec3d d) {
                        const double glow = std::max(0.0, dot(d, unit({0.6, 0.25, -0.7})));
                        return Vec3d{0.6, 0.7, 1.0} * (0.2 + step(-0.03, 0.03, d.y) * (0.8 + 0.5 * d.y)) +
                               Vec3d{1, 0.8, 0.5} * (8 * std::pow(glow, 60));
                    }),
        painted_sky(512, 256, [](Vec3d d) { return grey(1 + 0.9 * std::sin(5 * d.x + 2 * d.y) * std::cos(7 * d.z - d.x)); })};
}

/// Bilinear, as the pixels of a picture.
Vec3d radiance(const Sky& sky, Vec3d d) {
    const sh::EquirectPoint p = sh::equirect_point(d);
    const double x = p.u * sky.width - 0.5, y = std::clamp(p.v * sky.height - 0.5, 0.0, sky.height - 1.0);
    const int i = static_cast<int>(std::floor(x)), j = std::min(static_cast<int>(y), sky.height - 2);
    const auto at = [&](int a, int b) { return sky.view().at((a + sky.width) % sky.width, b); };
    const Vec3d upper = at(i, j) * (1 - (x - i)) + at(i + 1, j) * (x - i),
                lower = at(i, j + 1) * (1 - (x - i)) + at(i + 1, j + 1) * (x - i);
    return upper * (1 - (y - j)) + lower * (y - j);
}

double smith(double n_dot_l, double n_dot_v, double a) {
    return 0.5 /
           (n_dot_l * std::sqrt(n_dot_v * n_dot_v * (1 - a * a) + a * a) + n_dot_v * std::sqrt(n_dot_l * n_dot_l * (1 - a * a) + a * a));
}

/// Sum over half vectors, spread as GGX's distribution: fn(L, weight without F, (1 - V.H)^5).
template <class Fn>
void for_each_half_vector(double a, Vec3d n, Vec3d v, int rings, const Fn& fn) {
    const Vec3d x = unit(cross(std::fabs(n.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}, n)), y = cross(n, x);
    const int around = 2 * rings;
    for (int i = 0; i < rings; ++i) {
        const double s = (i + 0.5) / rings, u = s * s * (3 - 2 * s), share = 6 * s * (1 - s) / rings / around;
        const double cosine = 1 / std::sqrt(1 + a * a * u / (1 - u)), sine = std::sqrt(1 - cosine * cosine);
        for (int j = 0; j < around; ++j) {
            const double turn = 2 * kPi * (j + 0.5) / around;
            const Vec3d h = x * (sine * std::cos(turn)) + y * (sine * std::sin(turn)) + n * cosine;
            const double v_dot_h = dot(v, h);
            const Vec3d l = h * (2 * v_dot_h) - v;
            const double n_dot_l = dot(n, l);
            if (v_dot_h <= 0 || n_dot_l <= 0) continue;
            fn(l, share * smith(n_dot_l, dot(n, v), a) * n_dot_l * 4 * v_dot_h / cosine, std::pow(1 - v_dot_h, 5));
        }
    }
}

struct Integrals {
    double a = 0, b = 0;   ///< of a uniform sky
    Vec3d base{}, edge{};  ///< of the sky, with 1 - w and w, w = (1 - V.H)^5
    [[nodiscard]] Vec3d light(double f0) const { return base * f0 + edge; }
};
Integrals ggx(const Sky* sky, double roughness, Vec3d n, Vec3d v, int rings) {
    Integrals out;
    const double alpha = roughness * roughness;
    for_each_half_vector(alpha, n, v, rings, [&](Vec3d l, double weight, double w) {
        out.a += weight * (1 - w), out.b += weight * w;
        if (sky == nullptr) return;
        const Vec3d light = radiance(*sky, l) * weight;
        out.base = out.base + light * (1 - w), out.edge = out.edge + light * w;
    });
    return out;
}

/// Mean radiance as the split sum takes it: N = V = R, weighted by N.L.
Vec3d split_sum(const Sky& sky, double roughness, Vec3d r, int rings) {
    Vec3d sum{};
    double weights = 0;
    const double alpha = roughness * roughness;
    for_each_half_vector(alpha, r, r, rings, [&](Vec3d l, double, double) {
        const double weight = dot(r, l);
        sum = sum + radiance(sky, l) * weight, weights += weight;
    });
    return sum * (1 / weights);
}

/// Colours that the kernels give a material without any other light, for the lanes of a block.
class Drawn {
public:
    Drawn(const Sky& sky, float roughness, float metallic, float dielectric, Vec3f base) {
        EnvironmentOptions options;
        options.extract_suns = false;
        environment_ = std::make_shared<Environment>(shading::make_environment(sky.view(), options));
        material_.base_color = {base.x, base.y, base.z, 1};
        material_.roughness = roughness, material_.metallic = metallic, material_.dielectric_reflectance = dielectric;
    }
    /// N.V = n_dot_v about the normal n.
    Vec3d at(Vec3d n, double n_dot_v, double turn, Vec3d* towards = nullptr) {
        const Vec3d x = unit(cross(std::fabs(n.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}, n)), y = cross(n, x);
        const double sine = std::sqrt(1 - n_dot_v * n_dot_v);
        const Vec3d v = x * (sine * std::cos(turn)) + y * (sine * std::sin(turn)) + n * n_dot_v;
        if (towards != nullptr) *towards = v;
        const SlotMask slots[] = {kBaseSlots, kBaseSlots};
        const Vec3f eye{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
        if (plan_.materials.empty())
            plan_ = plan_shading({.materials = {&material_, 1},
                                  .textures = {},
                                  .available_slots = slots,
                                  .lights = {},
                                  .ambient = {},
                                  .options = {},
                                  .environment = environment_},
                                 memory_);
        plan_.orthographic = true;
        plan_.view_direction_ws = eye * -1.0f;
        FragmentBlock block{};
        block.lane[kNormalX][0] = static_cast<float>(n.x), block.lane[kNormalX + 1][0] = static_cast<float>(n.y);
        block.lane[kNormalX + 2][0] = static_cast<float>(n.z);
        shade_kernels(Isa::scalar).shade(plan_, plan_.materials[0], all_lights(plan_), block, 1);
        return {block.red[0], block.green[0], block.blue[0]};
    }

private:
    Material material_;
    std::shared_ptr<const Environment> environment_;
    PlanMemory memory_;
    ShadingPlan plan_;
};

double largest(Vec3d v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

Vec3d random_direction(Random& random) {
    for (;;) {
        const Vec3d d{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
        if (dot(d, d) < 1 && dot(d, d) > 0.01) return unit(d);
    }
}

}  // namespace

TEST_CASE("reflections: A and B are GGX's integrals under a uniform sky", "[shading][environment]") {
    double worst = 0, sum = 0;
    int compared = 0;
    for (int i = 0; i <= 20; ++i)
        for (int j = 1; j <= 20; ++j) {
            const double roughness = std::max(0.07, i / 20.0), n_dot_v = j / 20.0;
            const Integrals want = ggx(nullptr, roughness, {0, 0, 1}, {std::sqrt(1 - n_dot_v * n_dot_v), 0, n_dot_v}, 200);
            // The table as its text says, between its nodes.
            const double x = roughness * 15, y = 1.2 * n_dot_v / (n_dot_v + 0.2) * 15;
            const int row = std::min(14, static_cast<int>(x)), column = std::min(14, static_cast<int>(y));
            const auto value = [&](float ReflectionShape::*member) {
                const auto at = [&](int r, int c) { return double{kReflectionShapes[(row + r) * 16 + column + c].*member}; };
                const double u = x - row, v = y - column;
                return (at(0, 0) * (1 - u) + at(1, 0) * u) * (1 - v) + (at(0, 1) * (1 - u) + at(1, 1) * u) * v;
            };
            for (const double error : {value(&ReflectionShape::a) - want.a, value(&ReflectionShape::b) - want.b}) {
                worst = std::max(worst, std::fabs(error));
                sum += std::fabs(error), ++compared;
            }
        }
    INFO("worst " << worst << ", mean " << sum / compared);
    CHECK(worst < 0.02);
    CHECK(sum / compared < 0.002);
}

TEST_CASE("reflections: a white mirror of any roughness in a uniform sky cannot be seen", "[shading][environment]") {
    const Sky sky = painted_sky(64, 32, [](Vec3d) { return grey(0.75); });
    Random random(4);
    double worst = 0;
    for (const bool metal : {true, false})
        for (int i = 0; i <= 20; ++i) {
            Drawn drawn(sky, static_cast<float>(std::max(0.05, i / 20.0)), metal ? 1.0f : 0.0f, metal ? 0.04f : 0.3f, {1, 1, 1});
            for (int j = 1; j <= 20; ++j)
                worst = std::max(worst, largest(drawn.at(random_direction(random), j / 20.0, random.real(0, 6)) - grey(0.75)) / 0.75);
        }
    INFO("off by " << worst);
    CHECK(worst < 1e-5);
}

TEST_CASE("reflections: each level of a map is the sky blurred by its lobe", "[shading][environment]") {
    Random random(12);
    std::string table;
    double worst_share = 0;
    for (const Sky& sky : skies()) {
        const ReflectionMap map = make_reflection_map(sky.view(), in_turn);
        double most = 0;
        for (const float v : sky.rgb) most = std::max(most, static_cast<double>(v));
        for (int level = 0; level < kReflectionLevels; ++level) {
            double worst = 0, squares = 0;
            constexpr int kDirections = 100;
            for (int i = 0; i < kDirections; ++i) {
                // At a value of the map, which needs no filter there.
                const int n = map.rows[level], x = random.index(2 * n), y = random.index(n + 1);
                const Vec3d d = sh::equirect_direction(x / (2.0 * n), y / static_cast<double>(n));
                Vec3d sum{};
                double weights = 0;
                // Light comes from twice the angle of a half vector: cos^4(t/2) beside GGX's own cosine and the change of solid angle.
                const Vec3d side = unit(cross(std::fabs(d.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0}, d)), other = cross(d, side);
                const double a = level == 0 ? 0.07 * 0.07 : kReflectionSharpest * (1 << level);
                constexpr int kRings = 64;
                for (int r = 0; r < kRings; ++r) {
                    const double s = (r + 0.5) / kRings, share = s * s * (3 - 2 * s),
                                 cosine = 1 / std::sqrt(1 + a * a * share / (1 - share));
                    const double weight = s * (1 - s) * 4 * cosine * cosine * cosine * cosine, full = 2 * cosine * cosine - 1;
                    const double sine = std::sqrt(std::max(0.0, 1 - full * full));
                    for (int j = 0; j < 2 * kRings; ++j) {
                        const double turn = kPi * (j + 0.5) / kRings;
                        sum = sum + radiance(sky, side * (sine * std::cos(turn)) + other * (sine * std::sin(turn)) + d * full) * weight;
                        weights += weight;
                    }
                }
                const std::array<float, 4>& got = map.rgba[static_cast<std::size_t>(map.first[level] + y * (2 * n + 1) + x)];
                const double error = largest(Vec3d{got[0], got[1], got[2]} - sum * (1 / weights)) / most;
                worst = std::max(worst, error), squares += error * error;
            }
            table += std::to_string(level) + ": " + std::to_string(worst) + ", " + std::to_string(std::sqrt(squares / kDirections)) + "\n";
            worst_share = std::max(worst_share, worst);
        }
    }
    INFO("worst and root of mean squares, of the sky's brightest\n" << table);
    CHECK(worst_share < 0.04);  // at the edge of a panel that is 120 times as bright as the room
}

TEST_CASE("reflections: a single bright pixel keeps its light in images of any size", "[shading][environment]") {
    Random random(5);
    for (const auto& [width, height] : {std::pair{1022, 511}, {1026, 513}, {1999, 1333}, {1024, 1026}}) {
        std::vector<float> rgb(static_cast<std::size_t>(3) * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
        const int x = random.index(width), y = height / 4 + random.index(height / 2);
        for (std::size_t c = 0; c < 3; ++c)
            rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) + c] = 1e5f;
        const auto strip = [](int j, int rows) { return std::cos(kPi * j / rows) - std::cos(kPi * (j + 1) / rows); };
        const double wanted = 1e5 * 2 * kPi / width * strip(y, height);
        const ReflectionMap map = make_reflection_map({width, height, rgb}, in_turn);
        const int n = map.rows[3];
        double sum = 0;
        for (int j = 1; j < n; ++j)
            for (int i = 0; i < 2 * n; ++i)
                sum +=
                    static_cast<double>(map.rgba[static_cast<std::size_t>(map.first[3] + j * (2 * n + 1) + i)][1]) * std::sin(kPi * j / n);
        sum *= kPi / n * (kPi / n);
        INFO(width << " x " << height << ", pixel " << x << ", " << y);
        CHECK(sum == Approx(wanted).epsilon(0.05));
    }
}

TEST_CASE("reflections: errors against GGX are at most half those of the split sum", "[shading][environment]") {
    constexpr int kRings = 96;
    Random random(9);
    const std::array<Sky, 3> all = skies();
    double worst[2] = {0, 0}, squares[2] = {0, 0};
    std::string table;
    for (const double roughness : {0.07, 0.15, 0.3, 0.45, 0.6, 0.8, 1.0}) {
        double row_worst[2] = {0, 0};
        for (const Sky& sky : all) {
            Vec3d mean{};
            for (int i = 0; i < 4000; ++i) mean = mean + radiance(sky, random_direction(random)) * (1.0 / 4000);
            Drawn metal(sky, static_cast<float>(roughness), 1.0f, 0.04f, {1, 1, 1});
            for (const double n_dot_v : {0.05, 0.15, 0.3, 0.5, 0.7, 0.9, 1.0})
                for (int i = 0; i < 6; ++i) {
                    const Vec3d n = random_direction(random);
                    Vec3d v{};
                    const Vec3d got = metal.at(n, n_dot_v, random.real(0, 6), &v);
                    const Integrals ggx_sums = ggx(&sky, roughness, n, v, kRings);
                    const Vec3d want = ggx_sums.light(1) * (1 / (ggx_sums.a + ggx_sums.b));
                    const Vec3d split = split_sum(sky, roughness, n * (2 * n_dot_v) - v, kRings);
                    const double errors[2] = {largest(got - want) / largest(mean), largest(split - want) / largest(mean)};
                    for (int k = 0; k < 2; ++k) {
                        row_worst[k] = std::max(row_worst[k], errors[k]);
                        squares[k] += errors[k] * errors[k];
                    }
                }
        }
        table += std::to_string(roughness) + ": " + std::to_string(row_worst[0]) + " " + std::to_string(row_worst[1]) + "\n";
        for (int k = 0; k < 2; ++k) worst[k] = std::max(worst[k], row_worst[k]);
    }
    INFO("worst error by roughness, of the mean radiance: halflit, split sum\n"
         << table << "root of mean squares " << std::sqrt(squares[0] / squares[1]));
    CHECK(worst[0] <= 0.3 * worst[1]);
    CHECK(squares[0] <= 0.12 * squares[1]);
}
