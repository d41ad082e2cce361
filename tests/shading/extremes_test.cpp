// Cases where float32 fails: each quantity in its plain form, written here, and as the kernels compute it, both against float64. The
// measured figures are in shading/README.md ("Extremes"); run with -s to see them.
#include "elementary/elementary.hpp"
#include "floats.hpp"
#include "lobe_curve/lobe_curve.hpp"
#include "shading/environment.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/planner.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

/// Largest of many errors, and the number of results without an error to measure: NaN, infinity.
struct Worst {
    double error = 0;
    int broken = 0;
    void add(double got, double want, double scale) {
        if (!std::isfinite(got))
            ++broken;
        else
            error = std::max(error, std::fabs(got - want) / scale);
    }
};

/// One white surface under one light.
struct Shot {
    Material material;
    Light light;
    ShadingSettings options;
    ShadingPlan plan;

    void make_plan() {
        const std::vector<SlotMask> available{3u, 3u};
        plan = plan_shading({std::span(&material, 1), {}, available, plan_lights(std::span(&light, 1)), {}, options});
        plan.orthographic = true;
        plan.view_direction_ws = {0, 0, -1};
    }
    /// The first red values of the block.
    [[nodiscard]] std::vector<float> shade(Isa isa, const FragmentBlock& given) const {
        FragmentBlock block = given;
        shade_kernels(isa).shade(plan, plan.materials[0], all_lights(plan), block, kBlockSize);
        return {block.red, block.red + kBlockSize};
    }
};

Shot matte() {
    Shot shot;
    shot.options.specular = SpecularModel::none;
    return shot;
}

void set3(FragmentBlock& block, int row, int lane, Vec3f v) {
    block.lane[row][lane] = v.x, block.lane[row + 1][lane] = v.y, block.lane[row + 2][lane] = v.z;
}

LobePlan plan_of(const Lobe& lobe) {
    Shot shot = matte();
    shot.material.lobe = lobe;
    shot.make_plan();
    return shot.plan.materials[0].lobe;
}

float length_of(Vec3f v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }
Vec3f plain_normalize(Vec3f v) { return v * (1.0f / length_of(v)); }

Vec3d unit(Vec3f v) {
    const long double x = v.x, y = v.y, z = v.z, l = std::sqrt(x * x + y * y + z * z);
    return {static_cast<double>(x / l), static_cast<double>(y / l), static_cast<double>(z / l)};
}

}  // namespace

TEST_CASE("extremes: t = (x + w) / (1 + w) stays in [0, 1], also for the dot product of unit vectors", "[shading][extremes]") {
    std::vector<float> x;
    for (int i = -65536; i < 65536; ++i) x.push_back(static_cast<float>(i) / 65536.0f);
    for (float v = 1.0f - 16 * 0x1p-24f; v <= 1.0f + 0x1p-22f; v = std::nextafter(v, 2.0f)) x.push_back(v);
    while (x.size() % 16 != 0) x.push_back(1.0f);
    Worst before, after;
    double highest_before = 0, highest_after = 0;
    for (const float w : {0.1f, 0.25f, 0.3f, 0.5f, 0.75f, 0.9f})
        for (const Isa isa : test::available_isas()) {
            std::vector<float> t(x.size());
            lobe_curve(isa)(plan_of(Lobe::green(w)), x.data(), t.data(), static_cast<int>(x.size()));
            for (std::size_t i = 0; i < x.size(); ++i) {
                const double exact = std::clamp((static_cast<double>(x[i]) + w) / (1.0 + w), 0.0, 1.0);
                const float plain = std::max(0.0f, (x[i] + w) / (1.0f + w));
                before.add(plain, exact, 1.0), after.add(t[i], exact, 1.0);
                highest_before = std::max<double>(highest_before, plain), highest_after = std::max<double>(highest_after, t[i]);
            }
        }
    INFO("before " << before.error << ", highest 1 + " << highest_before - 1 << "; after " << after.error << ", highest 1 + "
                   << highest_after - 1);
    CHECK(highest_before > 1.0);
    CHECK(highest_after == 1.0);
    CHECK(after.broken == 0);
    CHECK(after.error <= 2.5 * 0x1p-24);  // rounding: half an ulp each of the sum, of 1 / (1 + w) rounded up, and of the product
}

TEST_CASE("extremes: t^n up to n = 10000 has no NaN, no lit back side and no denormal", "[shading][extremes]") {
    // Relative errors where the value is above 1e-20. That of the plain form is n times that of t.
    for (const float n : {1.3f, 2.0f, 100.0f, 1000.0f, 10000.0f}) {
        const float w = 0.5f;
        std::vector<float> x;
        const double span = std::min(2.0, 80.0 / n);  // part where the lobe is above 1e-20; the back side is added
        for (int i = 0; i < 32768; ++i)
            x.push_back(static_cast<float>(1.0 - span * i / 32768)), x.push_back(static_cast<float>(1.0 - 2.0 * i / 32767));
        Worst before, after;
        int denormals = 0, lit_behind = 0;
        for (const float v : x) {
            const float plain = std::pow((v + w) / (1.0f + w), n);
            const double exact = v > -w ? std::pow((static_cast<double>(v) + w) / (1.0 + w), static_cast<double>(n)) : 0.0;
            denormals += plain != 0 && std::fabs(plain) < 1.1754944e-38f;
            lit_behind += v <= -w && plain > 0;
            if (exact > 1e-20 || !std::isfinite(plain)) before.add(plain, exact, exact);
        }
        for (const Isa isa : test::available_isas()) {
            std::vector<float> f(x.size());
            lobe_curve(isa)(plan_of({w, n, false}), x.data(), f.data(), static_cast<int>(x.size()));
            int wrong = 0;
            for (std::size_t i = 0; i < x.size(); ++i) {
                const double exact = x[i] > -w ? std::pow((static_cast<double>(x[i]) + w) / (1.0 + w), static_cast<double>(n)) : 0.0;
                if (exact > 1e-20 || !std::isfinite(f[i])) after.add(f[i], exact, exact);
                wrong += (x[i] <= -w && f[i] != 0) || (f[i] != 0 && f[i] < 1.1754944e-38f);
            }
            CHECK(wrong == 0);
        }
        INFO("n " << n << ": before " << before.error << ", " << before.broken << " NaN, " << denormals << " denormal, " << lit_behind
                  << " lit behind; after " << after.error << ", " << after.broken << " NaN");
        CHECK(before.broken + denormals + lit_behind > 0);
        CHECK(after.broken == 0);
        // Error: four roundings of t, which the power multiplies by n, plus 2.3 ulp of the power. From n = 64 on, in place of the latter,
        // five roundings of an exponent of size 46 (ln 1e-20). From n = 160 on only t near 1 counts, where roundings of t are not
        // multiplied by n.
        CHECK(after.error <= (n < 160 ? 4 * n : 0) * 0x1p-24 + (n < 64 ? 2 * 2.3 : 5 * 46) * 0x1p-24);
        if (n > 200) CHECK(before.error >= 5 * after.error);
    }
}

TEST_CASE("extremes: normalising keeps the direction of every finite vector", "[shading][extremes]") {
    FloatMaker make(3);
    std::vector<float> in[3], out[3];
    for (int exponent = -149; exponent <= 126; ++exponent)
        for (int i = 0; i < 16; ++i)
            for (auto& row : in) row.push_back(std::ldexp(make.ordinary(-1, 1), exponent + 1));
    const std::size_t count = in[0].size();
    for (auto& row : out) row.resize(count);
    Worst before, after;
    for (const Isa isa : test::available_isas()) {
        elementary(isa).normalize(in[0].data(), in[1].data(), in[2].data(), out[0].data(), out[1].data(), out[2].data(),
                                  static_cast<int>(count));
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3f v{in[0][i], in[1][i], in[2][i]};
            if (v == Vec3f{0, 0, 0}) continue;
            const Vec3d want = unit(v);
            const Vec3f plain = plain_normalize(v);
            before.add(plain.x, want.x, 1), before.add(plain.y, want.y, 1), before.add(plain.z, want.z, 1);
            after.add(out[0][i], want.x, 1), after.add(out[1][i], want.y, 1), after.add(out[2][i], want.z, 1);
        }
    }
    INFO("before " << before.error << ", " << before.broken << " not finite; after " << after.error << ", " << after.broken);
    CHECK(before.error > 0.5);
    CHECK(before.broken > 0);
    CHECK(after.broken == 0);
    CHECK(after.error <= 3 * 0x1p-24);  // roundings of the root of the sum, its reciprocal and the product, for components up to 1
}

TEST_CASE("extremes: 1 / d^2 is finite at every distance, 0 included", "[shading][extremes]") {
    Shot shot = matte();
    shot.light.type = LightType::point;
    shot.make_plan();
    Worst before, after;
    int wrong = 0;
    std::vector<float> distances{0.0f};
    for (int i = -44; i <= 38; ++i)
        for (const float m : {1.0f, 1.7f, 2.9f}) distances.push_back(static_cast<float>(m * std::pow(10.0, i)));
    while (distances.size() % kBlockSize != 0) distances.push_back(3e38f);
    for (const Isa isa : test::available_isas())
        for (std::size_t first = 0; first < distances.size(); first += kBlockSize) {
            FragmentBlock block{};
            for (int l = 0; l < kBlockSize; ++l) {
                set3(block, kPosX, l, {0, 0, 0.0f - distances[first + static_cast<std::size_t>(l)]});
                set3(block, kNormalX, l, {0, 0, 1});
            }
            const std::vector<float> value = shot.shade(isa, block);
            for (int l = 0; l < kBlockSize; ++l) {
                const float d = distances[first + static_cast<std::size_t>(l)];
                const Vec3f offset{0, 0, d}, direction = plain_normalize(offset);
                const float plain = direction.z / (d * d);
                // A light has a radius of 1e-4 by default. The plain form has none, so it is compared beyond that distance only.
                const double held = std::max(static_cast<double>(d), 1e-4), exact = 1.0 / (held * held);
                const float got = value[static_cast<std::size_t>(l)];
                if (!std::isfinite(plain)) ++before.broken;
                if (d >= 1e-4f && exact > 1e-37 && std::isfinite(plain)) before.add(plain, exact, exact);
                if (d >= 1e-17f && exact > 1e-37) after.add(got, exact, exact);
                wrong += !(std::isfinite(got) && got >= 0.0f && static_cast<double>(got) <= 1.0001e8);
                if (d == 0.0f) wrong += got != 0.0f;  // no direction: dark
            }
        }
    INFO("before " << before.error << ", " << before.broken << " not finite; after " << after.error);
    CHECK(before.broken > 0);
    CHECK(wrong == 0);
    CHECK(after.error <= 8 * 0x1p-24);  // roundings: 3 of the direction; square, quotient, products; the radius squared as a float
}

TEST_CASE("extremes: a spot of a fiftieth of a degree has a smooth cone", "[shading][extremes]") {
    for (const double outer_deg : {1.0, 0.1, 0.05, 0.02}) {
        Shot shot = matte();
        shot.light.type = LightType::spot;
        shot.light.direction_ws = {0, 0, -1};
        shot.light.outer_cone_rad = static_cast<float>(outer_deg * kDegree);
        shot.light.inner_cone_rad = static_cast<float>(0.5 * outer_deg * kDegree);
        shot.make_plan();
        const double outer = shot.light.outer_cone_rad, inner = shot.light.inner_cone_rad;
        const auto versine = [](double angle) { return 2 * std::sin(angle / 2) * std::sin(angle / 2); };
        Worst before, after;
        FragmentBlock block{};
        for (int l = 0; l < kBlockSize; ++l) {
            set3(block, kPosX, l, {static_cast<float>(std::tan(1.2 * outer * l / kBlockSize)), 0, -1});
            set3(block, kNormalX, l, {0, 0, 1});
        }
        for (const Isa isa : test::available_isas()) {
            const std::vector<float> value = shot.shade(isa, block);
            for (int l = 0; l < kBlockSize; ++l) {
                const Vec3f to_light{-block.lane[kPosX][l], 0, 1};
                const double angle = std::atan2(std::fabs(static_cast<double>(to_light.x)), 1.0),
                             d2 = 1.0 + static_cast<double>(to_light.x) * to_light.x;
                const double cone = std::clamp((versine(outer) - versine(angle)) / (versine(outer) - versine(inner)), 0.0, 1.0);
                const float cos_outer = std::cos(shot.light.outer_cone_rad), cos_inner = std::cos(shot.light.inner_cone_rad);
                const float plain = std::clamp((plain_normalize(to_light).z - cos_outer) / (cos_inner - cos_outer), 0.0f, 1.0f);
                before.add(plain * plain, cone * cone, 1.0);
                after.add(value[static_cast<std::size_t>(l)], std::cos(angle) / d2 * cone * cone, 1.0);
            }
        }
        INFO("outer " << outer_deg << " degrees: before " << before.error << ", " << before.broken << " NaN; after " << after.error);
        if (outer_deg < 0.06) CHECK((before.error > 0.2 || before.broken > 0));
        CHECK(after.broken == 0);
        CHECK(after.error <= 4e-6);  // twice the error of the cone: a few eps of the versine over the cone's relative width of 3/4
    }
}

TEST_CASE("extremes: a highlight's power up to s = 100000 keeps its digits and does not pass its peak", "[shading][extremes]") {
    const double slant = 0.4;  // half the angle between light and view
    const Vec3f to_light{static_cast<float>(std::sin(2 * slant)), 0, static_cast<float>(std::cos(2 * slant))}, to_eye{0, 0, 1};
    for (const double asked : {1024.0, 1e4, 8.3e4, 1e5}) {
        Shot shot;
        shot.material.metallic = 1.0f;
        shot.material.roughness = static_cast<float>(std::pow(2.0 / (asked + 2.0), 0.25));
        shot.light.direction_ws = to_light * -1.0f;
        shot.make_plan();
        const bool by_kernel = shot.material.roughness > 0.07f;  // 0.07: the smallest roughness of materials, s = 83,300
        const double r = shot.material.roughness, s = by_kernel ? 2.0 / (r * r * r * r) - 2.0 : asked;
        const Vec3d half = unit(Vec3f{shot.plan.lights[0].to_light[0], 0, shot.plan.lights[0].to_light[2] + 1.0f});
        FragmentBlock block{};
        float cosine_squared[kBlockSize], sine_squared[kBlockSize], half_exponent[kBlockSize];
        double exact[kBlockSize], n_dot_l[kBlockSize];
        float plain[kBlockSize];
        for (int l = 0; l < kBlockSize; ++l) {
            // Normals around the half vector, out to where the highlight is 1e-6 of its peak.
            const double off = std::sqrt(2 * 13.8 / s) * l / kBlockSize, turn = 2.4 * l;
            const double a = slant + off * std::cos(turn), b = off * std::sin(turn);
            const Vec3f normal{static_cast<float>(std::sin(a) * std::cos(b)), static_cast<float>(std::sin(b)),
                               static_cast<float>(std::cos(a) * std::cos(b))};
            set3(block, kNormalX, l, normal);
            const Vec3d n = unit(normal), light = unit(to_light), sine = cross(n, half);
            exact[l] = std::exp(0.5 * s * std::log1p(-dot(sine, sine)));
            n_dot_l[l] = dot(n, light);
            const Vec3f plain_half = plain_normalize(to_light + to_eye);
            plain[l] = std::pow(std::max(0.0f, dot(plain_normalize(normal), plain_half)), static_cast<float>(s));
            const Vec3f unit_normal = plain_normalize(normal), h = to_light + to_eye, side = cross(unit_normal, h);
            const float inv = 1.0f / dot(h, h), c = dot(unit_normal, h);
            cosine_squared[l] = (c * c) * inv, sine_squared[l] = dot(side, side) * inv, half_exponent[l] = static_cast<float>(0.5 * s);
        }
        Worst before, after;
        double peak_before = 0, peak_after = 0;
        for (const Isa isa : test::available_isas()) {
            std::vector<float> value(kBlockSize);
            if (by_kernel)
                value = shot.shade(isa, block);
            else
                elementary(isa).power_of_cosine(cosine_squared, sine_squared, half_exponent, value.data(), kBlockSize);
            for (int l = 0; l < kBlockSize; ++l) {
                const double got = by_kernel ? value[static_cast<std::size_t>(l)] / ((s * s + 10 * s + 32) / (8 * (s + 4)) * n_dot_l[l])
                                             : value[static_cast<std::size_t>(l)];
                before.add(plain[l], exact[l], exact[l]), after.add(got, exact[l], exact[l]);
                peak_before = std::max<double>(peak_before, plain[l]), peak_after = std::max(peak_after, got);
            }
        }
        INFO("s " << s << ": before " << before.error << ", highest " << peak_before << "; after " << after.error << ", highest "
                  << peak_after);
        CHECK(after.broken == 0);
        CHECK(peak_after <= 1.0 + 1e-6);
        // The angle between unit vectors of floats is accurate to 1e-7. The exponent s/2 sin^2 has a slope of s sin, at most sqrt(2 s
        // 13.8).
        CHECK(after.error <= 1.5e-7 * std::sqrt(2 * s * 13.8) + 2e-5);
        CHECK(before.error >= 5 * after.error);
    }
}

TEST_CASE("extremes: a light exactly opposite the viewer has no half vector and gives no highlight", "[shading][extremes]") {
    // [CMSC] divides L + e, the sum of the directions to the light and to the eye, by its length, which is 0 here.
    Shot shot;
    shot.material.metallic = 1.0f;
    shot.light.direction_ws = {0, 0, 1};  // L = (0, 0, -1), the view is (0, 0, 1)
    const Vec3f plain = plain_normalize(Vec3f{0, 0, -1} + Vec3f{0, 0, 1});
    CHECK(std::isnan(plain.x));
    shot.make_plan();
    FragmentBlock block{};
    for (int l = 0; l < kBlockSize; ++l) {
        const double angle = 2 * kPi * l / kBlockSize;
        set3(block, kNormalX, l, {static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))});
    }
    for (const Isa isa : test::available_isas())
        for (const float value : shot.shade(isa, block)) CHECK(value == 0.0f);
}

TEST_CASE("extremes: environment light is as accurate at the poles of its basis as elsewhere, on every set", "[shading][extremes]") {
    FloatMaker make(17);
    Environment environment;
    environment.radiance.bands = sh::kMaxBands;
    for (auto& c : environment.radiance.c) c = {make.ordinary(-1, 1), make.ordinary(-1, 1), make.ordinary(-1, 1)};
    environment.radiance.c[0] = {40, 40, 40};  // so that no sum is below 0
    Shot shot = matte();
    shot.options.environment_bands = sh::kMaxBands;
    const std::vector<SlotMask> available{3u, 3u};
    shot.plan = plan_shading({std::span(&shot.material, 1), {}, available, {}, {}, shot.options, borrowed(environment)});
    REQUIRE(shot.plan.environments.size() == 1);
    REQUIRE(shot.plan.environments[0].bands == sh::kMaxBands);
    const sh::BandFactors bands = sh::zonal_bands({0.0, 1.0, 1.0});
    const sh::PreconvolvedSh sum = sh::convolve(environment.radiance, bands, sh::kMaxBands);
    double size = 0;  // upper bound on the sum
    for (int i = 0; i < sh::kMaxCoefficients; ++i)
        size += std::fabs(environment.radiance.c[static_cast<std::size_t>(i)].x * bands[static_cast<std::size_t>(sh::band_of(i))]) *
                std::sqrt((2 * sh::band_of(i) + 1) / (4 * kPi));
    Worst poles, elsewhere;
    for (const Isa isa : test::available_isas())
        for (int round = 0; round < 64; ++round) {
            FragmentBlock block{};
            for (int l = 0; l < kBlockSize; ++l) {
                const float off = std::pow(10.0f, make.ordinary(-30, -2)), turn = make.ordinary(0, 6.3f);
                const bool pole = l % 2 == 0;
                set3(block, kNormalX, l,
                     pole ? Vec3f{off * std::cos(turn), off * std::sin(turn), l % 4 == 0 ? 1.0f : -1.0f}
                          : Vec3f{make.ordinary(-1, 1), make.ordinary(-1, 1), make.ordinary(-1, 1)});
                if (l < 4 && pole) block.lane[kNormalX][l] = block.lane[kNormalY][l] = 0.0f;
            }
            const std::vector<float> value = shot.shade(isa, block);
            for (int l = 0; l < kBlockSize; ++l) {
                const Vec3d n = unit({block.lane[kNormalX][l], block.lane[kNormalY][l], block.lane[kNormalZ][l]});
                (l % 2 == 0 ? poles : elsewhere).add(value[static_cast<std::size_t>(l)], sh::evaluate(sum, n).x, size);
            }
        }
    INFO("at the poles " << poles.error << ", elsewhere " << elsewhere.error);
    CHECK(poles.broken + elsewhere.broken == 0);
    CHECK(poles.error <= 2e-6);
    CHECK(elsewhere.error <= 2e-6);
}
