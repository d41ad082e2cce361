// Projection of a camera: its matrix to clip space, and the view ray of each point of the picture.
#pragma once

#include "halflit/camera.hpp"
#include "halflit/math.hpp"
#include "sh/mat4.hpp"

namespace halflit::raster {

/// View rays: at (x, y) in [-1, 1]^2 of the picture, x to the right and y up, the ray's direction is middle + x right + y up, any length.
struct ViewRays {
    Vec3d middle{0, 0, -1}, right, up;
};
[[nodiscard]] ViewRays view_rays(const Camera& camera, float aspect);

/// Depths of a camera. Clip z is z_scale * z_vs + z_offset, and clip w is -z_vs, or 1 if orthographic.
struct DepthMap {
    double z_scale = 0, z_offset = 1;
    bool orthographic = false;

    /// Distance along the view axis, world units, of a reversed depth; infinite for that of an infinite distance.
    [[nodiscard]] double distance(double depth) const { return orthographic ? (z_offset - depth) / z_scale : z_offset / (depth + z_scale); }
};
[[nodiscard]] DepthMap depth_map(const Camera& camera, float aspect);

/// Half the height of what the picture shows: world units in an orthographic view, else tangent of the angle. Of pixels that are not
/// square, the longer side counts.
[[nodiscard]] double half_extent(const Camera& camera, float aspect);

/// clip_from_world with reversed depth: z/w is 1 at the near plane and 0 at the far plane (or at infinity), so that float depth keeps
/// its precision at any range. x and y in [-w, w], y up. `aspect` is the picture's width / height. A camera made for another aspect shows
/// more in one direction, never less. The result is finite for every finite world_from_camera: a field of view outside (0, pi) is clamped
/// into it; a far limit that is not beyond `near_z` counts as none (orthographic: 1000 half heights); an unusable `near_z` becomes 0.1 or
/// less.
[[nodiscard]] Mat4 clip_from_world(const Camera& camera, float aspect);

/// Clip coordinates of a point of the world, without its depth, in double.
struct ClipPlace {
    double x, y, w;
};
[[nodiscard]] inline ClipPlace clip_place(const Mat4& clip_from_world, Vec3d p) {
    const auto row = [&](float Vec4f::*of) {
        const auto& c = clip_from_world.c;
        return ((double{c[0].*of} * p.x + double{c[1].*of} * p.y) + double{c[2].*of} * p.z) + double{c[3].*of};
    };
    return {row(&Vec4f::x), row(&Vec4f::y), row(&Vec4f::w)};
}

}  // namespace halflit::raster
