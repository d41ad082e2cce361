#include "apps/halflit/scene_view.hpp"

#include "sh/trig.hpp"

#include <algorithm>
#include <limits>

namespace halflit::cli {
namespace {

/// Rotation that takes the axis to +y. Its entries are 0, 1 and -1, so it rounds nothing.
Mat4 upright_from(UpAxis up) {
    const auto turn = [](Vec4f x, Vec4f y, Vec4f z) { return Mat4{{x, y, z, {0, 0, 0, 1}}}; };
    switch (up) {
        case UpAxis::x:
            return turn({0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0});
        case UpAxis::y:
            return {};
        case UpAxis::z:
            return turn({1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0});
        case UpAxis::minus_x:
            return turn({0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0});
        case UpAxis::minus_y:
            return turn({1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 0});
        case UpAxis::minus_z:
            return turn({1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0});
    }
    return {};
}

Vec3f turned(const Mat4& rotation, Vec3f v) {
    const Vec4f out = rotation * Vec4f{v.x, v.y, v.z, 0};
    return {out.x, out.y, out.z};
}

}  // namespace

void turn_upright(Scene& scene, UpAxis up) {
    if (up == UpAxis::y) return;
    const Mat4 rotation = upright_from(up);
    for (Instance& instance : scene.instances) instance.world_from_object = rotation * instance.world_from_object;
    for (Camera& camera : scene.cameras) camera.world_from_camera = rotation * camera.world_from_camera;
    for (Light& light : scene.lights) {
        light.position_ws = turned(rotation, light.position_ws);
        light.direction_ws = turned(rotation, light.direction_ws);
    }
}

Vec3d turned_upright(Vec3d point, UpAxis up) {
    const Mat4 m = upright_from(up);
    const auto row = [&](float Vec4f::*r) {
        return static_cast<double>(m.c[0].*r) * point.x + static_cast<double>(m.c[1].*r) * point.y +
               static_cast<double>(m.c[2].*r) * point.z;
    };
    return {row(&Vec4f::x), row(&Vec4f::y), row(&Vec4f::z)};
}

Camera placed_camera(Vec3f eye, Vec3f target, float fov_y_deg, const Bounds& bounds) {
    constexpr float kNearestShare = 1e-4f;  // of the distance to the scene's centre or of its radius
    Camera camera;
    camera.world_from_camera = look_at(eye, target);
    camera.fov_y_rad = static_cast<float>(static_cast<double>(fov_y_deg) * (kPi / 180.0));
    if (bounds.empty) return camera;
    const Vec4f& back = camera.world_from_camera.c[2];
    float nearest = std::numeric_limits<float>::max();
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3f p{corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                      corner & 4 ? bounds.max.z : bounds.min.z};
        nearest = std::min(nearest, dot(eye - p, Vec3f{back.x, back.y, back.z}));
    }
    const float size = std::max(length(bounds.center() - eye), bounds.radius());
    const float near_z = std::max(nearest / 2, kNearestShare * size);
    if (near_z > 0.0f && near_z < std::numeric_limits<float>::max()) camera.near_z = near_z;
    return camera;
}

}  // namespace halflit::cli
