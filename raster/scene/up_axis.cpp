#include "halflit/up_axis.hpp"

#include "sh/vec3d.hpp"

namespace halflit {
namespace {

template <class Turn>
Mat4 turned(Mat4 m, const Turn& turn) {
    for (Vec4f& column : m.c) {
        const Vec3f v = to_float(turn(Vec3d{column.x, column.y, column.z}));
        column = {v.x, v.y, v.z, column.w};
    }
    return m;
}

template <class Turn>
Light turned(Light light, const Turn& turn) {
    light.position_ws = to_float(turn(to_double(light.position_ws)));
    light.direction_ws = to_float(turn(to_double(light.direction_ws)));
    return light;
}

}  // namespace

Mat4 turned_upright(const Mat4& m, UpAxis up) {
    return turned(m, [up](Vec3d v) { return turned_upright(v, up); });
}
Mat4 turned_back(const Mat4& m, UpAxis up) {
    return turned(m, [up](Vec3d v) { return turned_back(v, up); });
}
Light turned_upright(Light light, UpAxis up) {
    return turned(light, [up](Vec3d v) { return turned_upright(v, up); });
}
Light turned_back(Light light, UpAxis up) {
    return turned(light, [up](Vec3d v) { return turned_back(v, up); });
}

void turn_upright(Scene& scene, UpAxis up) {
    if (up == UpAxis::y) return;
    for (Instance& instance : scene.instances) instance.world_from_object = turned_upright(instance.world_from_object, up);
    for (Camera& camera : scene.cameras) camera.world_from_camera = turned_upright(camera.world_from_camera, up);
    for (Light& light : scene.lights) light = turned_upright(light, up);
}

}  // namespace halflit
