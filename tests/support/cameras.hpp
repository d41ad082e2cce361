// Cameras for tests.
#pragma once

#include "halflit/camera.hpp"

#include <cmath>

namespace halflit::test {

/// Camera at `eye` that looks at `target`. The picture's up is as close as possible to +y, or to +x for a vertical view.
inline Camera camera_at(Vec3f eye, Vec3f target, float fov_y_rad = 0.9f, float near_z = 0.1f) {
    const Vec3f back = normalize_or(eye - target, {0, 0, 1});
    const Vec3f up_hint = std::abs(back.y) > 0.999f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0};
    const Vec3f right = normalize_or(cross(up_hint, back), {1, 0, 0});
    const Vec3f up = cross(back, right);
    Camera camera;
    camera.world_from_camera = {
        {{right.x, right.y, right.z, 0}, {up.x, up.y, up.z, 0}, {back.x, back.y, back.z, 0}, {eye.x, eye.y, eye.z, 1}}};
    camera.fov_y_rad = fov_y_rad;
    camera.near_z = near_z;
    return camera;
}

/// Orthographic camera that looks along -z at the square of half size `half_height` around the origin: world (x, y) maps to the picture by
/// a scale alone.
inline Camera camera_flat(float half_height = 1.0f) {
    Camera camera;
    camera.world_from_camera = translation({0, 0, 10});
    camera.orthographic = true;
    camera.half_height = half_height;
    camera.near_z = 0.0f;
    camera.far_z = 20.0f;
    return camera;
}

}  // namespace halflit::test
