// Tests of every operation that kernels use, on each instruction set against scalar, and of the elementary functions against long double.
#include "elementary/elementary.hpp"
#include "floats.hpp"
#include "shading/plan/pow_tier.hpp"
#include "tests/support/all_cores.hpp"
#include "tests/support/skip.hpp"

#include "tests/support/catch.hpp"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <string>

using namespace halflit;
using namespace halflit::testing;

namespace {

/// Every 4093rd of all 2^32 floats, and the special values.
std::vector<float> spread_of_floats() {
    std::vector<float> values = special_floats();
    for (std::uint64_t i = 0; i < (1ull << 32); i += 4093) values.push_back(std::bit_cast<float>(static_cast<std::uint32_t>(i)));
    while (values.size() % 16 != 0) values.push_back(0.25f);
    return values;
}

/// Difference of one set from scalar in one operation. Differences are indexed [set][operation].
struct Difference {
    std::int64_t count = 0;
    float x = 0, want = 0, got = 0;  ///< the first that was found
};
using Differences = std::vector<std::vector<Difference>>;

/// Runs every unary operation on x by every set.
void compare_unary(const std::vector<float>& x, const std::vector<Isa>& isas, Differences& differences) {
    const Elementary& scalar = elementary(Isa::scalar);
    const int count = static_cast<int>(x.size());
    std::vector<float> want(x.size()), got(x.size());
    for (int f = 0; f < scalar.unary_count; ++f) {
        scalar.unary[f].run(x.data(), want.data(), count);
        for (std::size_t set = 0; set < isas.size(); ++set) {
            elementary(isas[set]).unary[f].run(x.data(), got.data(), count);
            if (std::memcmp(want.data(), got.data(), x.size() * sizeof(float)) == 0) continue;
            Difference& difference = differences[set][static_cast<std::size_t>(f)];
            for (std::size_t i = 0; i < x.size(); ++i)
                if (!same_bits(want[i], got[i]) && difference.count++ == 0)
                    difference.x = x[i], difference.want = want[i], difference.got = got[i];
        }
    }
}

Differences no_differences(std::size_t set_count) {
    const auto unary_count = static_cast<std::size_t>(elementary(Isa::scalar).unary_count);
    return Differences(set_count, std::vector<Difference>(unary_count));
}

void check_none(const std::vector<Isa>& isas, const Differences& differences) {
    for (std::size_t set = 0; set < isas.size(); ++set) {
        REQUIRE(elementary(isas[set]).unary_count == static_cast<int>(differences[set].size()));
        for (std::size_t f = 0; f < differences[set].size(); ++f) {
            const Difference& first = differences[set][f];
            INFO(isa_name(isas[set]) << " " << elementary(isas[set]).unary[f].name << ", first: (" << first.x << ") is " << first.got
                                     << ", scalar says " << first.want);
            CHECK(first.count == 0);
        }
    }
}

double ulps_from(float got, long double exact) {
    int exponent = 0;
    (void)std::frexp(static_cast<double>(exact), &exponent);
    return static_cast<double>(std::fabs(static_cast<long double>(got) - exact) / std::ldexp(1.0L, exponent - 24));
}

}  // namespace

TEST_CASE("vocabulary: every unary operation gives scalar's bits on every set", "[shading][simd]") {
    const std::vector<Isa> isas = other_isas();
    if (isas.empty()) HALFLIT_SKIP("no set but scalar here");
    const std::vector<float> x = spread_of_floats();
    REQUIRE(x.size() > 1000000);
    Differences differences = no_differences(isas.size());
    compare_unary(x, isas, differences);
    check_none(isas, differences);
}

TEST_CASE("vocabulary: every unary operation gives scalar's bits on every set for all 2^32 floats", "[shading][simd][deep]") {
    const std::vector<Isa> isas = other_isas();
    if (isas.empty()) HALFLIT_SKIP("no set but scalar here");
    constexpr std::int64_t kRun = 1 << 14;  // x, want and got stay in the inner caches: 192 KB
    constexpr std::int64_t kRuns = (std::int64_t{1} << 32) / kRun;
    Differences all = no_differences(isas.size());
    std::mutex mutex;
    std::int64_t compared = 0;
    test::on_all_cores(kRuns, [&](std::int64_t run) {
        std::vector<float> x(kRun);
        for (std::int64_t i = 0; i < kRun; ++i)
            x[static_cast<std::size_t>(i)] = std::bit_cast<float>(static_cast<std::uint32_t>(run * kRun + i));
        Differences differences = no_differences(isas.size());
        compare_unary(x, isas, differences);
        const std::lock_guard lock(mutex);
        compared += kRun;
        for (std::size_t set = 0; set < isas.size(); ++set)
            for (std::size_t f = 0; f < all[set].size(); ++f) {
                Difference merged = all[set][f].count == 0 ? differences[set][f] : all[set][f];
                merged.count = all[set][f].count + differences[set][f].count;
                all[set][f] = merged;
            }
    });
    CHECK(compared == std::int64_t{1} << 32);
    check_none(isas, all);
}

TEST_CASE("vocabulary: every operation of two and three operands gives scalar's bits on every set", "[shading][simd]") {
    if (other_isas().empty()) HALFLIT_SKIP("no set but scalar here");
    std::vector<float> a, b, c;
    for (const float x : special_floats())
        for (const float y : special_floats())
            for (const float z : special_floats()) a.push_back(x), b.push_back(y), c.push_back(z);
    FloatMaker make(7);
    while (a.size() < 200000 || a.size() % 16 != 0)
        a.push_back(make.wild(-2, 2)), b.push_back(make.wild(-2, 2)), c.push_back(make.wild(-2, 2));
    const int count = static_cast<int>(a.size());
    const Elementary& scalar = elementary(Isa::scalar);
    for (const Isa isa : other_isas()) {
        const Elementary& set = elementary(isa);
        for (int f = 0; f < set.ternary_count; ++f) {
            std::vector<float> want(a.size()), got(a.size());
            scalar.ternary[f].run(a.data(), b.data(), c.data(), want.data(), count);
            set.ternary[f].run(a.data(), b.data(), c.data(), got.data(), count);
            int mismatches = 0;
            for (std::size_t i = 0; i < a.size(); ++i) {
                if (same_bits(want[i], got[i])) continue;
                if (mismatches++ == 0)
                    UNSCOPED_INFO("first: (" << a[i] << ", " << b[i] << ", " << c[i] << ") is " << got[i] << ", scalar says " << want[i]);
            }
            INFO(isa_name(isa) << " " << set.ternary[f].name);
            CHECK(mismatches == 0);
        }
    }
}

TEST_CASE("vocabulary: bit l of a mask is lane l", "[shading][simd]") {
    for (const Isa isa : built_isas()) {
        if (!isa_available(isa)) continue;
        const Elementary& set = elementary(isa);
        for (int lane = 0; lane < set.width; ++lane) {
            float a[16], b[16];
            std::fill_n(a, 16, 1.0f);
            std::fill_n(b, 16, 0.0f);
            b[lane] = 2.0f;
            INFO(isa_name(isa));
            CHECK(set.mask_of_less(a, b) == 1u << lane);
        }
    }
}

TEST_CASE("vocabulary: min and max return the second operand for NaN and for equal zeros", "[shading][simd]") {
    const Elementary& scalar = elementary(Isa::scalar);
    const float a[16] = {kNan, 1.0f, 0.0f, -0.0f}, b[16] = {1.0f, kNan, -0.0f, 0.0f}, c[16] = {};
    for (int f = 0; f < scalar.ternary_count; ++f) {
        const std::string name = scalar.ternary[f].name;
        if (name != "min" && name != "max") continue;
        float out[16];
        scalar.ternary[f].run(a, b, c, out, 16);
        for (int i = 0; i < 4; ++i) CHECK(same_bits(out[i], b[i]));
    }
}

TEST_CASE("power: within 2.4 ulp of t^n for the exponents of the wrap family", "[shading][pow]") {
    // 2.4 ulp is the bound of the wrap family. The samples are t from 2^-24 to 1 in even steps of the bit pattern.
    std::vector<float> t;
    for (std::uint32_t i = std::bit_cast<std::uint32_t>(0x1p-24f); i <= std::bit_cast<std::uint32_t>(1.0f); i += 1021)
        t.push_back(std::bit_cast<float>(i));
    while (t.size() % 16 != 0) t.push_back(1.0f);
    std::vector<float> out(t.size());
    for (const float n : {1.1f, 1.25f, 1.3f, 1.75f, 1.9f}) {
        elementary(Isa::scalar).power(t.data(), n, out.data(), static_cast<int>(t.size()));
        double worst = 0;
        float worst_at = 0;
        for (std::size_t i = 0; i < t.size(); ++i) {
            const double ulps = ulps_from(out[i], std::pow(static_cast<long double>(t[i]), static_cast<long double>(n)));
            if (ulps > worst) worst = ulps, worst_at = t[i];
        }
        INFO("n = " << n << ", worst at t = " << worst_at);
        CHECK(worst <= 2.4);
        CHECK(worst > 0.3);
    }
}

TEST_CASE("power: the relative error for any exponent stays below (3 + n) / 2^24", "[shading][pow]") {
    // An argument rounded to float32 alone can be wrong by n / 2^24; measured 2.9e-6 for n = 64 against the bound's 4.0e-6.
    std::vector<float> t(1 << 16), out(1 << 16);
    for (std::size_t i = 0; i < t.size(); ++i) t[i] = static_cast<float>(i + 1) / static_cast<float>(t.size());
    for (const float n : {0.25f, 0.5f, 7.0f, 16.5f, 64.0f, 1000.0f}) {
        elementary(Isa::scalar).power(t.data(), n, out.data(), static_cast<int>(t.size()));
        double worst = 0;
        for (std::size_t i = 0; i < t.size(); ++i) {
            const long double exact = std::pow(static_cast<long double>(t[i]), static_cast<long double>(n));
            if (exact < 0x1p-90L) continue;
            worst = std::max(worst, static_cast<double>(std::fabs(static_cast<long double>(out[i]) / exact - 1.0L)));
        }
        INFO("n = " << n << ", relative error " << worst);
        CHECK(worst <= 0x1p-24 * (3.0 + static_cast<double>(n)));
    }
}

TEST_CASE("power: 0 gives 0 and 1 gives exactly 1", "[shading][pow]") {
    const float t[16] = {0.0f, 1.0f};
    for (const float n : {0.01f, 0.5f, 1.1f, 3.7f, 1e5f}) {
        float out[16];
        elementary(Isa::scalar).power(t, n, out, 16);
        CHECK(out[0] == 0.0f);
        CHECK(out[1] == 1.0f);
    }
}

TEST_CASE("highlight power: cos^s is right to 4e-7 for exponents from 0.5 to 8e4 and all angles", "[shading][pow]") {
    FloatMaker make(3);
    std::vector<float> cosine(1 << 16), sine(1 << 16), half(1 << 16), out(1 << 16);
    std::vector<long double> exact(1 << 16);
    for (std::size_t i = 0; i < half.size(); ++i) {
        half[i] = std::exp2(make.ordinary(-2.0f, 15.5f));
        // Angles at which the result matters: for large exponents until it falls to about 2^-20, for small exponents up to 90 degrees.
        const double sine_squared = std::min(1.0, static_cast<double>(make.ordinary(0.0f, 1.0f)) * 14.0 / half[i]);
        sine[i] = static_cast<float>(sine_squared), cosine[i] = static_cast<float>(1.0 - sine_squared);
        exact[i] = std::exp(static_cast<long double>(half[i]) * std::log1p(-static_cast<long double>(sine_squared)));
    }
    elementary(Isa::scalar).power_of_cosine(cosine.data(), sine.data(), half.data(), out.data(), 1 << 16);
    double worst = 0;
    for (std::size_t i = 0; i < half.size(); ++i)
        worst = std::max(worst, static_cast<double>(std::fabs(static_cast<long double>(out[i]) - exact[i])));
    INFO("largest absolute error " << worst << " of a peak of 1");
    CHECK(worst <= 4e-7);
}

TEST_CASE("power tiers: errors of display and fast are within those that accuracy.hpp states for their polynomials", "[shading][pow]") {
    // t^n = t 2^((n-1) log2 t). The relative error is that of 2^r, plus that of log2 on a fraction of at most 1/2, times ln 2 (n - 1). The
    // exponent itself is a float32 of up to 24 here, rounded three times.
    struct Row {
        const char* name;
        double n;
        shading::PowTier tier;
    };
    const Row rows[] = {{"display power 1.3", static_cast<double>(1.3f), shading::PowTier::display},
                        {"display power 16.5", 16.5, shading::PowTier::display},
                        {"fast power 1.3", static_cast<double>(1.3f), shading::PowTier::fast},
                        {"fast power 16.5", 16.5, shading::PowTier::fast}};
    const Elementary& scalar = elementary(Isa::scalar);
    std::vector<float> t(1 << 18), out(t.size());
    FloatMaker make(21);
    for (std::size_t i = 0; i < t.size(); ++i) t[i] = i % 2 == 0 ? make.ordinary(0.0f, 1.0f) : std::exp2(make.ordinary(-24.0f, 0.0f));
    int found = 0;
    for (const Row& row : rows)
        for (int f = 0; f < scalar.unary_count; ++f) {
            if (std::string(scalar.unary[f].name) != row.name) continue;
            ++found;
            scalar.unary[f].run(t.data(), out.data(), static_cast<int>(t.size()));
            const shading::PowErrors errors = shading::pow_errors(row.tier);
            double worst = 0, worst_of_bound = 0;
            for (std::size_t i = 0; i < t.size(); ++i) {
                const double exact = std::pow(static_cast<double>(t[i]), row.n);
                if (exact < 0x1p-24) continue;
                const double error = std::fabs(static_cast<double>(out[i]) / exact - 1.0);
                const double bound = errors.exp2 + 0.35 * (row.n - 1.0) * errors.log2 + 0x1p-24 * (4.0 + 3.0 * 0.7 * -std::log2(exact));
                worst = std::max(worst, error);
                worst_of_bound = std::max(worst_of_bound, error / bound);
            }
            INFO(row.name << ": relative error " << worst << ", of its bound " << worst_of_bound);
            CHECK(worst_of_bound <= 1.0);
            CHECK(worst_of_bound > 0.4);  // close to the bound, so the tier did run
            CHECK(worst <=
                  (row.tier == shading::PowTier::display ? 2.6e-6 * row.n + 3e-6 : 1.3e-4 * row.n + 1e-4));  // as documented at Accuracy
        }
    CHECK(found == 4);
}

TEST_CASE("power tiers: errors of highlights are within those that accuracy.hpp states for their polynomials", "[shading][pow]") {
    // cos^s = e^-z, where z has the relative error of log2. Because e^-z z <= 1/e, that error adds at most 1/e of itself, relative to the
    // peak.
    struct Row {
        const char* name;
        double half_exponent;
        shading::PowTier tier;
    };
    const Row rows[] = {{"display cosine power 40", 20, shading::PowTier::display},
                        {"display cosine power 60000", 30000, shading::PowTier::display},
                        {"fast cosine power 40", 20, shading::PowTier::fast},
                        {"fast cosine power 60000", 30000, shading::PowTier::fast}};
    const Elementary& scalar = elementary(Isa::scalar);
    std::vector<float> sine(1 << 16), out(sine.size());
    FloatMaker make(22);
    int found = 0;
    for (const Row& row : rows)
        for (int f = 0; f < scalar.unary_count; ++f) {
            if (std::string(scalar.unary[f].name) != row.name) continue;
            ++found;
            for (float& s : sine) s = std::min(1.0f, make.ordinary(0.0f, 14.0f) / static_cast<float>(row.half_exponent));
            scalar.unary[f].run(sine.data(), out.data(), static_cast<int>(sine.size()));
            double worst = 0;
            for (std::size_t i = 0; i < sine.size(); ++i)
                worst = std::max(worst, std::fabs(static_cast<double>(out[i]) -
                                                  std::exp(row.half_exponent * std::log1p(-static_cast<double>(sine[i])))));
            const shading::PowErrors errors = shading::pow_errors(row.tier);
            const double bound = errors.exp2 + 0.3679 * errors.log2 + 4e-7;
            INFO(row.name << ": " << worst << " of the peak, bound " << bound);
            CHECK(worst <= bound);
            CHECK(worst > 0.2 * bound);
        }
    CHECK(found == 4);
}

TEST_CASE("power tiers: 0 gives 0 and 1 gives exactly 1", "[shading][pow]") {
    const Elementary& scalar = elementary(Isa::scalar);
    const float t[16] = {0.0f, 1.0f};
    int found = 0;
    for (int f = 0; f < scalar.unary_count; ++f) {
        const std::string name = scalar.unary[f].name;
        if (!name.starts_with("display power") && !name.starts_with("fast power")) continue;
        float out[16];
        scalar.unary[f].run(t, out, 16);
        INFO(name);
        CHECK(out[0] == 0.0f);
        CHECK(out[1] == 1.0f);
        ++found;
    }
    CHECK(found == 4);
}

TEST_CASE("log2 and exp2: a few units of float32 away from the true values", "[shading][pow]") {
    const Elementary& scalar = elementary(Isa::scalar);
    std::vector<float> x(1 << 16), log(1 << 16), exp(1 << 16);
    FloatMaker make(11);
    for (float& v : x) v = make.ordinary(0.01f, 20.0f);
    for (int f = 0; f < scalar.unary_count; ++f) {
        if (std::string(scalar.unary[f].name) == "log2") scalar.unary[f].run(x.data(), log.data(), 1 << 16);
        if (std::string(scalar.unary[f].name) == "exp2") scalar.unary[f].run(x.data(), exp.data(), 1 << 16);
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double v = static_cast<double>(x[i]), true_log = std::log2(v), true_exp = std::exp2(v);
        if (std::fabs(static_cast<double>(log[i]) - true_log) > 1.5e-7 * std::max(1.0, std::fabs(true_log)) ||
            std::fabs(static_cast<double>(exp[i]) / true_exp - 1.0) > 2e-7)
            FAIL("x = " << x[i] << ": log2 " << log[i] << ", exp2 " << exp[i]);
    }
    SUCCEED();
}

TEST_CASE("normalise: every finite length from 1e-44 to 1e38 gives a unit vector, zero stays zero", "[shading][vector]") {
    FloatMaker make(5);
    std::vector<float> x(4096), y(4096), z(4096), ox(4096), oy(4096), oz(4096);
    for (std::size_t i = 0; i < x.size(); ++i) {
        const float size = std::exp2(make.ordinary(-140.0f, 126.0f));
        x[i] = make.ordinary(-1, 1) * size, y[i] = make.ordinary(-1, 1) * size, z[i] = make.ordinary(-1, 1) * size;
    }
    x[0] = y[0] = z[0] = 0.0f;
    elementary(Isa::scalar).normalize(x.data(), y.data(), z.data(), ox.data(), oy.data(), oz.data(), 4096);
    CHECK((ox[0] == 0.0f && oy[0] == 0.0f && oz[0] == 0.0f));
    double worst = 0;
    for (std::size_t i = 1; i < x.size(); ++i) {
        const double dx = x[i], dy = y[i], dz = z[i], length = std::sqrt(dx * dx + dy * dy + dz * dz);
        worst = std::max({worst, std::fabs(ox[i] - dx / length), std::fabs(oy[i] - dy / length), std::fabs(oz[i] - dz / length)});
    }
    CHECK(worst <= 2.5e-7);
}
