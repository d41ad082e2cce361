#include "apps/engine/trade/trade_error.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

using namespace halflit;
using engine::TradeError, engine::TradeReference;

namespace {

/// The inverse of the sRGB curve above its linear part.
float linear_of(double code) { return static_cast<float>(std::pow((code / 255 + 0.055) / 1.055, 2.4)); }

/// One row of pixels of these codes in all channels, opaque.
Image row_of(const std::vector<double>& codes) {
    Image image{static_cast<int>(codes.size()), 1, std::vector<std::uint8_t>(codes.size() * 4, 0), {}};
    for (const double code : codes)
        image.rgba_linear.insert(image.rgba_linear.end(), {linear_of(code), linear_of(code), linear_of(code), 1.0f});
    return image;
}

// linear_of rounds to float32: 6e-8, times at most 112 codes per factor of e.
constexpr double kRounding = 2e-5;

}  // namespace

TEST_CASE("trade error: codes are compared before rounding, by a pixel's worst channel", "[cli][trade]") {
    const Image reference = row_of({100, 100, 100, 100});
    Image picture = row_of({100, 100.25, 98.5, 100});
    picture.rgba_linear[3 * 4 + 2] = linear_of(104);
    const TradeError error = TradeReference(reference, reference).error_of(picture);
    CHECK(error.max == Approx(4).margin(kRounding));
    CHECK(error.mean == Approx((0.25 + 1.5 + 4) / 4).margin(kRounding));
    CHECK(error.p999 == error.max);
    CHECK(error.share_off == Approx(0.5));
    const double mean_square = (3 * 0.25 * 0.25 + 3 * 1.5 * 1.5 + 4 * 4) / 12;
    CHECK(error.psnr.value() == Approx(10 * std::log10(255 * 255 / mean_square)).margin(1e-3));
}

TEST_CASE("trade error: codes are those after the tone curve", "[cli][trade]") {
    Image reference = row_of({100}), picture = row_of({100});
    for (std::size_t c = 0; c < 3; ++c) reference.rgba_linear[c] = 0.02f, picture.rgba_linear[c] = 0.03f;
    // Neutral shows 6.25 x^2 of a dark grey x: 0.0025, of which the codes are straight, and 0.005625.
    const TradeError error = TradeReference(reference, reference, ToneCurve::neutral).error_of(picture);
    CHECK(error.max == Approx(255 * (1.055 * std::pow(0.005625, 1 / 2.4) - 0.055 - 12.92 * 0.0025)).margin(1e-4));
}

TEST_CASE("trade error: equal pictures have none, values above white count as white", "[cli][trade]") {
    Image reference = row_of({255, 30});
    const TradeReference same(reference, reference);
    CHECK(same.error_of(reference).max == 0.0);
    CHECK(!same.error_of(reference).psnr);
    Image brighter = reference;
    brighter.rgba_linear[0] = 7.0f;
    CHECK(same.error_of(brighter).max == Approx(0).margin(kRounding));
}

TEST_CASE("trade error: one pixel in a thousand may be off by more than the 99.9th percentile", "[cli][trade]") {
    for (const std::size_t off : {1u, 2u}) {
        INFO(off << " of 1000");
        std::vector<double> codes(1000, 128.0);
        const Image reference = row_of(codes);
        for (std::size_t i = 0; i < off; ++i) codes[i * 500] = 138.0;
        const TradeError error = TradeReference(reference, reference).error_of(row_of(codes));
        CHECK(error.max == Approx(10).margin(kRounding));
        CHECK(error.p999 == Approx(off == 1 ? 0 : 10).margin(kRounding));
        CHECK(error.share_off == Approx(static_cast<double>(off) / 1000));
    }
}

TEST_CASE("trade error: pixels where nothing was drawn do not count, and are black in the difference", "[cli][trade]") {
    const Image reference = row_of({50, 60, 70});
    Image coverage = reference;
    coverage.rgba_linear[1 * 4 + 3] = 0.0f;
    const Image picture = row_of({50, 90, 72});
    const TradeReference compared(reference, coverage);
    CHECK(compared.pixels_drawn() == 2);
    CHECK(compared.error_of(picture).max == Approx(2).margin(kRounding));
    CHECK(compared.error_of(picture).mean == Approx(1).margin(kRounding));
    CHECK(compared.difference(picture, 10).rgba8 == std::vector<std::uint8_t>{0, 0, 0, 255, 0, 0, 0, 255, 20, 20, 20, 255});
    CHECK(compared.difference(picture, 1000).rgba8[8] == 255);
}
