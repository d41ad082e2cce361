#include "sh/order.hpp"

#include "tests/sh/bound_check.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

using namespace halflit;
using namespace halflit::sh;
using namespace halflit::test;

TEST_CASE("order: bounds hold under random skies with a sun", "[sh][order]") {
    const auto normals = random_normals(200, 31);
    Choices choices;
    for (const std::uint64_t seed : {41u, 42u, 43u}) check_bounds(random_sky(32, 16, seed), normals, 1e-3, choices);
    CHECK(choices.made > 60);
    CHECK(choices.more_than_two_above * 20 <= choices.made);
}

TEST_CASE("order: a sky of one colour needs one band, and a lobe of three bands three", "[sh][order]") {
    const Projection flat(painted_sky(32, 16, [](Vec3d) { return Vec3d{1, 2, 3}; }).view());
    for (const WrapLobe& lobe : kTenLobes) {
        CHECK(pick_order(order_bounds(flat.spectrum(), lobe_spectrum(lobe)), 1e-6).order == 1);
        CHECK(pick_order(BandGrid(flat).order_bounds(lobe_spectrum(lobe)), 1e-6).order == 1);
    }
    const Projection sky(random_sky(32, 16, 44).view());
    const OrderBounds valve = order_bounds(sky.spectrum(), lobe_spectrum({1.0, 2.0, 1.0}));
    CHECK(largest(valve.by_order[2]) == 0.0);
    CHECK(pick_order(valve, 0.0).order == 3);
    CHECK(pick_order(order_bounds(sky.spectrum(), lobe_spectrum({1.0, 1.0, 1.0})), 0.0).order == 2);
}

TEST_CASE("order: the bound for one direction of irradiance pi is the sum of |f_l| (2l+1)/4", "[sh][order]") {
    // A pixel of 0.35 degrees acts as a single direction in 64 bands; the sum over all bands is then known.
    Sky sky = painted_sky(1024, 512, [](Vec3d) { return Vec3d{}; });
    const double radiance = kPi / pixel_solid_angle(1024, 512, 200);
    for (std::size_t i = 0; i < 3; ++i) sky.rgb[(200 * 1024 + 300) * 3 + i] = static_cast<float>(radiance);
    const WrapLobe lobe{0.5, 1.5, 1.0};
    const LobeSpectrum spectrum = lobe_spectrum(lobe);
    const OrderBounds bounds = order_bounds(Projection(sky.view()).spectrum(), spectrum);
    double sum = kPi * spectrum.tail_sum;
    for (std::size_t l = kSpectrumBands; l-- > 1;) {
        sum += std::abs(spectrum.f[l]) * (2.0 * static_cast<double>(l) + 1) / 4;
        if (l <= kMaxBands) CHECK(bounds.by_order[l - 1].y == Approx(sum).epsilon(2e-3));
        // The true error, at the worst angle, is that of the lobe's own series.
        if (l <= kMaxBands) CHECK(truncation_error(lobe, static_cast<int>(l)).sup <= sum);
    }
}

TEST_CASE("order: the tolerance is a fraction of the scale, and where no order keeps it the choice is 10 with its bound", "[sh][order]") {
    OrderBounds bounds;
    for (std::size_t i = 0; i < kMaxBands; ++i)
        bounds.by_order[i] = {0.0, 1.0 / static_cast<double>(1 + i), 0.5 / static_cast<double>(1 + i)};
    CHECK(pick_order(bounds, 0.25).order == 4);
    CHECK(pick_order(bounds, 0.125, 2.0).order == 4);
    CHECK(pick_order(bounds, 0.25).within);
    const OrderChoice none = pick_order(bounds, 0.01);
    CHECK(none.order == kMaxBands);
    CHECK(none.bound == 0.1);
    CHECK_FALSE(none.within);
}

TEST_CASE("order: darkness needs one band", "[sh][order]") {
    for (const WrapLobe& lobe : {WrapLobe{0.0, 0.0, 1.0}, WrapLobe{0.0, 1.0, 1.0}}) {
        CHECK(pick_order(order_bounds(Projection().spectrum(), lobe_spectrum(lobe)), 0.0).order == 1);
        CHECK(pick_order(BandGrid(Projection()).order_bounds(lobe_spectrum(lobe)), 0.0).order == 1);
    }
}
