// Cameras. A camera sits at the origin of its own space, looks along -z, with +x to the right and +y up (glTF).
#pragma once

#include "halflit/export.hpp"
#include "halflit/math.hpp"
#include "halflit/mesh.hpp"

#include <string>

namespace halflit {

struct Scene;

/// A view of the world. Distances are world units.
struct Camera {
    std::string name;                ///< for messages and choices; may be empty
    Mat4 world_from_camera;          ///< rigid: rotation and translation, as look_at() makes
    bool orthographic = false;       ///< false: perspective
    float fov_y_rad = 0.785398163f;  ///< perspective: full vertical angle, in (0, pi)
    float aspect = 0.0f;             ///< perspective: width / height that the view is made for; 0: that of the picture
    float half_height = 1.0f;        ///< orthographic: half the height of the view
    float half_width = 0.0f;         ///< orthographic: half its width; 0: from the picture's aspect
    float near_z = 0.1f;             ///< distance along -z from which on things are drawn; > 0 for perspective
    float far_z = 0.0f;              ///< distance up to which they are drawn, > near_z; 0: no far limit (perspective only)
    friend bool operator==(const Camera&, const Camera&) = default;
};

/// Direction and lens of a framing camera.
struct ViewSettings {
    float azimuth_deg = 35.0f;    ///< around `up`; 0: seen from +z; positive: from the right
    float elevation_deg = 20.0f;  ///< above the horizon
    float zoom = 1.0f;            ///< 2 makes things twice as large
    float fov_y_deg = 35.0f;      ///< full vertical angle before the zoom
};

/// Perspective camera that sees all of `bounds` at the given aspect ratio, by default in a three-quarter view. In the tighter direction the
/// eight corners leave a margin of 8 % of the half picture. zoom changes the field of view, not the position. Empty bounds are
/// framed as a unit cube at the origin, a point as a small box. Angles that are not finite count as 0, the zoom as 1, the field of view as
/// 45 degrees.
[[nodiscard]] HALFLIT_API Camera frame_bounds(const Bounds& bounds, float aspect, const ViewSettings& view);

/// The same, but fitted to the vertices: tight and centred for any shape.
[[nodiscard]] HALFLIT_API Camera frame_scene(const Scene& scene, float aspect, const ViewSettings& view = {});
/// The same. bounds: scene_bounds(scene).
[[nodiscard]] HALFLIT_API Camera frame_scene(const Scene& scene, const Bounds& bounds, float aspect, const ViewSettings& view);

}  // namespace halflit
