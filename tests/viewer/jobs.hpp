// Render jobs as the command line makes them.
#pragma once

#include "apps/engine/job/render_job.hpp"
#include "tests/support/catch.hpp"

#include <string>
#include <vector>

namespace halflit::test {

struct OpenedJob {
    engine::RenderOptions options;
    engine::RenderJob job;
};

/// Fails the test for a faulty line.
inline OpenedJob open_job(const std::string& scene, std::vector<std::string> flags, const std::string& size = "64x48") {
    flags.insert(flags.end(), {"--size", size});
    auto options = engine::parse_render_flags(flags);
    REQUIRE(options);
    options->scene = scene;
    options->may_want_reference = true;
    auto job = engine::make_render_job(*options);
    if (!job) FAIL(job.error().message);
    return {std::move(*options), std::move(*job)};
}

/// The picture of a job.
inline Image drawn(const engine::RenderJob& job, bool linear = false) {
    Image image = engine::make_image(job, linear);
    Renderer renderer;
    REQUIRE(renderer.render(*job.prepared, job.light, job.camera, job.settings, engine::target_of(job, image), job.execution));
    return image;
}

}  // namespace halflit::test
