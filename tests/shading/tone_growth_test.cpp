// The factors by which a tone curve may enlarge errors of light (tone_growth): covered by boxes, each with a bound, and sampled.
#include "shading/model/tone.hpp"
#include "shading/reference/reference.hpp"
#include "shading/reference/tone.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

using namespace halflit;
using namespace halflit::shading;

namespace {

// c is the sRGB curve in codes, c1 the same with the logarithm beyond white that budgets count with: budget/DERIVATION.md.
constexpr double kEnd = 0.0031308;
double c(double v) { return reference::srgb_code(v); }
double c1(double v) { return v <= 1 ? c(v) : 255 + 255 * 1.055 / 2.4 * std::log(v); }
double slope_of_c(double v) { return v <= kEnd ? 255 * 12.92 : 255 * 1.055 / 2.4 * std::pow(v, 1 / 2.4 - 1); }
/// 1 / c1', which rises.
double per_slope(double v) { return v <= 1 ? 1 / slope_of_c(v) : v * 2.4 / (255 * 1.055); }

/// A kind of error: a change of a channel v by at most weight(v) times a small step costs, with the curve T, at most slope(T) times that of
/// T. Slopes fall, weights rise.
struct Kind {
    double (*slope)(double shown);
    double (*weight)(double v);
    double ErrorGrowth::*growth;
};
constexpr double kCodesAtWhite = 255 * 1.055 / 2.4;
constexpr Kind kAbsolute{[](double) { return 1.0; }, [](double) { return 1.0; }, &ErrorGrowth::absolute};
constexpr Kind kRelative{slope_of_c, [](double v) { return v / kCodesAtWhite; }, &ErrorGrowth::relative};
constexpr Kind kOther{slope_of_c, per_slope, &ErrorGrowth::other};

/// A range of a variable.
struct Range {
    double low, high;
    [[nodiscard]] std::array<Range, 2> halves() const {
        const double middle = std::sqrt(low * high);
        return {Range{low, middle}, Range{middle, high}};
    }
};

/// Upper bound of slope(T) T' weight over a range of light, T being aces. T' = (1.408 x^2 + 0.7028 x + 0.0042) / D^2, D the denominator.
double aces_bound(const Kind& kind, Range x) {
    const auto shown = [](double v) { return v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14); };
    const double d = x.low * (2.43 * x.low + 0.59) + 0.14;
    if (shown(x.low) >= 1) return 0.0;
    return kind.slope(shown(x.low)) * (1.408 * x.high * x.high + 0.7028 * x.high + 0.0042) / (d * d) * kind.weight(x.high);
}

double compressed(double p) { return 1 - 0.0576 / (p - 0.52); }               // [PBRN]'s p_n
double rise(double p) { return 0.0576 / ((p - 0.52) * (p - 0.52)); }          // d p_n / d p
double saturation(double p) { return 1 / (0.15 * (p - compressed(p)) + 1); }  // g
double scale(double p) { return compressed(p) * saturation(p) / p; }          // all of these fall in p, except p_n

/// Upper bound of the sum over j of |dT_i/dv_j| slope(T_i) weight(v_j) for neutral, over a box: m the least channel of the light, a channel
/// i without the offset, p the largest channel without the offset. DERIVATION.md has the derivatives.
double neutral_bound(const Kind& kind, Range m, Range a, Range p) {
    const bool curved = m.low < 0.08;
    const double offset = curved ? std::min(m.high, 0.08) - 6.25 * std::min(m.high, 0.08) * std::min(m.high, 0.08) : 0.04;
    const double by_least = curved ? (1 - 12.5 * m.low) * kind.weight(std::min(m.high, 0.08)) : 0.0;
    if (p.high <= 0.76) return kind.slope(a.low) * (kind.weight(a.high + offset) + by_least);
    const double low = std::max(p.low, 0.76), n_low = compressed(low), n_high = compressed(p.high);
    const double direct = scale(low), shown = a.low * scale(p.high) + n_low * (1 - saturation(low));
    const double u_low = a.low / p.high, u_high = std::min(1.0, a.high / low);
    const double whiter = rise(low) * (1 - saturation(p.high)) + n_high * 0.15 * (1 - rise(p.high)) * saturation(low) * saturation(low);
    const double least_scaled = rise(p.high) - scale(low), most_scaled = rise(low) - scale(p.high);
    const double by_peak = (1 - u_low) * whiter + u_high * std::max(std::fabs(least_scaled), std::fabs(most_scaled));
    // The offset lowers channel and peak together, dT_i / df = -(A + P), and A + P >= 0.
    const double by_offset = direct + (1 - u_low) * whiter + (most_scaled > 0 ? u_high : u_low) * most_scaled;
    return kind.slope(shown) * (direct * kind.weight(a.high + offset) + by_offset * by_least + by_peak * kind.weight(p.high + offset));
}

/// True if the bound is at most `growth` in the box, cut into smaller ones where needed. Counts the boxes.
bool covered(const Kind& kind, Range m, Range a, Range p, double growth, long& boxes) {
    const double least = std::min(m.low, 0.08);
    if (a.high < 6.25 * least * least) return true;  // channel i would be below the least
    if (a.low > p.high) return true;
    ++boxes;
    if (neutral_bound(kind, m, a, p) <= growth) return true;
    if (boxes > 20000000) return false;
    const auto width = [](Range r) { return r.low > 0 ? std::log(r.high / r.low) : 0.0; };
    const double wm = m.low >= 0.08 ? 0.0 : width(m), wa = width(a), wp = width(p) > 0.02 ? 1e3 : width(p);  // p counts most
    if (std::max({wm, wa, wp}) < 1e-6) return false;
    if (wm >= wa && wm >= wp) {
        for (const Range half : m.halves())
            if (!covered(kind, half, a, p, growth, boxes)) return false;
    } else if (wa >= wp) {
        for (const Range half : a.halves())
            if (!covered(kind, m, half, p, growth, boxes)) return false;
    } else {
        for (const Range half : p.halves())
            if (!covered(kind, m, a, half, growth, boxes)) return false;
    }
    return true;
}

/// The largest change by a curve, divided by the largest that the kind of error counts with, between neighbours and between lights far from
/// each other. Absolute errors are compared as light, others as codes.
double largest_growth(const Kind& kind, ToneCurve curve) {
    std::mt19937 engine(17);
    std::uniform_real_distribution<double> exponent(-14, 14), unit(0, 1);
    std::normal_distribution<double> normal;
    const bool absolute = kind.growth == &ErrorGrowth::absolute, relative = kind.growth == &ErrorGrowth::relative;
    const auto before = [&](double v) { return absolute ? v : relative ? kCodesAtWhite * std::log(v) : c1(v); };
    const auto after = [&](double shown) { return absolute ? shown : c(shown); };
    const auto most_apart = [](const auto& of, Vec3d a, Vec3d b) {
        return std::max({std::fabs(of(a.x) - of(b.x)), std::fabs(of(a.y) - of(b.y)), std::fabs(of(a.z) - of(b.z))});
    };
    const auto quotient = [&](Vec3d v, Vec3d w) {
        const double without = most_apart(before, v, w);
        return without > 1e-9 * (absolute ? 1e-6 : 1) ? most_apart(after, reference::toned(curve, v), reference::toned(curve, w)) / without
                                                      : 0.0;
    };
    // Neighbours: each channel is one small step up or down.
    const auto stepped = [&](Vec3d v, double step, int signs) {
        const auto moved = [&](double x, bool up) { return std::max(x * 1e-3, x + (up ? step : -step) * kind.weight(x)); };
        return Vec3d{moved(v.x, signs & 1), moved(v.y, signs & 2), moved(v.z, signs & 4)};
    };
    const double small = absolute ? 1e-8 : 1e-4, large = absolute ? 0.2 : 60.0;
    const auto near = [&](Vec3d v) {
        double most = 0;
        for (int signs = 0; signs < 8; ++signs) most = std::max(most, quotient(v, stepped(v, small, signs)));
        return most;
    };
    double most = 0;
    for (int start = 0; start < 100; ++start) {
        Vec3d best{};
        double found = 0;
        for (int i = 0; i < 3000; ++i) {
            const auto any = [&] { return std::exp(exponent(engine)); };
            const Vec3d v{any(), any(), any()}, w = stepped(v, large * unit(engine), i % 8);
            most = std::max(most, quotient(v, w));
            if (const double q = near(v); q > found) found = q, best = v;
        }
        double spread = 0.5;
        for (int i = 0; i < 1500; ++i, spread = std::max(1e-4, spread * 0.995)) {
            const auto moved = [&](double x) { return x * std::exp(spread * normal(engine)); };
            const Vec3d v{moved(best.x), moved(best.y), moved(best.z)};
            if (const double q = near(v); q > found) found = q, best = v;
        }
        most = std::max(most, found);
    }
    return most;
}

}  // namespace

TEST_CASE("tone growth: boxes over all light prove the factors of aces", "[shading][tone]") {
    for (const auto& [kind, least] : {std::pair{kAbsolute, 1.75}, {kRelative, 0.55}, {kOther, 1.5}}) {
        double most = aces_bound(kind, {0.0, 1e-9});
        for (double x = 1e-9; x < 10; x *= 1.0002) most = std::max(most, aces_bound(kind, {x, x * 1.0002}));  // white from 7.24 on
        CHECK(most <= tone_growth(ToneCurve::aces).*kind.growth);
        CHECK(most > least);
    }
}

TEST_CASE("tone growth: boxes over all light prove the factors of neutral", "[shading][tone]") {
    for (const Kind& kind : {kAbsolute, kRelative, kOther}) {
        const double growth = tone_growth(ToneCurve::neutral).*kind.growth;
        long boxes = 0;
        const Range wide{1e-12, 0.76};
        for (const Range m : {Range{0.0, 1e-12}, Range{1e-12, 0.08}, Range{0.08, 1e12}}) {
            for (const Range a : {Range{0.0, 1e-12}, wide}) CHECK(covered(kind, m, a, {1e-12, 0.76}, growth, boxes));
            for (double p = 0.76; p < 1e12; p *= 2)
                for (const Range a : {Range{0.0, 1e-12}, Range{1e-12, 2 * p}}) CHECK(covered(kind, m, a, {p, 2 * p}, growth, boxes));
        }
        INFO(boxes << " boxes");
        CHECK(boxes > 100);
    }
}

TEST_CASE("tone growth: samples of all light come near the factors, and never above them", "[shading][tone]") {
    const std::pair<ToneCurve, ErrorGrowth> least[] = {
        {ToneCurve::reinhard, {1.6, 1.5, 1.8}}, {ToneCurve::aces, {1.75, 0.56, 1.56}}, {ToneCurve::neutral, {2.0, 1.9, 6.0}}};
    for (const auto& [curve, sampled] : least)
        for (const Kind& kind : {kAbsolute, kRelative, kOther}) {
            const double found = largest_growth(kind, curve);
            INFO("curve " << static_cast<int>(curve) << ": " << found);
            CHECK(found <= tone_growth(curve).*kind.growth);
            CHECK(found >= sampled.*kind.growth);
        }
}
