#include "apps/halflit/render/scene_view.hpp"

#include "sh/trig.hpp"

#include <algorithm>
#include <limits>

namespace halflit::cli {

float near_plane(const Mat4& world_from_camera, const Bounds& bounds) {
    constexpr float kNearestShare = 1e-4f;  // of the distance to the scene's centre or of its radius
    const float usual = Camera{}.near_z;
    if (bounds.empty) return usual;
    const Vec4f &back = world_from_camera.c[2], &place = world_from_camera.c[3];
    const Vec3f eye{place.x, place.y, place.z};
    float nearest = std::numeric_limits<float>::max();
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3f p{corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                      corner & 4 ? bounds.max.z : bounds.min.z};
        nearest = std::min(nearest, dot(eye - p, Vec3f{back.x, back.y, back.z}));
    }
    const float size = std::max(length(bounds.center() - eye), bounds.radius());
    const float near_z = std::max(nearest / 2, kNearestShare * size);
    return near_z > 0.0f && near_z < std::numeric_limits<float>::max() ? near_z : usual;
}

Camera placed_camera(const Mat4& world_from_camera, float fov_y_deg, const Bounds& bounds) {
    Camera camera;
    camera.world_from_camera = world_from_camera;
    camera.fov_y_rad = static_cast<float>(static_cast<double>(fov_y_deg) * (kPi / 180.0));
    camera.near_z = near_plane(world_from_camera, bounds);
    return camera;
}

Camera placed_camera(Vec3f eye, Vec3f target, float fov_y_deg, const Bounds& bounds) {
    return placed_camera(look_at(eye, target), fov_y_deg, bounds);
}

}  // namespace halflit::cli
