#include "apps/halflit/look/view_shot.hpp"

#include "raster/view/projection.hpp"
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
    auto drawn = renderer.render(*job.prepared, job.light, camera, settings, target, job.timed_execution());
    if (!drawn) return fail(drawn.error().code, job.source.name + ": " + drawn.error().message);
    shot.warnings = std::move(drawn->warnings);
    return shot;
}

double pixel_size(const Camera& camera, int width, int height, double distance) {
    const Mat4& m = camera.world_from_camera;
    const auto column = [&](std::size_t i) { return Vec3d{m.c[i].x, m.c[i].y, m.c[i].z}; };
    const Vec3d middle = column(3) - column(2) * distance;
    const double across =
        window_point(camera, width, height, middle + column(0) * distance).x - window_point(camera, width, height, middle).x;
    return distance / across;
}

Vec3d window_point(const Camera& camera, int width, int height, Vec3d p) {
    const Mat4 m = raster::clip_from_world(camera, static_cast<float>(width) / static_cast<float>(height));
    const auto row = [&](float Vec4f::*r) {
        return ((double{m.c[0].*r} * p.x + double{m.c[1].*r} * p.y) + double{m.c[2].*r} * p.z) + double{m.c[3].*r};
    };
    const double w = row(&Vec4f::w);
    const Vec4f &back = camera.world_from_camera.c[2], &eye = camera.world_from_camera.c[3];
    const Vec3d to_eye = Vec3d{eye.x, eye.y, eye.z} - p;
    return {(row(&Vec4f::x) / w * 0.5 + 0.5) * width, (0.5 - row(&Vec4f::y) / w * 0.5) * height,
            (to_eye.x * back.x + to_eye.y * back.y) + to_eye.z * back.z};
}

}  // namespace halflit::cli
