// Tone curves: kernels against closed forms in float64, the curves' own promises, extremes.
#include "shading/reference/tone.hpp"
#include "floats.hpp"
#include "shading/kernels/shade_kernels.hpp"
#include "shading/model/srgb.hpp"
#include "shading/reference/reference.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>

using namespace halflit;
using namespace halflit::shading;
using namespace halflit::testing;

namespace {

constexpr ToneCurve kCurves[] = {ToneCurve::reinhard, ToneCurve::aces, ToneCurve::neutral};

using Colors = std::array<std::vector<float>, 3>;

/// Padded to whole vectors.
Colors toned(const Colors& light, ToneCurve curve, Isa isa = Isa::scalar, float exposure = 1.0f) {
    Colors in = light, out;
    const std::size_t count = in[0].size(), padded = (count + 15) / 16 * 16;
    for (std::size_t c = 0; c < 3; ++c) in[c].resize(padded), out[c].resize(padded);
    const float* const from[3] = {in[0].data(), in[1].data(), in[2].data()};
    float* const to[3] = {out[0].data(), out[1].data(), out[2].data()};
    shade_kernels(isa).tone(curve, from, exposure, to, static_cast<int>(count));
    for (auto& channel : out) channel.resize(count);
    return out;
}

void add(Colors& colors, float red, float green, float blue) {
    colors[0].push_back(red);
    colors[1].push_back(green);
    colors[2].push_back(blue);
}

Vec3d at(const Colors& colors, std::size_t i) {
    return {static_cast<double>(colors[0][i]), static_cast<double>(colors[1][i]), static_cast<double>(colors[2][i])};
}

float toned_grey(float x, ToneCurve curve) {
    Colors one;
    add(one, x, x, x);
    return toned(one, curve)[1][0];
}

/// The tone curves' inverses, by their closed forms, for display light below white. Negative for saturated colours near white, which
/// neutral never shows.
Vec3d light_of(ToneCurve curve, Vec3d shown) {
    if (curve == ToneCurve::reinhard) return shown * (1 / (1 - (0.2126 * shown.x + 0.7152 * shown.y + 0.0722 * shown.z)));
    if (curve == ToneCurve::aces) {
        const auto channel = [](double y) {  // (2.51 - 2.43 y) x^2 + (0.03 - 0.59 y) x - 0.14 y = 0
            const double a = 2.51 - 2.43 * y, b = 0.03 - 0.59 * y, c = -0.14 * y;
            return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
        };
        return {channel(shown.x), channel(shown.y), channel(shown.z)};
    }
    // pn is the peak of what is shown. Desaturation is undone next, then compression, then the offset: least = 6.25 x^2 below 0.04.
    const double pn = std::max({shown.x, shown.y, shown.z});
    Vec3d c = shown;
    if (pn > 0.76) {
        const double p = 0.52 + 0.24 * 0.24 / (1 - pn), g = 1 / (0.15 * (p - pn) + 1);
        const auto back = [&](double x) { return (x - pn * (1 - g)) / g * p / pn; };
        c = {back(c.x), back(c.y), back(c.z)};
    }
    const double least = std::min({c.x, c.y, c.z});
    const double offset = least < 0.0 ? 0.0 : least < 0.04 ? std::sqrt(least / 6.25) - least : 0.04;
    return {c.x + offset, c.y + offset, c.z + offset};
}

}  // namespace

TEST_CASE("tone: kernels are within 0.01 codes of the formulas in float64, for light from 0 to 1e6", "[shading][tone]") {
    FloatMaker make(31);
    Colors light;
    const auto some = [&] { return std::exp2(make.ordinary(-30.0f, 20.0f)); };
    for (int i = 0; i < 200000; ++i) {
        const float grey = some();
        add(light, grey, grey, grey);
        add(light, some(), some(), some());
        add(light, grey, grey * make.ordinary(0.5f, 1.5f), grey * make.ordinary(0.5f, 1.5f));
        add(light, i % 2 ? 0.0f : some(), some(), i % 3 ? 0.0f : some());
        add(light, make.ordinary(0.0f, 1.2f), make.ordinary(0.0f, 1.2f), make.ordinary(0.0f, 0.1f));
    }
    for (const ToneCurve curve : kCurves) {
        const Colors got = toned(light, curve);
        double worst = 0;
        for (std::size_t i = 0; i < light[0].size(); ++i) {
            const Vec3d want = reference::toned(curve, at(light, i)), found = at(got, i);
            const auto off = [](double a, double b) { return std::fabs(reference::srgb_code(a) - reference::srgb_code(b)); };
            worst = std::max({worst, off(want.x, found.x), off(want.y, found.y), off(want.z, found.z)});
        }
        INFO("curve " << static_cast<int>(curve) << ", worst " << worst);
        CHECK(worst > 0);
        CHECK(worst <= 1e-4);  // measured: 3e-5
    }
}

TEST_CASE("tone: known values of the curves", "[shading][tone]") {
    CHECK(toned_grey(1.0f, ToneCurve::reinhard) == Approx(0.5));
    CHECK(toned_grey(3.0f, ToneCurve::reinhard) == Approx(0.75));
    CHECK(toned_grey(1.0f, ToneCurve::aces) == Approx(2.54 / 3.16));
    CHECK(toned_grey(0.02f, ToneCurve::aces) == Approx(0.02 * 0.0802 / (0.02 * 0.6386 + 0.14)));
    CHECK(toned_grey(7.25f, ToneCurve::aces) == 1.0f);  // 0.08 x^2 - 0.56 x - 0.14 = 0 at 7.24
    CHECK(toned_grey(0.04f, ToneCurve::neutral) == Approx(0.01));
    CHECK(toned_grey(0.5f, ToneCurve::neutral) == Approx(0.46));
    CHECK(toned_grey(1.0f, ToneCurve::neutral) == Approx(1 - 0.0576 / 0.44));
    // Hue: blue light over white is mixed with white, by [PBRN]'s g.
    Colors blue;
    add(blue, 0.0f, 0.0f, 4.0f);
    const Colors shown = toned(blue, ToneCurve::neutral);
    const double pn = 1 - 0.0576 / 3.48, g = 1 / (0.15 * (4 - pn) + 1);
    CHECK(shown[0][0] == Approx(pn * (1 - g)));
    CHECK(shown[2][0] == Approx(pn));
    Colors orange;
    add(orange, 2.0f, 1.0f, 0.5f);
    const Colors kept = toned(orange, ToneCurve::reinhard);
    CHECK(kept[0][0] == Approx(2 * kept[1][0]));
    CHECK(kept[1][0] == Approx(2 * kept[2][0]));
}

TEST_CASE("tone: neutral leaves colours from 0.08 to 0.8 as they are, less 0.04", "[shading][tone]") {
    FloatMaker make(5);
    Colors light;
    for (int i = 0; i < 20000; ++i) add(light, make.ordinary(0.08f, 0.8f), make.ordinary(0.08f, 0.8f), make.ordinary(0.08f, 0.8f));
    const Colors got = toned(light, ToneCurve::neutral);
    int off = 0;
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < light[c].size(); ++i) off += got[c][i] != light[c][i] - 0.04f;
    CHECK(off == 0);
}

TEST_CASE("tone: 8-bit colours come back from the light that a curve's inverse gives for them", "[shading][tone]") {
    for (const ToneCurve curve : kCurves) {
        Colors light;
        std::vector<std::array<int, 3>> codes;
        for (int r = 0; r < 255; r += 2)
            for (int g = 0; g < 255; g += 9)
                for (int b = 0; b < 255; b += 11) {
                    const Vec3d v =
                        light_of(curve, {linear_from_srgb(r / 255.0), linear_from_srgb(g / 255.0), linear_from_srgb(b / 255.0)});
                    if (!(std::min({v.x, v.y, v.z}) >= 0.0)) continue;
                    add(light, static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
                    codes.push_back({r, g, b});
                }
        CHECK(codes.size() > 45000);
        const Colors shown = toned(light, curve);
        int off = 0;
        for (std::size_t i = 0; i < codes.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c) off += std::lround(reference::srgb_code(static_cast<double>(shown[c][i]))) != codes[i][c];
        INFO("curve " << static_cast<int>(curve));
        CHECK(off == 0);
    }
}

TEST_CASE("tone: grey light never gets darker as it grows, and infinity is white", "[shading][tone]") {
    Colors greys;
    for (double x = 1e-9; x < 2e6; x *= 1.0001) add(greys, static_cast<float>(x), static_cast<float>(x), static_cast<float>(x));
    for (const ToneCurve curve : kCurves) {
        INFO("curve " << static_cast<int>(curve));
        const Colors got = toned(greys, curve);
        std::vector<std::uint32_t> codes(got[0].size() + 16);
        shade_kernels(Isa::scalar)
            .encode_srgb8(got[0].data(), got[1].data(), got[2].data(), got[0].data(), 1.0f, codes.data(),
                          static_cast<int>(got[0].size() / 16 * 16));
        int falls = 0, colored = 0;
        for (std::size_t i = 1; i < got[0].size(); ++i) {
            // float32 rounds quotients of numbers that grow, and neutral's offset, which is below 0.04.
            falls += got[0][i] < got[0][i - 1] * (1 - 4e-7f) - 4e-9f;
            if (i < got[0].size() / 16 * 16) falls += (codes[i] & 255u) < (codes[i - 1] & 255u);
            colored += got[0][i] != got[1][i] || got[1][i] != got[2][i];
        }
        CHECK(falls == 0);
        CHECK(colored == 0);
        CHECK(toned_grey(0.0f, curve) == 0.0f);
        for (const float huge : {1e6f, 1e10f, 1e18f, 1e30f, 3.4e38f, kInf}) CHECK(toned_grey(huge, curve) == Approx(1.0).margin(2e-6));
        for (const float none : {-1.0f, -kInf, kNan, -kNan, -0.0f}) CHECK(toned_grey(none, curve) == 0.0f);
    }
}

TEST_CASE("tone: any floats give display light from 0 to 1, the same bits on every set", "[shading][tone]") {
    FloatMaker make(77);
    Colors light;
    for (int i = 0; i < 40000; ++i) add(light, make.wild(-0.1f, 3.0f), make.wild(-0.1f, 3.0f), make.wild(-0.1f, 3.0f));
    for (const ToneCurve curve : kCurves)
        for (const float exposure : {1.0f, 0.3f, 1e20f, kInf, kNan}) {
            const Colors want = toned(light, curve, Isa::scalar, exposure);
            int outside = 0;
            for (const auto& channel : want)
                for (const float x : channel) outside += !(x >= 0.0f && x <= 1.0f);
            INFO("curve " << static_cast<int>(curve) << ", exposure " << exposure);
            CHECK(outside == 0);
            for (const Isa isa : test::available_isas()) {
                const Colors got = toned(light, curve, isa, exposure);
                int off = 0;
                for (std::size_t c = 0; c < 3; ++c)
                    for (std::size_t i = 0; i < light[c].size(); ++i) off += !same_bits(got[c][i], want[c][i]);
                INFO(isa_name(isa));
                CHECK(off == 0);
            }
        }
}
