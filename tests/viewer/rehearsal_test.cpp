#include "apps/viewer/rehearsal.hpp"

#include "tests/support/catch.hpp"

#include <numeric>

using namespace halflit::viewer;

namespace {

RehearsalPlan turn(int frames) {
    RehearsalPlan plan;
    plan.orbit_frames = frames;
    plan.wanted = true;
    return plan;
}

Situation finished(double now_ms) { return {now_ms, false, true, false}; }

}  // namespace

TEST_CASE("rehearsal: a turn is as many motions as pictures, and all its pixels", "[viewer]") {
    for (const int frames : {1, 7, 900, 2000}) {
        Rehearsal rehearsal(turn(frames), 900);
        double now = 100;
        CHECK(rehearsal.next({now, false, false, false}).gesture == Gesture::none);  // the first view is not drawn yet
        CHECK(rehearsal.next(finished(now)).gesture == Gesture::press);
        int pixels = 0;
        for (int i = 0; i < frames; ++i) {
            const RehearsalStep step = rehearsal.next({now, i > 0, i == 0, false});
            REQUIRE(step.gesture == Gesture::drag);
            CHECK(rehearsal.next({now, false, false, false}).gesture == Gesture::none);  // waits for its picture
            pixels += step.dx;
            now += 10;
            rehearsal.shown(now);
        }
        CHECK(rehearsal.next({now, true, false, false}).gesture == Gesture::release);
        rehearsal.shown(now + 500);  // with all samples: not of the turn
        CHECK(pixels == 900);
        const auto& ms = rehearsal.intervals();
        REQUIRE(ms.size() == static_cast<std::size_t>(frames));
        CHECK(std::accumulate(ms.begin(), ms.end(), 0.0) == Approx(10.0 * frames));
        CHECK(rehearsal.next(finished(now)).gesture == Gesture::none);
        CHECK(rehearsal.next(finished(now)).gesture == Gesture::end);
    }
}

TEST_CASE("rehearsal: a first motion that counts as a click's has no picture and no time", "[viewer]") {
    Rehearsal rehearsal(turn(3), 900);
    CHECK(rehearsal.next(finished(0)).gesture == Gesture::press);
    CHECK(rehearsal.next(finished(1)).gesture == Gesture::drag);
    for (const double now : {50.0, 60.0}) {
        CHECK(rehearsal.next({now, now > 50, now == 50, false}).gesture == Gesture::drag);
        rehearsal.shown(now + 10);
    }
    CHECK(rehearsal.next({70, true, false, false}).gesture == Gesture::release);
    rehearsal.shown(500);
    CHECK(rehearsal.intervals().size() == 2);
}

TEST_CASE("rehearsal: it ends after the click's story, and never without a wish", "[viewer]") {
    RehearsalPlan plan = turn(0);
    plan.click = {3, 4};
    Rehearsal rehearsal(plan, 900);
    CHECK(rehearsal.next(finished(0)).gesture == Gesture::none);
    CHECK(rehearsal.next(finished(1)).gesture == Gesture::click);
    CHECK(rehearsal.next(finished(2)).gesture == Gesture::none);
    CHECK(rehearsal.next({3, false, true, true}).gesture == Gesture::none);
    CHECK(rehearsal.next({4, false, true, true}).gesture == Gesture::end);
    Rehearsal person({}, 900);
    for (int i = 0; i < 10; ++i) CHECK(person.next({double(i), true, true, true}).gesture == Gesture::none);
}
