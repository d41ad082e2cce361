// Cameras that see the framed part of a scene.
#pragma once

#include "halflit/camera.hpp"
#include "raster/scene/framed_part.hpp"

namespace halflit::raster {

/// frame_scene() of a scene whose part is known. bounds: scene_bounds(scene).
[[nodiscard]] Camera frame_with_shadow(const Scene& scene, const FramedPart& part, const Bounds& bounds, float aspect,
                                       const ViewSettings& view);
/// choose_view() of such a scene.
[[nodiscard]] FramedView choose_view(const Scene& scene, const FramedPart& part, const Bounds& bounds, float aspect,
                                     const ViewSettings& view);

}  // namespace halflit::raster
