#include "apps/engine/request/scene_view.hpp"

#include "sh/trig.hpp"

namespace halflit::engine {

Camera placed_camera(const Mat4& world_from_camera, float fov_y_deg, const Bounds& bounds) {
    Camera camera;
    camera.world_from_camera = world_from_camera;
    camera.fov_y_rad = static_cast<float>(static_cast<double>(fov_y_deg) * (kPi / 180.0));
    return completed(camera, bounds);
}

Camera placed_camera(Vec3f eye, Vec3f target, float fov_y_deg, const Bounds& bounds) {
    return placed_camera(look_at(eye, target), fov_y_deg, bounds);
}

}  // namespace halflit::engine
