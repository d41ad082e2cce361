// A scene's place in the room where its cameras are: mjvScene.translate, rotate and scale.
#pragma once

#include "apps/engine/mujoco/model.hpp"
#include "halflit/math.hpp"

#include <cmath>

namespace halflit::engine::mujoco {

[[nodiscard]] inline Vec3d in_double(Vec3f v) { return {v.x, v.y, v.z}; }
[[nodiscard]] inline Vec3f in_float(Vec3d v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

/// Where things of the model are: three axes and an origin.
struct Place {
    Vec3d x, y, z, origin;
};

/// By default, room and model are the same, and all functions give exactly what they get.
class Room {
public:
    /// Fails (bad_input) for a scale that is not above 0, and numbers that are not finite.
    [[nodiscard]] static Result<Room> of(const Scene& scene) {
        Room room;
        if (!scene.enabletransform) return room;
        const double w = scene.rotate[0], x = scene.rotate[1], y = scene.rotate[2], z = scene.rotate[3];
        room.axes_[0] = {w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)};
        room.axes_[1] = {2 * (x * y - w * z), w * w - x * x + y * y - z * z, 2 * (y * z + w * x)};
        room.axes_[2] = {2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z};
        room.origin_ = {scene.translate[0], scene.translate[1], scene.translate[2]};
        room.scale_ = scene.scale;
        if (scene.scale > 1e-15f && std::isfinite(scene.scale) && std::isfinite(dot(room.origin_, room.origin_)) &&
            std::isfinite(w * w + x * x + y * y + z * z))
            return room;
        return fail(ErrorCode::bad_input, "the scene's transformation is not finite, or its scale is not above 0");
    }
    [[nodiscard]] float scale() const { return static_cast<float>(scale_); }
    [[nodiscard]] Vec3f point(Vec3f p) const { return in_float(turned(in_double(p)) * scale_ + origin_); }
    [[nodiscard]] Vec3f direction(Vec3f d) const { return in_float(turned(in_double(d))); }
    [[nodiscard]] Vec3f point_in_model(Vec3f p) const { return in_float(turned_back(in_double(p) - origin_) * (1 / scale_)); }
    [[nodiscard]] Vec3f direction_in_model(Vec3f d) const { return in_float(turned_back(in_double(d))); }
    [[nodiscard]] Mat4 matrix(const Place& place) const {
        Mat4 made;
        const auto column = [](Vec3f v, float w) { return Vec4f{v.x, v.y, v.z, w}; };
        made.c[0] = column(in_float(turned(place.x) * scale_), 0);
        made.c[1] = column(in_float(turned(place.y) * scale_), 0);
        made.c[2] = column(in_float(turned(place.z) * scale_), 0);
        made.c[3] = column(in_float(turned(place.origin) * scale_ + origin_), 1);
        return made;
    }

private:
    [[nodiscard]] Vec3d turned(Vec3d v) const { return axes_[0] * v.x + axes_[1] * v.y + axes_[2] * v.z; }
    [[nodiscard]] Vec3d turned_back(Vec3d v) const { return {dot(axes_[0], v), dot(axes_[1], v), dot(axes_[2], v)}; }

    Vec3d axes_[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, origin_{};
    double scale_ = 1;
};

}  // namespace halflit::engine::mujoco
