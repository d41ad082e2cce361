// Scene that shows the cost of many lights: a floor with pillars, and lights over it.
#pragma once

#include "halflit/scene.hpp"

namespace halflit::raster {

inline constexpr int kMostHallLights = 1024;

/// About 4100 triangles and 1 to 1024 point lights. Each square of 2 x 2 units has one light; squares are filled from the middle outwards,
/// so more lights are farther away, not denser. ranged: true limits each light to a range of 3; false lets it reach the whole hall. The
/// camera sees the middle, where 64 lights hang.
[[nodiscard]] Scene lights_scene(int lights, bool ranged);

}  // namespace halflit::raster
