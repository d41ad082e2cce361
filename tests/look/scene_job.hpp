// A render job of a scene that a test makes, as `halflit look` would make it of a file.
#pragma once

#include "apps/engine/look/view_shot.hpp"
#include "tests/support/catch.hpp"

#include <memory>
#include <utility>

namespace halflit::test {

/// Each instance is a part.
inline engine::RenderJob scene_job(Scene scene, int width, int height) {
    engine::RenderJob job;
    job.source.name = "model";
    job.source.scene = std::make_unique<Scene>(std::move(scene));
    job.source.parts = std::make_shared<engine::Parts>(job.scene());
    auto prepared = PreparedScene::make(job.scene(), job.execution);
    if (!prepared) FAIL(prepared.error().message);
    job.prepared = std::move(*prepared);
    job.film.bounds = job.prepared->bounds();
    job.width = width, job.height = height;
    job.settings = usual_settings();
    job.settings.edges = EdgeChoice::feature;
    job.settings.region = {0, 0, width, height};
    AutoOptions choice;
    choice.light = job.scene();
    job.film.choice = std::move(choice);
    job.light = auto_setup(job.scene(), job.film.bounds, width, height, {}).light;
    return job;
}

/// A view by parallel rays that shows the whole scene.
inline Camera parallel_view(const engine::RenderJob& job, float azimuth_deg, float elevation_deg, double margin = 0.13) {
    ViewSettings view{.azimuth_deg = azimuth_deg, .elevation_deg = elevation_deg, .orthographic = true};
    view.margin_x = view.margin_y = margin;
    return frame_scene(job.scene(), job.film.bounds, static_cast<float>(job.width) / static_cast<float>(job.height), view);
}

}  // namespace halflit::test
