// Cameras for scenes that bring none.
#pragma once

#include "raster/scene/bounds.hpp"
#include "raster/scene/camera.hpp"
#include "raster/scene/scene.hpp"

namespace halflit::raster {

/// How a view is framed when no camera is given. Angles in degrees.
struct ViewSettings {
    float azimuth_deg = 35.0f;    ///< around +y; 0 looks from +z, positive from the right
    float elevation_deg = 20.0f;  ///< above the horizon
    float zoom = 1.0f;            ///< 2 makes things twice as large
    float fov_y_deg = 35.0f;
};

/// A perspective camera that sees the whole of `bounds` at the given aspect ratio, from a three-quarter view by default. The eight
/// corners fit with a margin of 8 % of the half picture, one direction tightly; zoom narrows the lens from the same place. Empty
/// bounds are framed as a unit cube at the origin, a point as a small box; settings that are not finite count as their neutral value.
[[nodiscard]] Camera frame_bounds(const Bounds& bounds, float aspect, const ViewSettings& view);

/// The camera of frame_bounds, but fitted to the vertices themselves: tight and centred for any shape.
[[nodiscard]] Camera frame_scene(const Scene& scene, float aspect, const ViewSettings& view);
/// The same where scene_bounds is known.
[[nodiscard]] Camera frame_scene(const Scene& scene, const Bounds& bounds, float aspect, const ViewSettings& view);

}  // namespace halflit::raster
