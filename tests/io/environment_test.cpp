#include "shading/environment.hpp"
#include "halflit/image.hpp"

#include "sh/sun.hpp"
#include "tests/sh/bound_check.hpp"
#include "tests/support/assets.hpp"
#include "tests/support/skip.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace halflit;
using namespace halflit::sh;
using namespace halflit::test;

namespace {

const char* const kNames[] = {"kiara_1_dawn_1k.hdr", "studio_small_03_1k.hdr", "spiaggia_di_mondello_1k.hdr"};

EnvironmentImage load(const char* name) {
    const auto environment = read_environment((*asset_dir() / "environments" / name).string());
    REQUIRE(environment);
    return *environment;
}

bool have_environments() { return asset_dir() && std::filesystem::is_directory(*asset_dir() / "environments"); }

/// Checks the bounds of an image as it is, and with its suns taken out at full size. Both are averaged over blocks, so that they are
/// patches of light again, which brute force can integrate.
void check_environment_bounds(const char* name, int factor, int normal_count, Choices& as_is, Choices& without_suns) {
    INFO(name);
    const EnvironmentImage environment = load(name);
    const auto normals = random_normals(normal_count, 81);
    check_bounds(downsampled(shading::view_of(environment), factor), normals, 1e-3, as_is);
    const SunExtraction found = extract_suns(shading::view_of(environment), Projection(shading::view_of(environment)));
    if (found.suns.empty()) return;
    const EquirectView rest{environment.width, environment.height, found.residual_rgb};
    check_bounds(downsampled(rest, factor), normals, 1e-3, without_suns);
}

}  // namespace

TEST_CASE("environment: the shared pictures have the mean radiance that an independent reader finds", "[io][environment]") {
    if (!have_environments()) HALFLIT_SKIP("no environments among the assets");
    const struct {
        Vec3d mean;
        float max;
    } known[] = {{{1.1, 0.7327, 1.125}, 102.5f}, {{1.968, 2.261, 2.549}, 3568.0f}, {{0.8122, 0.8459, 0.8772}, 7.27e4f}};
    for (std::size_t i = 0; i < 3; ++i) {
        INFO(kNames[i]);
        const EnvironmentImage environment = load(kNames[i]);
        CHECK(environment.width == 1024);
        CHECK(environment.height == 512);
        const Vec3d mean = Projection(shading::view_of(environment)).mean();
        CHECK(mean.x == Approx(known[i].mean.x).epsilon(5e-4));  // four digits; rows weighted by the sine in their middle
        CHECK(mean.y == Approx(known[i].mean.y).epsilon(5e-4));
        CHECK(mean.z == Approx(known[i].mean.z).epsilon(5e-4));
        CHECK(*std::max_element(environment.rgb.begin(), environment.rgb.end()) == Approx(known[i].max).epsilon(5e-4));
    }
}

TEST_CASE("environment: ten lobes under the shared pictures, 1,000 normals: no error above its bound", "[io][environment]") {
    if (!have_environments()) HALFLIT_SKIP("no environments among the assets");
    Choices as_is, without_suns;
    for (const char* name : kNames) check_environment_bounds(name, 16, 1000, as_is, without_suns);
    CHECK(as_is.made > 80);
    CHECK(as_is.more_than_two_above * 20 <= as_is.made);
    CHECK(without_suns.made > 50);
    CHECK(without_suns.more_than_two_above == 0);
}

TEST_CASE("environment: suns of the shared pictures keep all energy and lower the bound", "[io][environment]") {
    if (!have_environments()) HALFLIT_SKIP("no environments among the assets");
    const LobeSpectrum lambert = lobe_spectrum({0.0, 1.0, 1.0});
    const std::size_t counts[] = {0, 1, 1};  // dawn without a sun; studio lights; a sun above the sea
    for (std::size_t i = 0; i < 3; ++i) {
        INFO(kNames[i]);
        const EnvironmentImage environment = load(kNames[i]);
        const Projection full(shading::view_of(environment));
        const SunExtraction found = extract_suns(shading::view_of(environment), full);
        CHECK((counts[i] == 0 ? found.suns.empty() : found.suns.size() >= counts[i]));
        Vec3d energy = found.residual.mean() * (4 * kPi);
        for (const Sun& sun : found.suns) energy = energy + sun.irradiance;
        CHECK(energy.x == Approx(full.mean().x * 4 * kPi).epsilon(1e-5));
        CHECK(energy.y == Approx(full.mean().y * 4 * kPi).epsilon(1e-5));
        CHECK(energy.z == Approx(full.mean().z * 4 * kPi).epsilon(1e-5));
        const double before = largest(order_bounds(full.spectrum(), lambert).by_order[4]);
        const double after = largest(order_bounds(found.residual.spectrum(), lambert).by_order[4] + sun_bound(found.suns, lambert));
        if (!found.suns.empty()) CHECK(after < 0.9 * before);
    }
}

TEST_CASE("environment: the built-in sky has the sun and the colours that are documented", "[io][environment]") {
    const EnvironmentImage sky = built_in_sky();
    REQUIRE(sky.width == 512);
    REQUIRE(sky.height == 256);
    for (const float v : sky.rgb) REQUIRE((v >= 0 && v < 1e4f));
    const Projection full(shading::view_of(sky));
    const SunExtraction found = extract_suns(shading::view_of(sky), full);
    REQUIRE(found.suns.size() == 1);
    const Sun& sun = found.suns[0];
    CHECK(std::asin(sun.direction.y) * 180 / kPi == Approx(40).margin(0.2));
    CHECK(sun.direction.x > 0);
    CHECK(sun.direction.z > 0);
    CHECK(sun.irradiance.x / kPi == Approx(1.0).epsilon(0.03));
    CHECK(sun.irradiance.z / kPi == Approx(0.78).epsilon(0.03));
    // Blue overhead, pale at the horizon, darker below.
    const auto value = [&](double u, double v) { return shading::view_of(sky).at(static_cast<int>(u * 512), static_cast<int>(v * 256)); };
    CHECK(value(0.2, 0.02).z > 2 * value(0.2, 0.02).x);
    CHECK(luminance(value(0.2, 0.47)) > luminance(value(0.2, 0.02)));
    CHECK(luminance(value(0.2, 0.9)) < luminance(value(0.2, 0.47)));
    const PreconvolvedSh lambert = convolve(found.residual.radiance(), zonal_bands({0.0, 1.0, 1.0}), 5);
    CHECK(luminance(evaluate(lambert, {0, 1, 0})) == Approx(0.4).margin(0.1));
    CHECK(luminance(evaluate(lambert, {0, -1, 0})) < 0.25);
}

TEST_CASE("environment: the error for a missing file names it", "[io][environment]") {
    const auto missing = read_environment("no/such/file.hdr");
    REQUIRE_FALSE(missing);
    CHECK(missing.error().code == ErrorCode::io);
    CHECK(missing.error().message.find("no/such/file.hdr") != std::string::npos);
}
