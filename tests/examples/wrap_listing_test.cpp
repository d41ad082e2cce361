// apps/examples/wrap_shading.glsl and .hlsl: one set of functions, with the values of shading/ and sh/.
#include "listings.hpp"
#include "sh/lobe_error.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/planner.hpp"
#include "shading/reference/reference.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/random.hpp"
#include "tests/support/white_lobe.hpp"

#include <array>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

using namespace halflit;
using namespace halflit::shading;
using halflit::test::Random;

namespace {

/// The functions of one listing.
struct Listing {
    const char* name;
    double (*wrap_lobe)(double, double, double);
    double (*wrap_scale)(double, double);
    double (*lambert)(double);
    double (*green_wrap)(double, double);
    double (*half_lambert)(double);
    double (*valve_lobe)(double);
    double (*sloan_lobe)(double, double);
    double (*mcauley_lobe)(double, double, double);
    listings::vec3 (*wrap_bands)(double, double);
    listings::vec3 (*wrap_sky)(listings::vec3[9], listings::vec3, listings::vec3);
    double (*wrap_fade_distance)(double, double);
    listings::vec2 (*shadow_tap)(double, double, double, double);
    double (*wrap_shadowed)(double, double, listings::vec2);
};

#define HALFLIT_LISTING(language)                                                                                    \
    {                                                                                                                \
#language, &listings::language::wrap_lobe, &listings::language::wrap_scale, &listings::language::lambert,    \
            &listings::language::green_wrap, &listings::language::half_lambert, &listings::language::valve_lobe,     \
            &listings::language::sloan_lobe, &listings::language::mcauley_lobe, &listings::language::wrap_bands,     \
            &listings::language::wrap_sky, &listings::language::wrap_fade_distance, &listings::language::shadow_tap, \
            &listings::language::wrap_shadowed                                                                       \
    }
const Listing kListings[] = {HALFLIT_LISTING(glsl), HALFLIT_LISTING(hlsl)};

constexpr float kWraps[] = {0.0f, 0.1f, 0.25f, 1.0f / 3.0f, 0.5f, 0.7f, 0.9f, 1.0f};
constexpr float kPowers[] = {0.0f, 0.5f, 1.0f, 1.25f, 1.5f, 2.0f, 3.0f, 4.0f, 20.0f};

/// The listing's text without comments and blank lines.
std::string code_of(const std::string& name) {
    std::ifstream file(HALFLIT_SOURCE_DIR "/apps/examples/" + name);
    std::string code;
    for (std::string line; std::getline(file, line);) {
        line = std::regex_replace(line, std::regex(" *//.*$"), "");
        if (!line.empty()) code += line + "\n";
    }
    REQUIRE(code.size() > 1000);
    return code;
}

/// Light that one white fragment reflects of a light of colour 1, by the kernel.
std::vector<double> by_kernel(const Lobe& lobe, const std::vector<float>& cosines, std::vector<double>& exact_cosines) {
    const ShadingPlan plan = test::plan_of_white(lobe);
    FragmentBlock block{};
    for (std::size_t i = 0; i < kBlockSize; ++i) {
        const float x = cosines[i % cosines.size()];
        block.lane[kNormalX][i] = x;
        block.lane[kNormalY][i] = std::sqrt(1 - x * x);
    }
    shade_kernels(Isa::scalar).shade(plan, plan.materials[0], all_lights(plan), block, kBlockSize);
    std::vector<double> values;
    exact_cosines.clear();
    for (std::size_t i = 0; i < kBlockSize; ++i) {
        const double x = double{block.lane[kNormalX][i]}, y = double{block.lane[kNormalY][i]};
        exact_cosines.push_back(x / std::hypot(x, y));
        values.push_back(double{block.red[i]});
    }
    return values;
}

}  // namespace

TEST_CASE("listings: GLSL and HLSL hold the same thirteen functions, alike but for the names of vectors", "[examples]") {
    const std::string glsl = code_of("wrap_shading.glsl");
    std::string hlsl = code_of("wrap_shading.hlsl");
    CHECK(hlsl.find("vec") == std::string::npos);
    CHECK(glsl.find("float2") == std::string::npos);
    hlsl = std::regex_replace(hlsl, std::regex("\\bfloat([234])\\b"), "vec$1");
    CHECK(glsl == hlsl);
    const std::regex function("(^|\n)(float|vec[234]) ([a-z_]+)\\(");
    std::size_t count = 0;
    for (auto at = std::sregex_iterator(glsl.begin(), glsl.end(), function); at != std::sregex_iterator(); ++at) ++count;
    CHECK(count == 13);
}

TEST_CASE("listings: every number is a float, as GLSL ES demands", "[examples]") {
    const std::string code = code_of("wrap_shading.glsl");
    // A number that is not part of a name, of another number, or of an index.
    const std::regex integer("[^A-Za-z0-9_.\\[\\-][0-9]+[^A-Za-z0-9_.\\]]");
    std::smatch found;
    const bool any = std::regex_search(code, found, integer);
    INFO((any ? found.str() : ""));
    CHECK_FALSE(any);
}

TEST_CASE("listings: the lobes are the reference's, with and without their scale", "[examples]") {
    for (const Listing& listing : kListings) {
        for (const float w : kWraps) {
            for (const float n : kPowers) {
                for (int i = -100; i <= 100; ++i) {
                    const double x = i / 100.0;
                    INFO(listing.name << ": w " << w << ", n " << n << ", x " << x);
                    const double f = listing.wrap_lobe(x, double{w}, double{n});
                    CHECK(f == Approx(reference::lobe_value({w, n, false}, x)).epsilon(1e-12).margin(1e-15));
                    // Lobe::scale() is a float.
                    CHECK(listing.mcauley_lobe(x, double{w}, double{n}) ==
                          Approx(reference::lobe_value(Lobe::mcauley(w, n), x)).epsilon(2e-7));
                    if (n != 1.0f) continue;
                    CHECK(listing.lambert(x) == Approx(reference::lobe_value(Lobe::lambert(), x)).margin(1e-15));
                    CHECK(listing.green_wrap(x, double{w}) == Approx(reference::lobe_value(Lobe::green(w), x)).margin(1e-15));
                    CHECK(listing.half_lambert(x) == Approx(reference::lobe_value(Lobe::half_lambert(), x)).margin(1e-15));
                    CHECK(listing.valve_lobe(x) == Approx(reference::lobe_value(Lobe::valve(), x)).margin(1e-15));
                    // Lobe::sloan rounds 1 + a to float.
                    CHECK(listing.sloan_lobe(x, double{w}) == Approx(reference::lobe_value(Lobe::sloan(w), x)).epsilon(1e-6));
                }
                CHECK(listing.wrap_lobe(double{-w}, double{w}, double{n}) == 0.0);  // pow(0, 0) is 1
            }
        }
    }
}

TEST_CASE("listings: the lobes are the shading kernel's", "[examples]") {
    std::vector<float> cosines;
    for (int i = 0; i < kBlockSize; ++i) cosines.push_back(-1.0f + 2.0f * static_cast<float>(i) / (kBlockSize - 1));
    for (const float w : kWraps) {
        for (const float n : {1.0f, 1.0f + w, 2.0f, 4.0f}) {
            for (const bool normalize : {false, true}) {
                const Lobe lobe{w, n, normalize};
                std::vector<double> x;
                const std::vector<double> values = by_kernel(lobe, cosines, x);
                for (std::size_t i = 0; i < values.size(); ++i) {
                    for (const Listing& listing : kListings) {
                        INFO(listing.name << ": w " << w << ", n " << n << ", x " << x[i]);
                        const double scale = normalize ? listing.wrap_scale(double{w}, double{n}) : 1.0;
                        // As in tests/shading/lobe_test.cpp: x is accurate to 1e-7, times the lobe's slope.
                        CHECK(std::fabs(values[i] - scale * listing.wrap_lobe(x[i], double{w}, double{n})) <= 5e-7 * double{n} * scale);
                    }
                }
            }
        }
    }
}

TEST_CASE("listings: the scale makes band 0 equal to 1, and the bands are those of sh/", "[examples]") {
    for (const Listing& listing : kListings) {
        for (const float w : kWraps) {
            for (const float n : kPowers) {
                INFO(listing.name << ": w " << w << ", n " << n);
                const sh::BandFactors bands = sh::zonal_bands({double{w}, double{n}, 1.0});
                const listings::vec3 found = listing.wrap_bands(double{w}, double{n});
                CHECK(found.x == Approx(bands[0]).epsilon(1e-14));
                CHECK(found.y == Approx(bands[1]).epsilon(1e-13).margin(1e-14));
                CHECK(found.z == Approx(bands[2]).epsilon(1e-13).margin(1e-14));
                CHECK(listing.wrap_scale(double{w}, double{n}) * found.x == Approx(1).epsilon(1e-14));
            }
        }
        // Green's and Sloan's bands as [SNY11] prints them.
        for (const double w : {0.0, 0.3, 0.8, 1.0}) {
            const listings::vec3 green = listing.wrap_bands(w, 1), sloan = listing.wrap_bands(w, 1 + w);
            CHECK(green.y == Approx((2 - w) * (1 + w) / 3));
            CHECK(green.z == Approx((1 - w) * (1 - w) * (1 + w) / 4).margin(1e-15));
            CHECK(sloan.x == Approx(2 * (1 + w) / (2 + w)));
            CHECK(sloan.y == Approx(4 * (1 + w) / ((2 + w) * (3 + w))));
            CHECK(sloan.z == Approx(2 * (1 + w) * (w * w - 2 * w + 3) / ((2 + w) * (3 + w) * (4 + w))));
        }
    }
}

TEST_CASE("listings: the sky's light is that of sh/ at order 3, and a constant sky's is band 0", "[examples]") {
    Random random(6003);
    for (const Listing& listing : kListings) {
        for (int trial = 0; trial < 200; ++trial) {
            sh::RadianceSh radiance{3, {}};
            listings::vec3 coefficients[9];
            for (std::size_t i = 0; i < 9; ++i) {
                // Band 0 is large enough to keep the light above 0: there the listing's max changes nothing.
                const double low = i == 0 ? 12 : -1, high = i == 0 ? 13 : 1;
                coefficients[i] = {random.real(low, high), random.real(low, high), random.real(low, high)};
                radiance.c[i] = {coefficients[i].x, coefficients[i].y, coefficients[i].z};
            }
            const double w = random.real(0, 1), n = random.real(0, 5);
            const double phi = random.real(0, 2 * kPi), z = random.real(-1, 1), sine = std::sqrt(1 - z * z);
            const Vec3d normal{sine * std::cos(phi), sine * std::sin(phi), z};
            const Vec3d expected = sh::evaluate(sh::scaled_by_band(radiance, sh::zonal_bands({w, n, 1.0})), normal);
            const listings::vec3 found = listing.wrap_sky(coefficients, {normal.x, normal.y, normal.z}, listing.wrap_bands(w, n));
            INFO(listing.name << ": w " << w << ", n " << n);
            REQUIRE(expected.x > 0);
            CHECK(found.x == Approx(expected.x).epsilon(1e-8));  // constants of nine digits
            CHECK(found.y == Approx(expected.y).epsilon(1e-8));
            CHECK(found.z == Approx(expected.z).epsilon(1e-8));
        }
        listings::vec3 constant[9];
        constant[0] = {std::sqrt(4 * kPi), 0, 0};
        CHECK(listing.wrap_sky(constant, {0, 0.6, 0.8}, listing.wrap_bands(0, 1)).x == Approx(1).epsilon(1e-8));
        CHECK(listing.wrap_sky(constant, {0, 0.6, 0.8}, listing.wrap_bands(1, 2)).x == Approx(4.0 / 3).epsilon(1e-8));
    }
}

TEST_CASE("listings: shadows are the reference's soft-split, over nine texels of a map", "[examples]") {
    constexpr int kSize = 8;
    constexpr double kDistance = 10;
    Random random(6004);
    std::vector<float> texels(kSize * kSize);
    ShadowMapPlan map;
    map.distance = texels.data();
    map.size = kSize;
    map.rows[0][3] = map.rows[1][3] = 4.5f;  // the middle of a texel: the filter is the mean of 3 x 3
    map.rows[2][2] = -1, map.rows[2][3] = static_cast<float>(kDistance);
    map.offset = 0;
    int faded = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const Lobe lobe = trial % 2 == 0 ? Lobe::sloan(random.real32(0, 1)) : Lobe::mcauley(random.real32(0, 1), random.real32(1, 3));
        const double w = double{lobe.wrap}, n = double{lobe.power}, x = random.real(-1, 1), radius = random.real(0.1, 3);
        for (const Listing& listing : kListings) {
            const double d0 = listing.wrap_fade_distance(w, radius);
            for (float& texel : texels) texel = static_cast<float>(kDistance - random.real(-0.5, 1.2) * d0);
            MaterialPlan material;
            material.shadow_fade_scale = w > 0 ? static_cast<float>(1 / (2.0 / double{kOwnThickness} * w * radius)) : 0.0f;
            material.shadow_turn_scale = w > 0 ? static_cast<float>(double{kOwnThickness} / w) : 0.0f;
            const Vec3d normal{std::sqrt(1 - x * x), 0, x};
            const auto hidden = reference::hidden_share(map, {0, 0, 0}, normal, {0, 0, 1}, material, ShadowMode::soft_split);
            const double expected = reference::shadowed_lobe(lobe, x, hidden, ShadowMode::soft_split);

            const double receiver = kDistance * (1 - double{kShadowRelativeBias});
            listings::vec2 seen(0, 0);
            for (int j = 3; j <= 5; ++j)
                for (int i = 3; i <= 5; ++i) {
                    const listings::vec2 tap = listing.shadow_tap(receiver - double{texels[std::size_t(j * kSize + i)]}, d0, x, w);
                    seen = {seen.x + tap.x / 9, seen.y + tap.y / 9};
                    faded += tap.y > 0 && tap.y < 1;
                }
            const double scale = lobe.normalize ? listing.wrap_scale(w, n) : 1.0;
            const double found = scale * listing.wrap_shadowed(listing.wrap_lobe(x, w, n), x, seen);
            INFO(listing.name << ": w " << w << ", n " << n << ", x " << x);
            CHECK(found == Approx(expected).epsilon(2e-6).margin(1e-7));  // the plan's scales are floats
        }
    }
    CHECK(faded > 5000);
}

TEST_CASE("listings: light that nothing hides is the lobe's, and far blockers hide all of it", "[examples]") {
    for (const Listing& listing : kListings)
        for (const double w : {0.0, 0.3, 1.0})
            for (int i = -20; i <= 20; ++i) {
                const double x = i / 20.0, f = listing.wrap_lobe(x, w, 1 + w), d0 = listing.wrap_fade_distance(w, 2);
                CHECK(listing.wrap_shadowed(f, x, listing.shadow_tap(-1, d0, x, w)) == Approx(f).epsilon(1e-15));
                CHECK(listing.wrap_shadowed(f, x, listing.shadow_tap(d0 + 1, d0, x, w)) == 0.0);
            }
}
