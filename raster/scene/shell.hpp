// A shell around all else, such as the dome of a sky: it is seen from inside.
#pragma once

#include "halflit/scene.hpp"
#include "raster/scene/closest_box.hpp"

namespace halflit::raster {

/// box: around the instance; rest: around what may lie inside. Rays from the middle of the rest meet the shell on all sides and above.
/// Where they leave it for good, its front is inside, or it is unlit.
[[nodiscard]] bool is_shell(const Scene& scene, int instance, const WideBox& box, const WideBox& rest);

}  // namespace halflit::raster
