#include "apps/engine/look/view_shot.hpp"

#include "raster/view/projection.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"

#include <utility>

namespace halflit::engine {

Result<ViewShot> draw_shot(RenderJob& job, Renderer& renderer, std::string name, const Camera& camera, const ShotPlanes& wanted) {
    ViewShot shot;
    shot.name = std::move(name);
    shot.camera = camera;
    const std::size_t pixels = static_cast<std::size_t>(job.width) * static_cast<std::size_t>(job.height);
    Target target{job.width, job.height};
    shot.picture.width = job.width, shot.picture.height = job.height;
    if (wanted.picture) {
        shot.picture.rgba8.resize(4 * pixels);
        target.pixels = shot.picture.rgba8.data();
        target.edges = &shot.edges;
        (void)relight(job, camera);
    }
    shot.instance.resize(pixels), target.instance = shot.instance.data();
    shot.triangle.resize(pixels), target.triangle = shot.triangle.data();
    if (wanted.depth) shot.depth.resize(pixels), target.depth = shot.depth.data();
    if (wanted.normal) shot.normal.resize(3 * pixels), target.normal = shot.normal.data();
    const auto drawn = renderer.render(*job.prepared, job.light, camera, job.settings, target, job.timed_execution());
    if (!drawn) return fail(drawn.error().code, job.source.name + ": " + drawn.error().message);
    return shot;
}

Result<void> draw_numbers(const RenderJob& job, Renderer& renderer, const Camera& camera, int threads, ViewShot& shot) {
    const std::size_t pixels = static_cast<std::size_t>(job.width) * static_cast<std::size_t>(job.height);
    shot.camera = camera;
    shot.picture.width = job.width, shot.picture.height = job.height;
    shot.instance.resize(pixels), shot.triangle.resize(pixels);
    Target target{job.width, job.height};
    target.instance = shot.instance.data(), target.triangle = shot.triangle.data();
    Settings settings = job.settings;
    settings.samples = 1;  // in the pixel's middle
    settings.background_environment = false;
    Execution execution = job.timed_execution();
    execution.threads = threads;
    const auto drawn = renderer.render(*job.prepared, Lighting{}, camera, settings, target, execution);
    if (!drawn) return fail(drawn.error().code, job.source.name + ": " + drawn.error().message);
    return {};
}

double pixel_size(const Camera& camera, int width, int height, double distance) {
    const Mat4& m = camera.world_from_camera;
    const Vec3d middle = axis(m, 3) - axis(m, 2) * distance;
    const double across =
        window_point(camera, width, height, middle + axis(m, 0) * distance).x - window_point(camera, width, height, middle).x;
    return distance / across;
}

Vec3d window_point(const Camera& camera, int width, int height, Vec3d p) {
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    const raster::ClipPlace at = raster::clip_place(raster::clip_from_world(camera, aspect), p);
    const Mat4& m = camera.world_from_camera;
    return {(at.x / at.w * 0.5 + 0.5) * width, (0.5 - at.y / at.w * 0.5) * height, dot(axis(m, 3) - p, axis(m, 2))};
}

}  // namespace halflit::engine
