// The background that a scene's silhouette stands out from.
#pragma once

#include "halflit/scene.hpp"

namespace halflit::raster {

/// Mean luminance of what the scene's surfaces give back of white light, linear, by their base colours and areas. Of many triangles some
/// stand for all. Lines and points count where there is no triangle; 0.5 if there is nothing.
[[nodiscard]] double surface_luminance(const Scene& scene);

/// Dark grey; light grey where surfaces are so dark that they would be lost in it. Linear, opaque.
[[nodiscard]] Vec4f suited_background(const Scene& scene);

}  // namespace halflit::raster
