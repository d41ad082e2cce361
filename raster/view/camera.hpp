// Cameras. A camera sits at the origin of its own space, looks along -z, with +x to the right and +y up (glTF).
#pragma once

#include "raster/scene/bounds.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3.hpp"

#include <string>

namespace halflit::raster {

struct Camera {
    std::string name;
    Mat4 world_from_camera;        ///< rigid: rotation and translation
    bool orthographic = false;
    float fov_y_rad = 0.785398163f;  ///< perspective: full vertical angle, in (0, pi)
    float aspect = 0.0f;           ///< perspective: width / height the view is made for; 0: that of the picture
    float half_height = 1.0f;      ///< orthographic: half the height of the view; half_width likewise, 0: from the picture's aspect
    float half_width = 0.0f;
    float near_z = 0.1f;           ///< > 0 for perspective
    float far_z = 0.0f;            ///< > near_z; 0: no far limit (perspective only)
    friend bool operator==(const Camera&, const Camera&) = default;
};

/// How a view is framed when no camera is given. Angles in degrees.
struct ViewSettings {
    float azimuth_deg = 35.0f;     ///< around +y; 0 looks from +z, positive from the right
    float elevation_deg = 20.0f;   ///< above the horizon
    float zoom = 1.0f;             ///< 2 makes things twice as large
    float fov_y_deg = 35.0f;
};

/// A perspective camera that sees the whole of `bounds` at the given aspect ratio, from a three-quarter view by default. The eight
/// corners fit with a margin of 8 % of the half picture, one direction tightly; zoom narrows the lens from the same place. Empty
/// bounds are framed as a unit cube at the origin, a point as a small box; settings that are not finite count as their neutral value.
[[nodiscard]] Camera frame_bounds(const Bounds& bounds, float aspect, const ViewSettings& view);

/// The way a camera looks through a picture: at (x, y) in [-1, 1], x right and y up, along middle + x right + y up, of any length.
struct ViewRays {
    Vec3d middle{0, 0, -1}, right, up;
};
[[nodiscard]] ViewRays view_rays(const Camera& camera, float aspect);

/// clip_from_world with reversed depth: z/w is 1 at the near plane and 0 at the far plane (or at infinity), so that float depth keeps
/// its precision at any range. x and y in [-w, w], y up. `aspect` is the picture's width / height. A camera made for another aspect
/// shows more on one side, never less. Always finite for a finite placing: a field of view outside (0, pi) is brought inside, a far
/// limit that is not beyond `near_z` is none (orthographic: a thousand half heights), an unusable `near_z` is 0.1 or less.
[[nodiscard]] Mat4 clip_from_world(const Camera& camera, float aspect);

}  // namespace halflit::raster
