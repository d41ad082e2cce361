#include "apps/halflit/look/view_shot.hpp"

#include "raster/view/projection.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3d.hpp"

#include <utility>

namespace halflit::cli {

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
        (void)relight(job, camera);
    }
    shot.instance.resize(pixels), target.instance = shot.instance.data();
    shot.triangle.resize(pixels), target.triangle = shot.triangle.data();
    if (wanted.depth) shot.depth.resize(pixels), target.depth = shot.depth.data();
    if (wanted.normal) shot.normal.resize(3 * pixels), target.normal = shot.normal.data();
    Settings settings = job.settings;
    if (!wanted.first_sample) settings.samples = 1;
    const auto drawn = renderer.render(*job.prepared, job.light, camera, settings, target, job.timed_execution());
    if (!drawn) return fail(drawn.error().code, job.source.name + ": " + drawn.error().message);
    return shot;
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

}  // namespace halflit::cli
