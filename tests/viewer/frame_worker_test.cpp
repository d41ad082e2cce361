#include "apps/viewer/frame_worker.hpp"

#include "tests/viewer/jobs.hpp"

#include <chrono>
#include <thread>

using namespace halflit;
using namespace halflit::test;
using namespace halflit::viewer;

namespace {

/// Waits for the result that was asked for.
DrawnFrame result_of(FrameWorker& worker) {
    for (int i = 0; i < 60000; ++i) {
        if (auto frame = worker.take()) return std::move(*frame);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    FAIL("no result within a minute");
    return {};
}

struct Started {
    OpenedJob opened;
    FrameRequest request;
};

Started start(const std::string& scene, const std::vector<std::string>& flags) {
    Started started{open_job(scene, flags), {}};
    const engine::RenderJob& job = started.opened.job;
    started.request = {job.camera, controls_of(job, started.opened.options), job.width, job.height, {1, job.settings.samples, true}};
    return started;
}

void ignore() {}

}  // namespace

TEST_CASE("frame worker: a finished view has the pixels of render", "[viewer]") {
    for (const std::vector<std::string>& flags : {std::vector<std::string>{}, {"--env", "studio", "--lobe", "valve"}}) {
        Started started = start("demo", flags);
        const Image expected = drawn(started.opened.job);
        FrameWorker worker(std::move(started.opened.job), started.opened.options, ignore);
        FrameRequest quick = started.request;
        quick.step = {2, 1, false};
        worker.begin(quick);
        const DrawnFrame small = result_of(worker);
        CHECK(small.picture.width == 32);
        CHECK(small.plan.empty());
        worker.begin(started.request);
        const DrawnFrame frame = result_of(worker);
        CHECK(frame.picture.rgba8 == expected.rgba8);
        CHECK(frame.report.find("pixel_hash") != std::string::npos);
        CHECK(frame.plan.find("materials") != std::string::npos);
        CHECK_FALSE(frame.lights);
    }
}

TEST_CASE("frame worker: another sky is that of its flag, and the first one comes back", "[viewer]") {
    Started started = start("demo", {});
    const Image first = drawn(started.opened.job);
    FrameWorker worker(std::move(started.opened.job), started.opened.options, ignore);
    for (const Sky sky : {Sky::studio, Sky::sky, Sky::none, Sky::as_started}) {
        FrameRequest request = started.request;
        request.controls.sky.sky = sky;
        request.controls.lights.clear();
        worker.begin(request);
        const DrawnFrame frame = result_of(worker);
        INFO(kSkyNames[static_cast<std::size_t>(sky)]);
        REQUIRE_FALSE(frame.error);
        REQUIRE(frame.lights);
        const OpenedJob flagged =
            open_job("demo", sky == Sky::as_started ? std::vector<std::string>{}
                                                    : std::vector<std::string>{"--env", kSkyNames[static_cast<std::size_t>(sky)]});
        CHECK(frame.picture.rgba8 == drawn(flagged.job).rgba8);
        CHECK(*frame.lights == light_controls(flagged.job.light.all_lights()));
        if (sky == Sky::as_started) CHECK(frame.picture.rgba8 == first.rgba8);
    }
}

TEST_CASE("frame worker: controls change the light and settings of the picture", "[viewer]") {
    Started started = start("sphere:2000", {});
    OpenedJob expected = open_job("sphere:2000", {"--lobe", "half-lambert", "--specular", "none", "--samples", "8"});
    for (Light& light : expected.job.light.lights) light.color_linear = light.color_linear * 0.5f;
    FrameWorker worker(std::move(started.opened.job), started.opened.options, ignore);
    Controls& controls = started.request.controls;
    choose_model(controls, 2);
    controls.specular = SpecularModel::none;
    controls.samples = 8;
    for (LightControl& light : controls.lights) light.intensity = 0.5f;
    started.request.step.samples = 8;
    worker.begin(started.request);
    CHECK(result_of(worker).picture.rgba8 == drawn(expected.job).rgba8);
}

TEST_CASE("frame worker: a lobe may replace those that materials chose", "[viewer]") {
    Started started = start("demo", {});
    const Image own = drawn(started.opened.job);
    OpenedJob expected = open_job("demo", {"--lobe", "valve"});
    for (Material& material : expected.job.scene().materials) material.has_own_lobe = false;
    REQUIRE(expected.job.prepared->update({.materials = true}));
    FrameWorker worker(std::move(started.opened.job), started.opened.options, ignore);
    FrameRequest request = started.request;
    choose_model(request.controls, 3);
    request.controls.over_own_lobes = true;
    worker.begin(request);
    const Image all = result_of(worker).picture;
    CHECK(all.rgba8 == drawn(expected.job).rgba8);
    request.controls.over_own_lobes = false;
    worker.begin(request);
    CHECK(result_of(worker).picture.rgba8 != all.rgba8);
    worker.begin(started.request);
    CHECK(result_of(worker).picture.rgba8 == own.rgba8);
}

TEST_CASE("frame worker: settings that exclude each other are an error, and the next picture is drawn", "[viewer]") {
    Started started = start("sphere:2000", {"--shading", "flat"});
    FrameWorker worker(std::move(started.opened.job), started.opened.options, ignore);
    FrameRequest wrong = started.request;
    wrong.controls.max_error_codes = 1.0f;
    worker.begin(wrong);
    const DrawnFrame frame = result_of(worker);
    REQUIRE(frame.error);
    CHECK(frame.error->code == ErrorCode::usage);
    worker.begin(started.request);
    CHECK_FALSE(result_of(worker).error);
}

TEST_CASE("frame worker: pictures with many samples are given up, quick ones are not", "[viewer]") {
    Started started = start("demo", {"--samples", "16", "--accuracy", "reference"});
    FrameWorker worker(std::move(started.opened.job), started.opened.options, ignore);
    worker.begin(started.request);
    CHECK_FALSE(worker.idle());
    worker.give_up();
    CHECK(result_of(worker).dropped);
    started.request.step = {4, 1, false};
    worker.begin(started.request);
    worker.give_up();
    CHECK_FALSE(result_of(worker).dropped);
    worker.begin(started.request);  // ends at once though a picture is in the making
}

TEST_CASE("frame worker: a pixel's story comes by the same way", "[viewer]") {
    Started started = start("sphere:2000", {});
    FrameWorker worker(std::move(started.opened.job), started.opened.options, ignore);
    started.request.pixel = FrameRequest::Pixel{32, 24};
    worker.begin(started.request);
    const DrawnFrame frame = result_of(worker);
    REQUIRE(frame.story);
    CHECK(frame.story->shows == PixelShows::surface);
}
