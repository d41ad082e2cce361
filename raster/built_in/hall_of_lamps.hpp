// A hall that shows what many lights cost: a floor with pillars, and lamps over it.
#pragma once

#include "raster/scene/scene.hpp"

namespace halflit::raster {

inline constexpr int kMostHallLights = 1024;

/// Some 4100 triangles; 1 to 1024 point lights, one to each square of 2 x 2, from the middle outwards: more of them are farther away, never
/// denser. With a range each ends 3 from its lamp; without, it reaches the whole hall. The camera sees the middle, where 64 lamps hang.
[[nodiscard]] Scene lights_scene(int lights, bool ranged);

}  // namespace halflit::raster
