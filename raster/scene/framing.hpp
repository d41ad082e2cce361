// Cameras for scenes that have none.
#pragma once

#include "raster/scene/bounds.hpp"
#include "raster/scene/camera.hpp"
#include "raster/scene/scene.hpp"

namespace halflit::raster {

/// Direction and lens of a framing camera.
struct ViewSettings {
    float azimuth_deg = 35.0f;    ///< around +y; 0: seen from +z; positive: from the right
    float elevation_deg = 20.0f;  ///< above the horizon
    float zoom = 1.0f;            ///< 2 makes things twice as large
    float fov_y_deg = 35.0f;
};

/// Perspective camera that sees all of `bounds` at the given aspect ratio, by default in a three-quarter view. In the tighter direction the
/// eight corners leave a margin of 8 % of the half picture. zoom changes the field of view, not the position. Empty bounds are
/// framed as a unit cube at the origin, a point as a small box. Angles that are not finite count as 0, the zoom as 1, the field of view as
/// 45 degrees.
[[nodiscard]] Camera frame_bounds(const Bounds& bounds, float aspect, const ViewSettings& view);

/// The same, but fitted to the vertices: tight and centred for any shape.
[[nodiscard]] Camera frame_scene(const Scene& scene, float aspect, const ViewSettings& view);
/// The same. bounds: scene_bounds(scene).
[[nodiscard]] Camera frame_scene(const Scene& scene, const Bounds& bounds, float aspect, const ViewSettings& view);

}  // namespace halflit::raster
