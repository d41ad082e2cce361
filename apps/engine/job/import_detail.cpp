#include "apps/engine/job/job_steps.hpp"

#include "sh/mat4.hpp"
#include "sh/trig.hpp"
#include "sh/vec3d.hpp"

#include <algorithm>

namespace halflit::engine {
namespace {

/// The next power of two, so that views of about one size share what an importer made; at least that of a load without a view.
double rounded_detail(double pixels) {
    constexpr double kMost = 32768.0;
    double rounded = LoadOptions{}.detail_px;
    while (rounded < pixels && rounded < kMost) rounded *= 2.0;
    return rounded;
}

/// Pixels that a unit of length takes at the point of a box that is nearest to the camera. A camera inside of the box is a hundredth of its
/// diagonal away.
double pixels_by_length(const Camera& camera, int height, Vec3d low, Vec3d high) {
    const Vec3d eye = axis(camera.world_from_camera, 3);
    const Vec3d beyond{std::max({low.x - eye.x, eye.x - high.x, 0.0}), std::max({low.y - eye.y, eye.y - high.y, 0.0}),
                       std::max({low.z - eye.z, eye.z - high.z, 0.0})};
    const auto half = sin_cos(0.5 * static_cast<double>(camera.fov_y_rad));
    const double view = camera.sides          ? static_cast<double>(camera.sides->top - camera.sides->bottom)
                        : camera.orthographic ? 2.0 * static_cast<double>(camera.half_height)
                                              : 2.0 * half.sin / half.cos;
    const double away = camera.orthographic ? 1.0 : std::max(length(beyond), 0.01 * length(high - low));
    return height / (view * away);
}

}  // namespace

double framed_detail(const ViewRequest& request) {
    constexpr double kNearer = 1.5;  // that of a ball in the usual field of view
    const PictureSize size = request.picture_size();
    return rounded_detail(kNearer * std::max(size.width, size.height) * std::max(1.0, static_cast<double>(request.view.zoom)));
}

double seen_detail(const RenderJob& job, double diagonal) {
    const Vec3d low = to_double(job.prepared->bounds().min), high = to_double(job.prepared->bounds().max);
    double most = pixels_by_length(job.camera, job.height, low, high);
    for (const Camera& camera : job.film.views) most = std::max(most, pixels_by_length(camera, job.height, low, high));
    return rounded_detail(diagonal * most);
}

}  // namespace halflit::engine
