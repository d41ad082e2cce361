// A scene's place in the room where its cameras are: mjvScene.translate, rotate and scale. Cameras are brought into the model, where lights
// and shadow maps are: a map that is turned has other texels.
#pragma once

#include "apps/engine/mujoco/model.hpp"
#include "sh/vec3d.hpp"

#include <cmath>

namespace halflit::engine::mujoco {

/// By default, room and model are the same, and functions give exactly what they get.
class Room {
public:
    /// Fails (bad_input) for a scale that is not above 0, a rotation of 0, and numbers that are not finite.
    [[nodiscard]] static Result<Room> of(const Scene& scene) {
        Room room;
        if (!scene.enabletransform) return room;
        const double w = scene.rotate[0], x = scene.rotate[1], y = scene.rotate[2], z = scene.rotate[3];
        // MuJoCo takes the rotation for a unit quaternion. Of another one, its matrix stretches too.
        room.stretch_ = w * w + x * x + y * y + z * z;
        const double n = 1 / room.stretch_;
        room.axes_[0] = Vec3d{w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)} * n;
        room.axes_[1] = Vec3d{2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x)} * n;
        room.axes_[2] = Vec3d{2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z} * n;
        room.origin_ = {scene.translate[0], scene.translate[1], scene.translate[2]};
        room.scale_ = scene.scale;
        if (scene.scale > 1e-15f && std::isfinite(scene.scale) && std::isfinite(dot(room.origin_, room.origin_)) &&
            std::isfinite(room.stretch_) && room.stretch_ > 1e-6)
            return room;
        return fail(ErrorCode::bad_input, "the scene's transformation is not finite, or its scale or rotation is 0");
    }
    /// mjvScene.scale, and the length in the room of the model's unit.
    [[nodiscard]] float scale() const { return static_cast<float>(scale_); }
    [[nodiscard]] float unit() const { return static_cast<float>(scale_ * stretch_); }
    [[nodiscard]] Vec3f point_in_model(Vec3f p) const { return to_float(turned_back(to_double(p) - origin_) * (1 / (scale_ * stretch_))); }
    [[nodiscard]] Vec3f direction_in_model(Vec3f d) const { return to_float(turned_back(to_double(d))); }
    /// Where MuJoCo believes that a point of the room is: another place if the rotation stretches.
    [[nodiscard]] Vec3f head_in_model(Vec3f p) const { return to_float(turned_back(to_double(p) - origin_) * (stretch_ / scale_)); }

private:
    [[nodiscard]] Vec3d turned_back(Vec3d v) const { return {dot(axes_[0], v), dot(axes_[1], v), dot(axes_[2], v)}; }

    Vec3d axes_[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, origin_{};
    double scale_ = 1, stretch_ = 1;
};

}  // namespace halflit::engine::mujoco
