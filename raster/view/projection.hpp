// How a camera looks through a picture: clip space, and the ray of each place.
#pragma once

#include "raster/scene/camera.hpp"
#include "sh/mat4.hpp"
#include "sh/vec3.hpp"

namespace halflit::raster {

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
