#include "apps/viewer/refinement.hpp"

#include "tests/support/catch.hpp"

#include <vector>

using namespace halflit::viewer;

namespace {

/// A machine that takes `geometry` ms a picture and `pixels` ms a sample of the full size.
struct Machine {
    double geometry = 1, pixels = 5;
    [[nodiscard]] double ms(const DrawStep& step) const { return geometry + pixels * step.samples / (step.divisor * step.divisor); }
};

/// Draws what is asked for without motion; the steps until the view is finished.
std::vector<DrawStep> at_rest(Refinement& refinement, const Machine& machine, double& now) {
    std::vector<DrawStep> steps;
    for (int i = 0; i < 100 && !refinement.finished(); ++i) {
        if (const auto step = refinement.next(now)) {
            refinement.began(*step);
            now += machine.ms(*step);
            refinement.drawn(*step, machine.ms(*step), false);
            steps.push_back(*step);
        } else {
            now += refinement.wait_ms(now).value() + 0.01;
        }
    }
    return steps;
}

/// Draws while every picture comes with a motion.
std::vector<DrawStep> moving(Refinement& refinement, const Machine& machine, double& now, int pictures) {
    std::vector<DrawStep> steps;
    for (int i = 0; i < pictures; ++i) {
        refinement.moved(now);
        const auto step = refinement.next(now);
        REQUIRE(step);
        refinement.began(*step);
        refinement.moved(now + 1);
        now += machine.ms(*step);
        refinement.drawn(*step, machine.ms(*step), false);
        steps.push_back(*step);
    }
    return steps;
}

}  // namespace

TEST_CASE("refinement: one sample first, then all of them", "[viewer]") {
    Refinement refinement(8);
    double now = 0;
    CHECK(at_rest(refinement, {}, now) == std::vector<DrawStep>{{1, 1, false}, {1, 8, true}});
    CHECK_FALSE(refinement.wait_ms(now));
    Refinement single(1);
    CHECK(at_rest(single, {}, now) == std::vector<DrawStep>{{1, 1, true}});
}

TEST_CASE("refinement: a moving view has one sample, and all only when it rests", "[viewer]") {
    Refinement refinement(4);
    double now = 0;
    for (const DrawStep& step : moving(refinement, {}, now, 20)) CHECK(step == DrawStep{1, 1, false});
    CHECK(at_rest(refinement, {}, now) == std::vector<DrawStep>{{1, 1, false}, {1, 4, true}});
    const double end = now;
    refinement.moved(now);
    refinement.began(*refinement.next(now));
    refinement.drawn({1, 1, false}, 5, false);
    CHECK_FALSE(refinement.next(end + Refinement::kRestMs - 1));
    CHECK(refinement.next(end + Refinement::kRestMs + 1) == DrawStep{1, 4, true});
}

TEST_CASE("refinement: slow pictures are drawn smaller until they are quick, and at full size at rest", "[viewer]") {
    const Machine slow{5, 150};
    Refinement refinement(4);
    double now = 0;
    (void)at_rest(refinement, slow, now);
    const auto steps = moving(refinement, slow, now, 10);
    CHECK(steps[1].divisor == 2);
    CHECK(steps.back().divisor == 2);  // 43 ms
    CHECK(slow.ms(steps.back()) < Refinement::kTargetMs);
    CHECK(at_rest(refinement, slow, now) == std::vector<DrawStep>{{2, 1, false}, {1, 1, false}, {1, 4, true}});
    const Machine slower{5, 600};
    CHECK(moving(refinement, slower, now, 10).back().divisor == Refinement::kMostDivisor);
}

TEST_CASE("refinement: what became quick is drawn at full size again", "[viewer]") {
    Refinement refinement(4);
    double now = 0;
    (void)at_rest(refinement, {5, 900}, now);
    CHECK(moving(refinement, {5, 900}, now, 10).back().divisor == 4);
    CHECK(moving(refinement, {1, 8}, now, 10).back().divisor == 1);
}

TEST_CASE("refinement: a time of the geometry alone is not bought with pixels", "[viewer]") {
    Refinement refinement(4);
    double now = 0;
    const Machine heavy{100, 4};
    (void)at_rest(refinement, heavy, now);
    int small = 0;
    for (const DrawStep& step : moving(refinement, heavy, now, 50)) small += step.divisor > 1;
    CHECK(small <= 1);  // the picture by which it was found
}

TEST_CASE("refinement: the sides do not swing between two sizes", "[viewer]") {
    for (int pixels = 1; pixels < 1000; pixels += 7) {
        Refinement refinement(4);
        double now = 0;
        const Machine machine{3, static_cast<double>(pixels)};
        (void)at_rest(refinement, machine, now);
        (void)moving(refinement, machine, now, 10);
        const auto steps = moving(refinement, machine, now, 10);
        INFO(pixels);
        for (const DrawStep& step : steps) CHECK(step.divisor == steps[0].divisor);
    }
}

TEST_CASE("refinement: a picture that was given up is drawn again", "[viewer]") {
    Refinement refinement(4);
    refinement.began({1, 1, false});
    refinement.drawn({1, 1, false}, 5, false);
    refinement.began({1, 4, true});
    refinement.drawn({1, 4, true}, 3, true);
    CHECK(refinement.next(1e6) == DrawStep{1, 4, true});
    refinement.set_samples(16, 1e6);
    CHECK(refinement.next(1e6) == DrawStep{1, 1, false});
}
