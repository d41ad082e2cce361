// Cameras as JSON, for reports and for other programs.
#pragma once

#include "apps/engine/answers/run_report.hpp"
#include "halflit/camera.hpp"
#include "halflit/target.hpp"

namespace halflit::engine {

/// A camera of the job's scene in the coordinates, the unit and along the axes of the model's file, for a picture of this size:
///   name; width, height: pixels; orthographic;
///   world_from_camera: 16 numbers row by row, whose columns are the picture's right, up, back and the eye (OpenGL, glTF, Blender);
///   k, r, t: a point X is at R X + t, x to the right, y down, z ahead (OpenCV), and at u = fx x / z + cx, v = fy y / z + cy in the picture
///            (orthographic: u = fx x + cx), where pixels have their corners at whole numbers;
///   fov_y_deg and aspect, or half_height and half_width: unless the camera has sides of its own, which k says alone. aspect and half_width
///            are left out where they are the picture's;
///   near, far: distances; far 0: no limit.
/// --camera-file reads it, and draws the same pixels.
[[nodiscard]] Json camera_json(const RenderJob& job, const Camera& camera, PictureSize size);

}  // namespace halflit::engine
