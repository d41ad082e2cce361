#include "apps/engine/answers/pixel_story_text.hpp"
#include "halflit/explain.hpp"

#include "tests/viewer/jobs.hpp"

#include <algorithm>
#include <cmath>

using namespace halflit;
using namespace halflit::test;
using halflit::engine::story_text;

namespace {

PixelStory story_of(OpenedJob& opened, int x, int y) {
    Renderer renderer;
    const engine::RenderJob& job = opened.job;
    auto story = explain_pixel(renderer, *job.prepared, job.light, job.camera, job.settings, {job.width, job.height}, x, y, job.execution);
    if (!story) FAIL(story.error().message);
    return std::move(*story);
}

double area(Vec3d a, Vec3d b, Vec3d c) { return length(cross(b - a, c - a)) / 2; }

}  // namespace

TEST_CASE("pixel story: the light of all sources adds up to the pixel", "[viewer]") {
    for (const char* sky : {"none", "sky", "studio"}) {
        OpenedJob opened = open_job("demo", {"--env", sky, "--samples", "1"});
        for (const auto& [x, y] : {std::pair{30, 32}, {32, 10}, {10, 40}}) {
            const PixelStory story = story_of(opened, x, y);
            INFO(sky << " " << x << " " << y << "\n" << story_text(story));
            REQUIRE(story.shows == PixelShows::surface);
            CHECK(story.no_reference.empty());
            for (std::size_t c = 0; c < 3; ++c) {
                double sum = story.around[c] + story.emitted[c] + story.background[c];
                for (const LightShare& share : story.shares) sum += share.linear[c];
                CHECK(sum == Approx(story.linear[c] * story.alpha).epsilon(1e-4).margin(1e-6));  // float32 sums in another order
            }
        }
    }
}

TEST_CASE("pixel story: the point lies in the triangle that is named", "[viewer]") {
    OpenedJob opened = open_job("sphere:2000", {});
    for (int x = 16; x < 48; x += 5) {
        const PixelStory story = story_of(opened, x, 24);
        REQUIRE(story.shows == PixelShows::surface);
        REQUIRE(story.corners.size() == 3);
        const Vec3d a = story.corners[0], b = story.corners[1], c = story.corners[2], p = story.position;
        // The three parts fill the whole triangle, and no more.
        CHECK(area(a, b, p) + area(b, c, p) + area(c, a, p) == Approx(area(a, b, c)).epsilon(1e-3));
        CHECK(length(p) == Approx(1.0).epsilon(1e-2));  // on the unit sphere
        CHECK(length(story.normal - p * (1.0 / length(p))) < 1e-2);
        CHECK(story.material.name == "clay");
    }
}

TEST_CASE("pixel story: codes are the picture's, and the error is the distance to the reference", "[viewer]") {
    OpenedJob opened = open_job("sphere:2000", {"--max-error", "2", "--lobe", "mcauley", "--wrap", "0.4", "--power", "3.3"});
    const Image before = drawn(opened.job);
    const PixelStory story = story_of(opened, 30, 20);
    const std::size_t at = (20 * 64 + 30) * 4;
    for (std::size_t c = 0; c < 4; ++c) CHECK(story.codes[c] == before.rgba8[at + c]);
    CHECK(story.bound_codes > 0.0);
    CHECK(story.bound_codes <= 2.0);
    double worst = 0;
    for (const double error : story.error_codes) worst = std::max(worst, error);
    CHECK(worst > 0.0);
    CHECK(worst <= story.bound_codes);
    const OpenedJob truth = open_job("sphere:2000", {"--accuracy", "reference", "--lobe", "mcauley", "--wrap", "0.4", "--power", "3.3"});
    const Image reference = drawn(truth.job);
    for (std::size_t c = 0; c < 3; ++c) CHECK(std::abs(story.reference_codes[c] - reference.rgba8[at + c]) <= 0.51);
    // The job draws as before: its lights are back.
    CHECK(drawn(opened.job).rgba8 == before.rgba8);
}

TEST_CASE("pixel story: a wrapped lobe has light beyond the terminator, where Lambert has none", "[viewer]") {
    OpenedJob opened = open_job("sphere:20000", {"--lobe", "green", "--wrap", "1", "--shadows", "off"});
    bool found = false;
    for (int x = 16; x < 48; ++x) {
        const PixelStory story = story_of(opened, x, 34);
        for (const LightShare& share : story.shares) {
            if (story.shows != PixelShows::surface || share.cosine > -0.1 || share.cosine < -0.8) continue;
            found = true;
            CHECK(share.lambert == 0.0);
            CHECK(share.lobe == Approx((share.cosine + 1) / 2));
            CHECK(share.linear[1] > 0.0);
        }
    }
    CHECK(found);
}

TEST_CASE("pixel story: a light that a body hides gives nothing", "[viewer]") {
    OpenedJob opened = open_job("demo", {});
    int hidden = 0, seen = 0;
    for (int x = 2; x < 64; x += 6)
        for (int y = 26; y < 48; y += 6)
            for (const LightShare& share : story_of(opened, x, y).shares) {
                if (share.cosine < 0.3 || !share.unhidden) continue;
                seen += *share.unhidden == 1.0;
                if (*share.unhidden > 0.0) continue;
                ++hidden;
                CHECK(share.linear == Rgb3{0, 0, 0});
            }
    CHECK(hidden > 0);
    CHECK(seen > hidden);
}

TEST_CASE("pixel story: of many lights the nearest are told, and a background has no triangle", "[viewer]") {
    OpenedJob opened = open_job("lights:200:endless", {});
    const PixelStory story = story_of(opened, 32, 40);
    CHECK(story.shares.size() == kMostShares);
    CHECK(story.lights_left_out == 200 - kMostShares);
    OpenedJob sphere = open_job("sphere:2000", {});
    const PixelStory nothing = story_of(sphere, 0, 0);
    CHECK(nothing.shows == PixelShows::background);
    CHECK(story_text(nothing).find("no surface") != std::string::npos);
}
