// KHR_materials_iridescence: against light through a film wavelength by wavelength, the extension's formulas, limits, extremes, and every
// instruction set.
#include "random_case.hpp"
#include "shading/model/thin_film.hpp"
#include "tests/shading/surface_bench.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;

namespace {

struct Bench : SurfaceBench {
    Bench() {
        material.metallic = 0, material.base_color = {0, 0, 0, 1}, material.iridescence = 1;
        options.normalize_specular = false;
    }
    /// F0 with the film. A highlight that is seen at its peak has F0 N.L.
    [[nodiscard]] Vec3d f0(double angle, Isa isa = Isa::scalar) const {
        Bench lit = *this;
        lit.lights = {}, lit.environment = {};
        lit.add_light({-std::sin(angle), 0, std::cos(angle)});
        return lit.seen_from({std::sin(angle), 0, std::cos(angle)}, isa) * (1 / std::cos(angle));
    }
};

/// F0 that Schlick's curve needs for a reflectance.
double turned(double reflectance, double cosine) {
    const double grazing = std::pow(1 - cosine, 5);
    return std::clamp((reflectance - grazing) / (1 - grazing), 0.0, 1.0);
}
double schlick(double f0, double cosine) { return f0 + (1 - f0) * std::pow(1 - cosine, 5); }

/// Reflectance of a film for one length of a wave: Airy's sum, of amplitudes by Schlick's curve.
double airy(double f0, double n, double nm, double cosine, double wave_nm) {
    const double inner = std::sqrt(1 - (1 - cosine * cosine) / (n * n)), r = std::sqrt(f0), base = (1 + r) / (1 - r);
    const double outside = -std::sqrt(schlick(std::pow((n - 1) / (n + 1), 2), cosine));
    const double inside = (base >= n ? -1 : 1) * std::sqrt(schlick(std::pow((base - n) / (base + n), 2), inner));
    const double phase = 2 * kPi * 2 * n * nm * inner / wave_nm, both = outside * inside;
    const double squares = outside * outside + inside * inside, twice = 2 * both * std::cos(phase);
    return (squares + twice) / (1 + both * both + twice);
}

/// The CIE 1931 curves as sums of lobes, within a few hundredths [WSS13].
Vec3d cie(double wave_nm) {
    const auto lobe = [&](double at, double low, double high) {
        const double t = (wave_nm - at) * (wave_nm < at ? low : high);
        return std::exp(-0.5 * t * t);
    };
    return {0.362 * lobe(442.0, 0.0624, 0.0374) + 1.056 * lobe(599.8, 0.0264, 0.0323) - 0.065 * lobe(501.1, 0.0490, 0.0382),
            0.821 * lobe(568.8, 0.0213, 0.0247) + 0.286 * lobe(530.9, 0.0613, 0.0322),
            1.217 * lobe(437.0, 0.0845, 0.0278) + 0.681 * lobe(459.0, 0.0385, 0.0725)};
}

/// Luminance of a film's reflectance under light of equal energy.
double luminance(double f0, double n, double nm, double cosine) {
    double sum = 0, all = 0;
    for (double wave = 380; wave <= 780; wave += 1) sum += cie(wave).y * airy(f0, n, nm, cosine, wave), all += cie(wave).y;
    return sum / all;
}
double luminance(Vec3d rgb) { return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z; }

}  // namespace

TEST_CASE("iridescence: luminance is that of a film, wavelength by wavelength", "[shading][iridescence]") {
    double worst = 0, squares = 0;
    int compared = 0;
    for (const double f0 : {0.04, 0.2, 0.6})
        for (const double n : {1.2, 1.33, 1.8})
            for (const double nm : {60.0, 150.0, 280.0, 400.0, 700.0})
                for (const double angle : {0.0, 0.5, 0.9, 1.2}) {
                    Bench bench;
                    bench.material.dielectric_reflectance = static_cast<float>(f0);
                    bench.material.iridescence_ior = static_cast<float>(n);
                    bench.material.iridescence_thickness_max_nm = static_cast<float>(nm);
                    const Vec3d got = bench.f0(angle);
                    const double c = std::cos(angle), want = turned(luminance(f0, n, nm, c), c);
                    // Colours out of the display's range are cut off; where a channel is, there is nothing to compare.
                    if (std::min({got.x, got.y, got.z}) <= 0) continue;
                    const double error = std::fabs(luminance(got) - want);
                    worst = std::max(worst, error), squares += error * error, ++compared;
                }
    INFO("worst " << worst << ", rms " << std::sqrt(squares / compared) << " of " << compared);
    CHECK(compared > 100);
    CHECK(worst < 0.06);
    CHECK(std::sqrt(squares / compared) < 0.02);
}

TEST_CASE("iridescence: a film that is not there, has no thickness or is very thick has no colour", "[shading][iridescence]") {
    Bench bench;
    bench.material.base_color = {0.9f, 0.6f, 0.3f, 1}, bench.material.metallic = 1;
    for (const double angle : {0.0, 0.8, 1.3}) {
        Bench none = bench;
        none.material.iridescence = 0;
        const Vec3d bare = none.f0(angle);
        CHECK(bare.x == Approx(0.9).epsilon(1e-5));
        CHECK((none.plan().materials[0].stages & (kStageIridescence | kStageSpecularColor)) == 0);
        none.material.iridescence = 1, none.material.iridescence_thickness_max_nm = 0;
        const Vec3d thin = none.f0(angle);
        CHECK(thin.x == Approx(bare.x).epsilon(1e-6));
        CHECK(thin.z == Approx(bare.z).epsilon(1e-6));
        Bench thick;
        thick.material.iridescence_thickness_max_nm = 1e5f, thick.material.dielectric_reflectance = 0.1f;
        const Vec3d grey = thick.f0(angle);
        CHECK(grey.x == Approx(grey.y).epsilon(1e-5));
        CHECK(grey.x == Approx(grey.z).epsilon(1e-5));
    }
}

TEST_CASE("iridescence: share and thickness follow their textures, and the least thickness counts with a texture alone",
          "[shading][iridescence]") {
    Bench plain, textured;
    plain.material.iridescence = 0.5f, plain.material.iridescence_thickness_max_nm = 250;
    plain.material.iridescence_thickness_min_nm = 17;
    textured.material.iridescence = 1, textured.material.iridescence_thickness_min_nm = 200;
    textured.material.iridescence_thickness_max_nm = 400;
    textured.material.textures[TextureSlot::iridescence].texture = textured.add_texel(0.5, 1, 1);
    textured.material.textures[TextureSlot::iridescence_thickness].texture = textured.add_texel(1, 0.25, 1);
    const Vec3d want = plain.f0(0.4), got = textured.f0(0.4);
    CHECK(got.x == Approx(want.x).epsilon(1e-3));
    CHECK(got.y == Approx(want.y).epsilon(1e-3));
    CHECK(got.z == Approx(want.z).epsilon(1e-3));
}

TEST_CASE("iridescence: what is mirrored is not scattered, and a white metal stays within all light",
          "[shading][iridescence][environment]") {
    for (const float metallic : {0.0f, 0.5f, 1.0f})
        for (const float nm : {50.0f, 180.0f, 333.0f, 600.0f})
            for (const double view : {0.0, 0.7, 1.2, 1.5}) {
                Bench bench;
                bench.material.base_color = {1, 1, 1, 1}, bench.material.metallic = metallic, bench.material.roughness = 0.3f;
                bench.material.iridescence_thickness_max_nm = nm;
                bench.set_sky(1.0);
                const Vec3d got = bench.seen_from(at_angle(view));
                INFO("metallic " << metallic << ", " << nm << " nm, view " << view << ": " << got.x << ' ' << got.y << ' ' << got.z);
                CHECK((std::max({got.x, got.y, got.z}) <= 1.0001 && std::min({got.x, got.y, got.z}) > 0.2));
            }
}

TEST_CASE("iridescence: extremes are finite, and the same bits on every set", "[shading][iridescence][kernels]") {
    for (const float ior : {0.0f, 1.0f, 1.0000001f, 1.33f, 7.0f, 1e30f})
        for (const float nm : {-1.0f, 0.0f, 0.01f, 0.03f, 250.0f, 1e4f, 1e30f})
            for (const float f0 : {0.0f, 1e-20f, 0.04f, 0.9999f, 1.0f}) {
                Bench bench;
                bench.material.iridescence_ior = ior, bench.material.iridescence_thickness_max_nm = nm;
                bench.material.dielectric_reflectance = f0, bench.material.base_color = {f0, f0, f0, 1}, bench.material.metallic = 0.5f;
                bench.add_light(at_angle(0.7, 2.0));
                bench.ambient = {{0.5f, 0.6f, 0.7f}, {0.1f, 0.1f, 0.1f}};
                for (const double view : {0.0, 0.7, 1.5707, 1.570797, 3.1}) {
                    const Vec3d want = bench.seen_from(at_angle(view));
                    INFO("ior " << ior << ", " << nm << " nm, F0 " << f0 << ", view " << view);
                    REQUIRE((std::isfinite(want.x) && std::isfinite(want.z) && want.x >= 0));
                    for (const Isa isa : halflit::test::available_isas()) {
                        const Vec3d got = bench.seen_from(at_angle(view), isa);
                        CHECK((got.x == want.x && got.y == want.y && got.z == want.z));
                    }
                }
            }
}
