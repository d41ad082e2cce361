// Budgets that are measured: the statistics, the pixels that are probed, and whether what is claimed holds.
#include "raster/quality.hpp"
#include "tests/raster/metamorphic_scene.hpp"
#include "tests/support/isas.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <cstring>
#include <set>

using namespace halflit;
using namespace halflit::raster;
using namespace halflit::raster::test;

namespace {

constexpr int kWidth = 320, kHeight = 240;

Shot random_shot(std::uint64_t seed) {
    Shot shot = separate_bodies(seed);
    shot.settings.samples = 4;
    shot.settings.shadow_size = 0;
    shot.settings.shading.rate = ShadingRate::pixel;
    shot.settings.shading.anisotropy = 4;
    shot.settings.tone_curve = ToneCurve::neutral;
    return shot;
}

std::vector<std::uint32_t> codes_of(const Shot& shot, const Settings& settings) {
    std::vector<std::uint32_t> codes(kWidth * kHeight);
    const Target target{.width = kWidth, .height = kHeight, .pixels = reinterpret_cast<std::uint8_t*>(codes.data())};
    const auto report = render(shot.scene, shot.camera, settings, target, {.threads = 1});
    REQUIRE(report);
    return codes;
}

struct Claims {
    int cheaper = 0, full = 0, wrong = 0;
    double worst = 0;  ///< claimed percent minus the true one
};

/// Measures random scenes, and compares what is claimed with whole pictures.
Claims check_claims(int scenes, const ShareBudget& budget) {
    Claims claims;
    for (int seed = 0; seed < scenes; ++seed) {
        const Shot shot = random_shot(7000 + static_cast<std::uint64_t>(seed));
        const auto prepared = PreparedScene::make(shot.scene);
        REQUIRE(prepared);
        const auto measured = Renderer::measure(*prepared, shot.scene, shot.camera, shot.settings, budget, kWidth, kHeight);
        INFO("seed " << seed << (measured ? std::string() : measured.error().message));
        REQUIRE(measured);
        const Settings cheaper = with_share(shot.settings, *measured);
        if (cheaper == shot.settings) {
            CHECK(measured->percent == 100.0);
            ++claims.full;
            continue;
        }
        ++claims.cheaper;
        CHECK(measured->percent >= budget.percent);
        CHECK(measured->percent < 100.0);
        const auto want = codes_of(shot, shot.settings), got = codes_of(shot, cheaper);
        int outside = 0, probed = 0;
        for (std::size_t i = 0; i < want.size(); ++i) outside += differs(want[i], got[i], budget.codes) ? 1 : 0;
        const auto probes = choose_probes(kWidth, kHeight, shot.camera);
        for (const std::uint32_t at : probes) probed += differs(want[at], got[at], budget.codes) ? 1 : 0;
        CHECK(static_cast<int>(probes.size()) == measured->probes);
        CHECK(probed == measured->outside);  // so the pixels that are probed have the bits of the whole picture
        const double share = 100.0 * (1.0 - static_cast<double>(outside) / static_cast<double>(want.size()));
        claims.wrong += share < measured->percent ? 1 : 0;
        claims.worst = std::max(claims.worst, measured->percent - share);
    }
    return claims;
}

}  // namespace

TEST_CASE("quality: the share that probes show is Clopper and Pearson's lower bound", "[raster][quality]") {
    // None outside: the n-th root of the doubt.
    for (const int n : {1, 10, 300, 4096}) CHECK(share_shown(n, 0, 0.05) == Approx(100 * std::pow(0.05, 1.0 / n)).epsilon(1e-12));
    // All of n but one inside: by hand, (1-p)^2 + 2 p (1-p) = 1 - p^2.
    CHECK(share_shown(2, 1, 0.05) == Approx(100 * (1 - std::sqrt(0.95))).epsilon(1e-12));
    CHECK(share_shown(20, 20, 0.05) == 0.0);
    CHECK(share_shown(0, 0, 0.05) == 100.0);
    // Tables: 5 of 100, two-sided 90 %: at most .1023 outside.
    CHECK(share_shown(100, 5, 0.05) == Approx(89.77).margin(0.01));
    double before = 100;
    for (int off = 0; off <= 512; ++off) {
        const double share = share_shown(512, off, 0.0125);
        CHECK(share <= before);
        CHECK(share <= 100.0 * (512 - off) / 512 + 1e-9);
        before = share;
    }
}

TEST_CASE("quality: a mask holds the pixels that were added", "[raster][quality]") {
    PixelMask mask(130, 3);
    const std::set<std::pair<int, int>> pixels{{0, 0}, {63, 0}, {64, 1}, {127, 1}, {128, 2}, {129, 2}};
    for (const auto& [x, y] : pixels) mask.add(x, y);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 130; ++x) {
            CHECK(mask.has(x, y) == pixels.contains({x, y}));
            for (const int count : {1, 16, 64, 130 - x}) {
                if (x + count > 130) continue;
                bool any = false;
                for (int i = 0; i < count; ++i) any |= pixels.contains({x + i, y});
                CHECK(mask.has_any(x, y, count) == any);
            }
        }
}

TEST_CASE("quality: probes are different pixels all over the picture", "[raster][quality]") {
    for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {64, 64}, {1280, 720}}) {
        const auto probes = choose_probes(width, height, {});
        const std::set<std::uint32_t> set(probes.begin(), probes.end());
        const auto pixels = static_cast<std::size_t>(width * height);
        CHECK(set.size() == probes.size());
        CHECK(*set.rbegin() < pixels);
        CHECK(probes.size() == std::min(pixels, std::clamp(pixels / 100, std::size_t{512}, std::size_t{4096})));
        int upper = 0;
        for (const std::uint32_t at : probes) upper += at < pixels / 2 ? 1 : 0;
        CHECK(std::abs(2 * upper - static_cast<int>(probes.size())) <= 4 + static_cast<int>(probes.size()) / 20);
    }
    Camera other;
    other.world_from_camera.c[3].x = 1;
    CHECK(choose_probes(640, 480, {}) != choose_probes(640, 480, other));
}

TEST_CASE("quality: what is claimed of random scenes holds", "[raster][quality]") {
    const Claims fast = check_claims(24, kFastQuality), draft = check_claims(24, kDraftQuality);
    INFO("fast: " << fast.cheaper << " cheaper, " << fast.full << " in full, worst " << fast.worst << "; draft: " << draft.cheaper << ", "
                  << draft.full << ", " << draft.worst);
    CHECK(fast.wrong + draft.wrong <= 3);  // 5 % of 48 are 2.4
    CHECK(fast.worst < 0.3);
    CHECK(draft.worst < 0.5);
    CHECK(draft.cheaper >= 20);
}

TEST_CASE("quality: at most one claim of twenty about 500 scenes is wrong", "[raster][quality][deep]") {
    for (const ShareBudget& budget : {kFastQuality, kDraftQuality}) {
        const Claims claims = check_claims(250, budget);
        WARN(budget.percent << " % within " << budget.codes << ": " << claims.cheaper << " cheaper, " << claims.full << " in full, "
                            << claims.wrong << " claims wrong, by at most " << claims.worst << " %");
        CHECK(claims.wrong <= 12);
    }
}

TEST_CASE("quality: every set, thread count and tile size makes the same choice", "[raster][quality]") {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        const Shot shot = random_shot(9000 + seed);
        const auto prepared = PreparedScene::make(shot.scene);
        REQUIRE(prepared);
        const auto measure = [&](const Execution& execution) {
            auto out = Renderer::measure(*prepared, shot.scene, shot.camera, shot.settings, kDraftQuality, 200, 150, nullptr, execution);
            REQUIRE(out);
            return *out;
        };
        const MeasuredShare want = measure({.threads = 1, .isa = Isa::scalar});
        const auto same = [&](const MeasuredShare& got) {
            CHECK(got.percent == want.percent);
            CHECK(got.outside == want.outside);
            CHECK(got.samples == want.samples);
            CHECK(got.anisotropy == want.anisotropy);
            CHECK(got.shadow_size == want.shadow_size);
        };
        for (const Isa isa : halflit::test::available_isas()) same(measure({.isa = isa}));
        for (const int tile : {16, 32}) same(measure({.threads = 3, .tile_size = tile}));
    }
}

TEST_CASE("quality: what is known of other views is tried first, and both keep the budget", "[raster][quality]") {
    const Shot shot = random_shot(9100);
    const auto prepared = PreparedScene::make(shot.scene);
    REQUIRE(prepared);
    const auto measure = [&](const MeasuredShare* known) {
        auto out = Renderer::measure(*prepared, shot.scene, shot.camera, shot.settings, kDraftQuality, 200, 150, known);
        REQUIRE(out);
        return *out;
    };
    const MeasuredShare fresh = measure(nullptr);
    REQUIRE(fresh.percent < 100.0);
    const MeasuredShare again = measure(&fresh);
    CHECK(again.outside == 2 * fresh.outside);
    CHECK(again.probes == 2 * fresh.probes);
    CHECK(with_share(shot.settings, again) == with_share(shot.settings, fresh));
    MeasuredShare full = fresh;
    full.samples = shot.settings.samples, full.anisotropy = shot.settings.shading.anisotropy, full.shadow_size = 0;
    CHECK(with_share(shot.settings, measure(&full)) == shot.settings);
    CHECK(measure(&full).percent == 100.0);
    // A picture after that is one of the settings.
    CHECK(codes_of(shot, with_share(shot.settings, fresh)) != codes_of(shot, shot.settings));
}

TEST_CASE("quality: wrong budgets and settings are refused", "[raster][quality]") {
    const Shot shot = random_shot(9200);
    const auto prepared = PreparedScene::make(shot.scene);
    REQUIRE(prepared);
    const auto fails = [&](const ShareBudget& budget, const Settings& settings) {
        const auto out = Renderer::measure(*prepared, shot.scene, shot.camera, settings, budget, 64, 64);
        return !out && out.error().code == ErrorCode::usage;
    };
    for (const ShareBudget& budget : {ShareBudget{-1, 99}, {256, 99}, {NAN, 99}, {2, 0}, {2, 100}, {2, NAN}})
        CHECK(fails(budget, shot.settings));
    Settings settings = shot.settings;
    settings.shading.max_error_codes = 1;
    CHECK(fails(kFastQuality, settings));
    settings = shot.settings;
    settings.shading.accuracy = Accuracy::reference;
    CHECK(fails(kFastQuality, settings));
    // A known share must be possible, and of the same budget.
    for (const MeasuredShare& known : {MeasuredShare{},
                                       MeasuredShare{kFastQuality, 99.5, 512, 1, 1000, 1, 0},
                                       MeasuredShare{kDraftQuality, 99.5, 512, 1, 1, 1, 0},
                                       {kFastQuality, NAN, 512, 1, 1, 1, 0},
                                       {kFastQuality, 99.5, 512, 513, 1, 1, 0},
                                       {kFastQuality, 99.5, 2147483647, 1, 1, 1, 0}}) {
        const auto out = Renderer::measure(*prepared, shot.scene, shot.camera, shot.settings, kFastQuality, 64, 64, &known);
        REQUIRE_FALSE(out);
        CHECK(out.error().code == ErrorCode::usage);
    }
    // Limits hold, and all drawings count.
    const auto slow = Renderer::measure(*prepared, shot.scene, shot.camera, shot.settings, kFastQuality, 256, 256, nullptr,
                                        {.threads = 1, .time_limit_s = 1e-7});
    REQUIRE_FALSE(slow);
    CHECK(slow.error().code == ErrorCode::limit);
    const auto small = Renderer::measure(*prepared, shot.scene, shot.camera, shot.settings, kFastQuality, 256, 256, nullptr,
                                         {.threads = 1, .memory_limit = 1000});
    REQUIRE_FALSE(small);
    CHECK(small.error().code == ErrorCode::limit);
}
