// A scene with its certificate, for tests.
#pragma once

#include "apps/engine/look/certificate.hpp"
#include "tests/look/ray_view.hpp"
#include "tests/look/scene_job.hpp"

#include <utility>
#include <vector>

namespace halflit::test {

struct Certified {
    engine::RenderJob job;
    engine::Certificate certificate;
    std::vector<RayTriangle> triangles;
};

/// Certified with the views front, right, top and iso.
inline Certified certified(Scene scene, int width, int height, int least, std::size_t most_views = 24, int threads = 0) {
    Certified out{scene_job(std::move(scene), width, height), {}, {}};
    out.job.execution.threads = threads;
    Renderer renderer;
    std::vector<engine::ViewShot> given;
    for (const NamedView& view : kNamedViews) {
        if (view.name != "front" && view.name != "right" && view.name != "top" && view.name != "iso") continue;
        const Camera camera = parallel_view(out.job, view.azimuth_deg, view.elevation_deg, 0.2);
        auto shot = draw_shot(out.job, renderer, std::string(view.name), camera, {.picture = false});
        REQUIRE(shot);
        given.push_back(std::move(*shot));
    }
    auto certificate = certify(out.job, renderer, std::move(given), {least, most_views, {.picture = false}});
    if (!certificate) FAIL(certificate.error().message);
    out.certificate = std::move(*certificate);
    out.triangles = ray_triangles(out.job.scene());
    REQUIRE(out.certificate.triangles.size() == out.triangles.size());
    return out;
}

}  // namespace halflit::test
