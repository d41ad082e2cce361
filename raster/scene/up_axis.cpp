#include "halflit/up_axis.hpp"

#include "sh/vec3d.hpp"

namespace halflit {

void turn_upright(Scene& scene, UpAxis up) {
    if (up == UpAxis::y) return;
    const auto turn = [up](Vec3f v) { return to_float(turned_upright(to_double(v), up)); };
    const auto turn_all = [&](Mat4& m) {
        for (Vec4f& column : m.c) {
            const Vec3f turned = turn({column.x, column.y, column.z});
            column = {turned.x, turned.y, turned.z, column.w};
        }
    };
    for (Instance& instance : scene.instances) turn_all(instance.world_from_object);
    for (Camera& camera : scene.cameras) turn_all(camera.world_from_camera);
    for (Light& light : scene.lights) {
        light.position_ws = turn(light.position_ws);
        light.direction_ws = turn(light.direction_ws);
    }
}

}  // namespace halflit
