// A camera that the user turns around a point, by a mouse's motion in pixels of the picture.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/model.hpp"
#include "sh/vec3d.hpp"

#include <string>

namespace halflit::viewer {

/// Until it is moved, camera() is the start camera itself, so that the first picture is that of `halflit render`. From then on +y points
/// up in the picture: a roll of the start camera is dropped. Angles are radians.
class OrbitCamera {
public:
    /// Pixels of motion for a whole turn.
    static constexpr double kPixelsOfTurn = 900.0;

    /// Turns around the point on the view axis that is nearest to the centre of `bounds`.
    OrbitCamera(const Camera& start, const Bounds& bounds);

    /// The scene follows the pointer: right is a turn of the scene to the right, down shows more of its top.
    void turn(double right_px, double down_px);
    /// The point under the pointer follows it; in a perspective view, points at the distance of the centre do.
    void pan(double right_px, double down_px, int picture_height);
    /// Each step enlarges the scene by a tenth.
    void zoom(double steps);
    void reset();

    [[nodiscard]] Camera camera() const;
    /// The flags of `halflit render` that place the camera there in a picture of width / height `aspect`, in the file's
    /// coordinates. Empty until it is moved, and for orthographic views, which no flag makes.
    [[nodiscard]] std::string flags(double aspect, const Placement& placement) const;
    [[nodiscard]] double distance() const { return distance_; }

private:
    [[nodiscard]] Vec3d back() const;  ///< from the target towards the camera, unit length

    Camera start_;
    Bounds bounds_;
    double radius_ = 1;
    bool moved_ = false;
    Vec3d target_{};
    double azimuth_ = 0, elevation_ = 0, distance_ = 1, half_height_ = 1;
};

}  // namespace halflit::viewer
